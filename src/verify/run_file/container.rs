//! The container of a run file: the format `safetensors` with a digest of every byte.
//!
//! A file consists of the header's length in eight bytes, the header in JSON, and the arrays one after another. The
//! writer of the crate `safetensors` writes metadata in random order, and its reader adds lengths without overflow
//! checks, so that malicious files could make it panic. Therefore only its types for the header and their validation
//! are used.

use std::borrow::Cow;
use std::cell::RefCell;
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::io::{self, Read, Seek, SeekFrom, Write};

use bytemuck::{Pod, Zeroable};
use safetensors::Dtype;
use safetensors::tensor::{Metadata, TensorInfo};
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::parallel::try_map;
use crate::scene::Scene;
use crate::text::shortened;
use crate::verify::run_file::error::{RunFileError, VERSION, hex};

/// The first bytes of every header.
const START: &[u8] = br#"{"__metadata__":{"#;

/// The number of bytes before the header.
const LENGTH: usize = size_of::<u64>();

/// The placeholder for the digest while it is computed.
const NO_DIGEST: &str = "0000000000000000000000000000000000000000000000000000000000000000";

/// The number of bytes that are read at a time.
const PIECE: u64 = 1 << 20;

/// The metadata key of the file's digest.
const DIGEST: &str = "sha256";

/// The metadata key of the format's version.
const FORMAT: &str = "pinhole_run";

#[derive(Serialize)]
struct Header<'a> {
    #[serde(rename = "__metadata__")]
    metadata: &'a BTreeMap<String, String>,
    #[serde(flatten)]
    arrays: BTreeMap<&'a str, TensorInfo>,
}

/// Gives `count` bytes of a reader to a sink, in pieces.
fn in_pieces(source: &mut (impl Read + ?Sized), count: u64, sink: &mut Sink<'_>) -> io::Result<()> {
    let next = |left: u64| left.min(PIECE) as usize;
    let mut piece = vec![0; next(count)];
    let mut left = count;
    while left > 0 {
        let piece = &mut piece[..next(left)];
        source.read_exact(piece)?;
        sink(piece)?;
        left -= piece.len() as u64;
    }
    Ok(())
}

pub(super) fn sink_into(digest: &mut Sha256) -> impl FnMut(&[u8]) -> io::Result<()> {
    |bytes| {
        digest.update(bytes);
        Ok(())
    }
}

pub(super) fn write(
    mut metadata: BTreeMap<String, String>,
    mut arrays: Vec<Array<'_>>,
    out: &mut dyn Write,
) -> io::Result<()> {
    // The widest numbers come first, so that all arrays are aligned.
    arrays.sort_by_key(|array| Reverse(array.dtype.bitsize()));
    let arrays = &arrays[..];
    metadata.insert(FORMAT.to_owned(), VERSION.to_owned());
    metadata.insert(DIGEST.to_owned(), NO_DIGEST.to_owned());
    let mut end = 0;
    let infos = arrays.iter().map(|array| {
        let start = end;
        end += array.bytes();
        let (dtype, shape) = (array.dtype, array.shape.clone());
        (array.name, TensorInfo { dtype, shape, data_offsets: (start, end) })
    });
    let header = Header { metadata: &metadata, arrays: infos.collect() };
    let mut header = serde_json::to_vec(&header)?;
    header.resize(header.len().next_multiple_of(LENGTH), b' ');
    let length = (header.len() as u64).to_le_bytes();

    let mut digest = Sha256::new();
    emit(&length, &header, arrays, &mut sink_into(&mut digest))?;
    let digest = hex(digest);
    let offset = digest_in(&header, NO_DIGEST).ok_or_else(|| io::Error::other("no digest"))?;
    header[offset..offset + digest.len()].copy_from_slice(digest.as_bytes());
    emit(&length, &header, arrays, &mut |bytes| out.write_all(bytes))
}

fn emit(length: &[u8], header: &[u8], arrays: &[Array<'_>], sink: &mut Sink<'_>) -> io::Result<()> {
    sink(length)?;
    sink(header)?;
    arrays.iter().try_for_each(|array| array.emit(sink))
}

/// The position of the digest in a header. No other text can match, because quotes inside texts are escaped.
fn digest_in(header: &[u8], digest: &str) -> Option<usize> {
    let before = format!("\"{DIGEST}\":\"");
    let wanted = format!("{before}{digest}\"");
    let offset = header.windows(wanted.len()).position(|window| window == wanted.as_bytes())?;
    Some(offset + before.len())
}

/// The bytes of a file, which may not fit into memory.
pub(super) trait Source: Read + Seek {}

impl<S: Read + Seek> Source for S {}

/// A file that is complete and unaltered. Its contents may still be invalid.
pub(super) struct Container<'a> {
    header: Metadata,
    source: RefCell<&'a mut dyn Source>,
    /// The position of the first array.
    start: u64,
}

