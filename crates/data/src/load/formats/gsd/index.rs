//! The file layer of GSD: which chunks of data each frame has, and where they are.
//!
//! A file has a header of 256 bytes, a list of names, an index with an entry of 32 bytes for each chunk, ascending by
//! frames, and the chunks, all in little endian. Versions 1 and 2 fill the list of names differently: with every name
//! in 64 bytes, or with one after the other. <https://gsd.readthedocs.io/en/stable/file-layer.html>

use std::collections::HashMap;

use crate::load::error::LoadError;
use crate::load::numbers::{Order, Reader, Scalar, shown, wrong_start};

const MAGIC: u64 = 0x65DF_65DF_65DF_65DF;
const HEADER_BYTES: u64 = 256;
const ENTRY_BYTES: u64 = 32;
const NAME_BYTES: u64 = 64;

pub(crate) fn starts(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC.to_le_bytes())
}

#[derive(Debug)]
pub(super) struct Index {
    names: Vec<String>,
    ids: HashMap<String, u16>,
    chunks: Vec<Chunk>,
    /// The fault after the last frame whose chunks are complete.
    pub(super) problem: Option<LoadError>,
}

/// A chunk: a table of numbers of one type.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chunk {
    pub(super) frame: u64,
    pub(super) rows: u64,
    pub(super) columns: u32,
    /// Byte at which the numbers begin.
    pub(super) location: u64,
    id: u16,
    kind: u8,
}

impl Chunk {
    /// The type of the numbers; `None` if it is not known.
    fn scalar(self) -> Option<Scalar> {
        Some(match self.kind {
            1 | 11 => Scalar::U8,
            2 => Scalar::U16,
            3 => Scalar::U32,
            4 => Scalar::U64,
            5 => Scalar::I8,
            6 => Scalar::I16,
            7 => Scalar::I32,
            8 => Scalar::I64,
            9 => Scalar::F32,
            10 => Scalar::F64,
            _ => return None,
        })
    }

    /// Number of bytes of all numbers; `None` if the type is not known or the number is larger than any file.
    pub(super) fn bytes(self) -> Option<u64> {
        self.rows.checked_mul(self.columns.into())?.checked_mul(self.scalar()?.size() as u64)
    }

    /// Reads all numbers, row by row.
    pub(super) fn numbers(self, reader: &mut Reader<'_>, name: &str) -> Result<Vec<f64>, LoadError> {
        let bytes = self.raw(reader, name)?;
        let Some(scalar) = self.scalar() else { return Ok(Vec::new()) };
        let numbers = bytes.chunks_exact(scalar.size());
        Ok(numbers.map(|number| scalar.decode(number, Order::Little)).collect())
    }

    /// Reads all rows as text. Each ends with a NUL unless the text fills the row.
    pub(super) fn texts(self, reader: &mut Reader<'_>, name: &str) -> Result<Vec<String>, LoadError> {
        let bytes = self.raw(reader, name)?;
        Ok(bytes.chunks_exact((self.columns as usize).max(1)).map(shown).collect())
    }

    fn raw(self, reader: &mut Reader<'_>, name: &str) -> Result<Vec<u8>, LoadError> {
        reader.seek(self.location)?;
        reader.bytes(self.bytes().unwrap_or(u64::MAX), format!("the chunk {name}"))
    }
}

