//! Arrays of numbers as little-endian bytes.

use std::io;

use safetensors::Dtype;

use crate::scene::Scene;

/// How many items are turned into bytes at a time.
const CHUNK: usize = 1 << 12;

/// A number of an array.
pub(super) trait Number: Copy + Send + Sync {
    /// What the format calls it.
    const DTYPE: Dtype;
    /// Its size in bytes.
    const WIDTH: usize;
    fn push(self, bytes: &mut Vec<u8>);
    /// Of the first bytes; zero if there are too few.
    fn read(bytes: &[u8]) -> Self;
}

macro_rules! number {
    ($number:ty, $dtype:ident) => {
        impl Number for $number {
            const DTYPE: Dtype = Dtype::$dtype;
            const WIDTH: usize = size_of::<Self>();

            fn push(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }

            fn read(bytes: &[u8]) -> Self {
                bytes.first_chunk().copied().map_or_else(Self::default, Self::from_le_bytes)
            }
        }
    };
}
number!(f32, F32);
number!(f64, F64);
number!(u32, U32);
number!(u8, U8);

/// A truth value, or another byte in its place.
#[derive(Clone, Copy)]
pub(super) struct Flag(pub(super) u8);

impl Number for Flag {
    const DTYPE: Dtype = Dtype::BOOL;
    const WIDTH: usize = 1;

    fn push(self, bytes: &mut Vec<u8>) {
        bytes.push(self.0);
    }

    fn read(bytes: &[u8]) -> Self {
        Self(bytes.first().copied().unwrap_or_default())
    }
}

/// Takes bytes, piece by piece.
pub(super) type Sink<'a> = dyn FnMut(&[u8]) -> io::Result<()> + 'a;

/// Gives all bytes.
type Emit<'a> = dyn Fn(&mut Sink<'_>) -> io::Result<()> + 'a;

/// An array that is yet to be written; its bytes are made as they are needed.
pub(super) struct Array<'a> {
    pub(super) name: &'static str,
    pub(super) dtype: Dtype,
    pub(super) shape: Vec<usize>,
    emit: Box<Emit<'a>>,
}

impl<'a> Array<'a> {
    /// Of so many numbers of every item; `shape` has the shape of the items.
    pub(super) fn new<T, E: Number, const N: usize>(
        name: &'static str,
        shape: &[usize],
        items: &'a [T],
        numbers: impl Fn(&T) -> [E; N] + 'a,
    ) -> Self {
        let emit = move |sink: &mut Sink<'_>| {
            let mut bytes = Vec::with_capacity(CHUNK.min(items.len()) * N * E::WIDTH);
            for chunk in items.chunks(CHUNK) {
                bytes.clear();
                chunk.iter().flat_map(&numbers).for_each(|number| number.push(&mut bytes));
                sink(&bytes)?;
            }
            Ok(())
        };
        let columns = (N > 1).then_some(N);
        let shape = shape.iter().copied().chain(columns).collect();
        Self { name, dtype: E::DTYPE, shape, emit: Box::new(emit) }
    }

    /// What the scene's digest is of.
    pub(super) fn spheres(scene: &'a Scene) -> Self {
        Self::new("spheres", &[scene.len()], scene.spheres(), |sphere| *sphere)
    }

    /// How many bytes it takes.
    pub(super) fn bytes(&self) -> usize {
        self.shape.iter().product::<usize>() * self.dtype.bitsize() / 8
    }

    pub(super) fn emit(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        (self.emit)(sink)
    }
}