fn text<'a>(header: &'a Metadata, key: &str) -> Option<&'a str> {
    Some(header.metadata().as_ref()?.get(key)?.as_str())
}

pub(super) fn contradiction(message: impl Into<String>) -> RunFileError {
    RunFileError::Contents(message.into())
}

impl<'a> Container<'a> {
    /// Opens a file, and computes the digest of all its bytes.
    pub(super) fn open(source: &'a mut dyn Source) -> Result<Self, RunFileError> {
        let found = source.seek(SeekFrom::End(0))?;
        source.rewind()?;
        let mut first = [0; LENGTH + START.len()];
        if found < first.len() as u64 {
            return Err(RunFileError::NotRun);
        }
        source.read_exact(&mut first)?;
        let (length, start) = first.split_first_chunk::<LENGTH>().ok_or(RunFileError::NotRun)?;
        if start != START {
            return Err(RunFileError::NotRun);
        }
        let truncated =
            |expected: u64| RunFileError::Truncated { found, expected: expected.saturating_add(LENGTH as u64) };
        let header_length = u64::from_le_bytes(*length);
        let beyond = found - LENGTH as u64;
        if header_length > beyond {
            return Err(truncated(header_length));
        }
        // A header that is shorter than its first bytes is not valid JSON.
        let mut header = start.to_vec();
        header.truncate(header_length as usize);
        let rest = header_length.saturating_sub(START.len() as u64);
        source.take(rest).read_to_end(&mut header)?;
        let parsed: Metadata = serde_json::from_slice(&header)
            .map_err(|error| contradiction(format!("its header cannot be read: {error}")))?;
        match text(&parsed, FORMAT) {
            None => return Err(RunFileError::NotRun),
            Some(VERSION) => {}
            Some(other) => return Err(RunFileError::Version(shortened(other))),
        }
        let (promised, arrays) = (parsed.data_len() as u64, beyond - header_length);
        if promised > arrays {
            return Err(truncated(header_length.saturating_add(promised)));
        }
        let digest = text(&parsed, DIGEST).unwrap_or_default();
        let offset = digest_in(&header, digest).filter(|_| digest.len() == NO_DIGEST.len());
        let offset = offset.ok_or(RunFileError::Altered)?;
        let mut sum = Sha256::new();
        sum.update(length);
        sum.update(&header[..offset]);
        sum.update(NO_DIGEST);
        sum.update(&header[offset + digest.len()..]);
        in_pieces(source, arrays, &mut sink_into(&mut sum))?;
        if hex(sum) != digest {
            return Err(RunFileError::Altered);
        }
        if promised < arrays {
            return Err(contradiction("there are bytes after the last array"));
        }
        let start = LENGTH as u64 + header_length;
        Ok(Self { header: parsed, source: RefCell::new(source), start })
    }

    fn emit(&self, name: &str, sink: &mut Sink<'_>) -> Result<(), RunFileError> {
        let (start, end) = self.info(name)?.data_offsets;
        let mut source = self.source.borrow_mut();
        source.seek(SeekFrom::Start(self.start + start as u64))?;
        Ok(in_pieces(&mut **source, (end - start) as u64, sink)?)
    }

    /// All metadata texts with their keys, in no particular order.
    pub(super) fn texts(&self) -> impl Iterator<Item = (&String, &String)> {
        self.header.metadata().iter().flatten()
    }

    pub(super) fn text(&self, key: &str) -> Result<&str, RunFileError> {
        text(&self.header, key).ok_or_else(|| contradiction(format!("the text `{key}` is missing")))
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.header.info(name).is_some()
    }

    pub(super) fn shape(&self, name: &str) -> Result<&[usize], RunFileError> {
        Ok(&self.info(name)?.shape)
    }

    fn info(&self, name: &str) -> Result<&TensorInfo, RunFileError> {
        let info = self.header.info(name);
        info.ok_or_else(|| contradiction(format!("the array `{name}` is missing")))
    }

    /// The items of an array whose shape is `shape`, with one more axis if items have several numbers.
    pub(super) fn items<E: Number, const N: usize>(
        &self,
        name: &str,
        shape: &[usize],
    ) -> Result<Vec<[E; N]>, RunFileError> {
        let info = self.info(name)?;
        let expected: Vec<usize> = shape.iter().copied().chain((N > 1).then_some(N)).collect();
        if (info.dtype, &info.shape) != (E::DTYPE, &expected) {
            return Err(contradiction(format!(
                "the array `{name}` is {} {}; it must be {} {expected:?}",
                info.dtype,
                shortened(&format!("{:?}", info.shape)),
                E::DTYPE
            )));
        }
        let length = info.data_offsets.1 - info.data_offsets.0;
        // The header's validation has ensured that shape and length agree.
        let mut items = try_map(length / size_of::<[E; N]>(), |_| [E::zeroed(); N])
            .map_err(|_| RunFileError::Memory { name: name.to_owned(), bytes: length as u64 })?;
        let mut rest: &mut [u8] = bytemuck::cast_slice_mut(items.as_flattened_mut());
        self.emit(name, &mut |piece| rest.write_all(piece))?;
        Ok(items)
    }

