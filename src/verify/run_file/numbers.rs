//! Arrays of numbers as little-endian bytes.

use std::borrow::Cow;
use std::io;

use safetensors::Dtype;

use crate::scene::Scene;

/// The number of items that are converted to bytes at a time.
const CHUNK: usize = 1 << 12;

/// A type of numbers in arrays.
pub(super) trait Number: Copy + Send + Sync {
    /// The name of the type in the format.
    const DTYPE: Dtype;
    /// The size of a number in bytes.
    const WIDTH: usize;
    fn push(self, bytes: &mut Vec<u8>);
    /// Reads a number from the first bytes; zero if there are too few.
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

/// A byte that should be a truth value, 0 or 1.
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

/// A function that takes bytes piece by piece.
pub(super) type Sink<'a> = dyn FnMut(&[u8]) -> io::Result<()> + 'a;

/// A function that writes all bytes of an array to a sink.
type Emit<'a> = dyn Fn(&mut Sink<'_>) -> io::Result<()> + 'a;

/// An array to be written; its bytes are generated as they are needed.
pub(super) struct Array<'a> {
    pub(super) name: Cow<'static, str>,
    pub(super) dtype: Dtype,
    pub(super) shape: Vec<usize>,
    emit: Box<Emit<'a>>,
}

impl<'a> Array<'a> {
    /// An array with `N` numbers for each item; `shape` is the shape of the items.
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
        Self { name: name.into(), dtype: E::DTYPE, shape, emit: Box::new(emit) }
    }

    /// An array whose bytes a function writes.
    pub(super) fn emitted<E: Number>(
        name: String,
        shape: Vec<usize>,
        emit: impl Fn(&mut Sink<'_>) -> io::Result<()> + 'a,
    ) -> Self {
        Self { name: name.into(), dtype: E::DTYPE, shape, emit: Box::new(emit) }
    }

    /// The array of spheres, which is also the input of the scene's digest.
    pub(super) fn spheres(scene: &'a Scene) -> Self {
        Self::new("spheres", &[scene.len()], scene.spheres(), |sphere| *sphere)
    }

    /// The number of bytes of the array.
    pub(super) fn bytes(&self) -> usize {
        self.shape.iter().product::<usize>() * self.dtype.bitsize() / 8
    }

    pub(super) fn emit(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        (self.emit)(sink)
    }
}