impl Index {
    pub(super) fn read(reader: &mut Reader<'_>) -> Result<Self, LoadError> {
        if reader.left() < HEADER_BYTES {
            return Err(wrong_start("gsd", "it is shorter than the header of 256 bytes"));
        }
        if reader.number::<u64>("the header")? != MAGIC {
            let message = "it does not start with the signature of the format";
            return Err(wrong_start("gsd", message));
        }
        let index_location: u64 = reader.number("the header")?;
        let index_entries: u64 = reader.number("the header")?;
        let names_location: u64 = reader.number("the header")?;
        let names_entries: u64 = reader.number("the header")?;
        reader.seek(reader.offset + 4)?;
        let version: u32 = reader.number("the header")?;
        // Version 0.3 was the last before 1.0, and has the same layout.
        if !matches!(version >> 16, 1 | 2) && version != 3 {
            let message =
                format!("the file has the version {}.{}; 1 and 2 can be read", version >> 16, version & 0xffff);
            return Err(LoadError::byte(44, message));
        }
        reader.seek(reader.offset + 64)?;
        let schema = shown(&reader.bytes(64, "the header")?);
        if schema != "hoomd" {
            let message = format!("the file has the schema `{schema}`; only that of HOOMD-blue, `hoomd`, can be read");
            return Err(LoadError::byte(112, message));
        }
        reader.seek(names_location)?;
        let bytes = names_entries.saturating_mul(NAME_BYTES);
        let names: Vec<_> = reader
            .bytes(bytes, "the list of names")?
            .split(|byte| *byte == 0)
            .filter(|name| !name.is_empty())
            .map(|name| String::from_utf8_lossy(name).into_owned())
            .take(1 << 16)
            .collect();
        // Ids are 16 bits wide.
        let ids = names.iter().enumerate().map(|(id, name)| (name.clone(), id as u16)).collect();
        let mut index = Self { names, ids, chunks: Vec::new(), problem: None };
        reader.seek(index_location)?;
        reader.check(index_entries.saturating_mul(ENTRY_BYTES), "the index")?;
        for _ in 0..index_entries {
            let offset = reader.offset;
            match index.next(reader)? {
                Ok(Some(chunk)) => index.chunks.push(chunk),
                Ok(None) => break,
                Err((frame, message)) => {
                    // A frame that lacks one of its chunks is not complete.
                    index.chunks.retain(|chunk| chunk.frame < frame);
                    index.problem = Some(LoadError::byte(offset, message));
                    break;
                }
            }
        }
        Ok(index)
    }

    /// Reads the next entry; `None` at the end. The inner error has the frame that a bad entry belongs to.
    #[allow(clippy::type_complexity, reason = "used once")]
    fn next(&self, reader: &mut Reader<'_>) -> Result<Result<Option<Chunk>, (u64, String)>, LoadError> {
        let size = reader.size;
        let frame: u64 = reader.number("the index")?;
        let rows = reader.number("the index")?;
        let location: u64 = reader.number("the index")?;
        let columns = reader.number("the index")?;
        let id = reader.number("the index")?;
        let kind = reader.number("the index")?;
        let _flags: u8 = reader.number("the index")?;
        let chunk = Chunk { frame, rows, columns, location, id, kind };
        if location == 0 {
            return Ok(Ok(None));
        }
        let previous = self.chunks.last().map_or(0, |chunk| chunk.frame);
        let Some(name) = self.names.get(usize::from(id)) else {
            return Ok(Err((
                frame,
                format!("this entry of the index has the name {id}, but there are {}", self.names.len()),
            )));
        };
        let name = shown(name.as_bytes());
        // A frame without changes has no chunk at all. More frames than bytes are not plausible.
        if frame < previous || frame > size {
            return Ok(Err((
                frame.min(previous),
                format!("this entry of the index belongs to frame {frame}, but follows one of frame {previous}"),
            )));
        }
        let fits = chunk.bytes().and_then(|bytes| location.checked_add(bytes)).is_some_and(|end| end <= size);
        Ok(if chunk.scalar().is_none() {
            Err((frame, format!("frame {frame}: the chunk {name} has the unknown type {kind}")))
        } else if fits {
            Ok(Some(chunk))
        } else {
            Err((
                frame,
                format!(
                    "frame {frame}: the chunk {name} has {rows} × {columns} numbers from byte {location} on, but the file \
                 has {size} bytes; it is cut off or still being written"
                ),
            ))
        })
    }

    pub(super) fn frames(&self) -> u64 {
        self.chunks.last().map_or(0, |chunk| chunk.frame + 1)
    }

    /// The chunks of a frame, with their names.
    pub(super) fn chunks(&self, frame: u64) -> impl Iterator<Item = (&str, Chunk)> {
        let first = self.chunks.partition_point(|chunk| chunk.frame < frame);
        let of_frame = self.chunks[first..].iter().take_while(move |chunk| chunk.frame == frame);
        of_frame.map(|chunk| (self.names[usize::from(chunk.id)].as_str(), *chunk))
    }

    /// Whether any frame has a chunk with this name.
    pub(super) fn has_name(&self, name: &str) -> bool {
        self.ids.contains_key(name)
    }

    /// The chunk of a frame with this name.
    pub(super) fn chunk(&self, frame: u64, name: &str) -> Option<Chunk> {
        let id = *self.ids.get(name)?;
        self.chunks(frame).find(|(_, chunk)| chunk.id == id).map(|(_, chunk)| chunk)
    }
}