    /// The items of a list of any length; see [`Container::items`].
    pub(super) fn list<E: Number, const N: usize>(&self, name: &str) -> Result<Vec<[E; N]>, RunFileError> {
        let count = self.shape(name)?.first().copied().unwrap_or_default();
        self.items(name, &[count])
    }

    /// The items of an array with one number each; see [`Container::items`].
    pub(super) fn numbers<E: Number>(&self, name: &str, shape: &[usize]) -> Result<Vec<E>, RunFileError> {
        Ok(self.items::<E, 1>(name, shape)?.into_iter().map(|[number]| number).collect())
    }

    /// The items of an array whose number is known in advance; see [`Container::items`].
    pub(super) fn fixed<E: Number, const N: usize, const M: usize>(
        &self,
        name: &str,
    ) -> Result<[[E; N]; M], RunFileError> {
        let items = self.items(name, if M > 1 { &[M] } else { &[] })?;
        items.try_into().map_err(|_| contradiction(format!("the array `{name}` is too short")))
    }
}

/// The number of items that are converted to bytes at a time.
const CHUNK: usize = 1 << 12;

// The format has the lowest byte first, so numbers are copied as they are in memory.
const _: () = assert!(cfg!(target_endian = "little"), "run files need the lowest byte first");

/// A type of numbers in arrays.
pub(super) trait Number: Pod + Send + Sync {
    /// The name of the type in the format.
    const DTYPE: Dtype;
}

/// A byte that should be a truth value, 0 or 1.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(transparent)]
pub(super) struct Flag(pub(super) u8);

macro_rules! numbers {
    ($($number:ty: $name:ident),+) => {
        $(impl Number for $number {
            const DTYPE: Dtype = Dtype::$name;
        })+
    };
}
numbers!(f32: F32, f64: F64, u32: U32, u8: U8, Flag: BOOL);

/// A function that takes bytes piece by piece.
pub(super) type Sink<'a> = dyn FnMut(&[u8]) -> io::Result<()> + 'a;

/// A function that writes all bytes of an array to a sink.
type Emit<'a> = dyn Fn(&mut Sink<'_>) -> io::Result<()> + 'a;

/// An array to be written. Its bytes are generated when they are needed.
pub(super) struct Array<'a> {
    name: &'static str,
    dtype: Dtype,
    shape: Vec<usize>,
    emit: Box<Emit<'a>>,
}

impl<'a> Array<'a> {
    /// An array with `N` numbers for each item. `shape` is the shape of the items.
    pub(super) fn new<T: Clone + 'a, E: Number, const N: usize>(
        name: &'static str,
        shape: &[usize],
        items: impl Into<Cow<'a, [T]>>,
        numbers: impl Fn(&T) -> [E; N] + 'a,
    ) -> Self {
        let items = items.into();
        let emit = move |sink: &mut Sink<'_>| {
            items.chunks(CHUNK).try_for_each(|chunk| {
                let chunk: Vec<[E; N]> = chunk.iter().map(&numbers).collect();
                sink(bytemuck::cast_slice(chunk.as_flattened()))
            })
        };
        let columns = (N > 1).then_some(N);
        let shape = shape.iter().copied().chain(columns).collect();
        Self { name, dtype: E::DTYPE, shape, emit: Box::new(emit) }
    }

    /// An array with an item for each element of a list; see [`Array::new`].
    pub(super) fn list<T: Clone + 'a, E: Number, const N: usize>(
        name: &'static str,
        items: impl Into<Cow<'a, [T]>>,
        numbers: impl Fn(&T) -> [E; N] + 'a,
    ) -> Self {
        let items = items.into();
        Self::new(name, &[items.len()], items, numbers)
    }

    /// The arrays of spheres and of cones, if there are some, which are also the input of the scene's digest.
    pub(super) fn shapes(scene: &'a Scene) -> impl Iterator<Item = Self> {
        let spheres = Self::list("spheres", scene.spheres(), |sphere| *sphere);
        let cones = Self::list("cones", scene.cones(), |cone| bytemuck::cast::<_, [f32; 8]>(*cone));
        [spheres].into_iter().chain(Some(cones).filter(|_| !scene.cones().is_empty()))
    }

    fn bytes(&self) -> usize {
        self.shape.iter().product::<usize>() * self.dtype.bitsize() / 8
    }

    pub(super) fn emit(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        (self.emit)(sink)
    }
}
