//! Reads compressed trajectories of GROMACS (`.xtc`).
//!
//! The crate molly reads them too, but trusts them: it panics on a damaged file and prints warnings.

use super::unpack::{self, Packed};
use super::{ANGSTROMS, cell_of, find_frames};
use crate::load::binary::{Order, Reader, numbers, wrong_position, wrong_start};
use crate::load::error::LoadError;
use crate::load::format::{FrameIndex, FrameReader, Frames, Options};
use crate::load::frame::FrameSpan;
use crate::load::loaded::Loaded;
use crate::load::source::Bytes;
use crate::load::topology::{Positions, Topology};

/// How frames are found and read one by one.
pub(in crate::load) const FRAMES: Frames = Frames::Positions { find };

/// The usual number at the start of a frame.
const MAGIC: i32 = 1995;
/// The same, where the number of compressed bytes has 64 bits.
const LONG_MAGIC: i32 = 2023;
/// Bytes of a header up to the positions.
const HEADER_BYTES: u64 = 56;
/// So few positions are not compressed.
const FEW: usize = 9;

/// Whether the first bytes are those of an XTC file: its number, and a number of atoms that is there twice.
pub(in crate::load) fn starts(bytes: &[u8]) -> bool {
    let is_magic = |magic: i32| bytes.starts_with(&magic.to_be_bytes());
    (is_magic(MAGIC) || is_magic(LONG_MAGIC))
        && bytes.get(4..8).is_some_and(|atoms| bytes.get(52..56) == Some(atoms))
}

fn find(
    source: &mut dyn Bytes,
    last: Option<usize>,
    topology: Option<Topology>,
) -> Result<FrameIndex, LoadError> {
    let topology = Topology::required(topology, "xtc")?;
    let mut reader = Reader::new(source, Order::Big)?;
    let mut found = find_frames(&mut reader, last, |reader, index| {
        let header = Header::read(reader, index)?;
        reader.check(header.bytes, format!("frame {index}"))?;
        Ok((reader.offset + header.bytes, true))
    })?;
    found.reader = Some(Box::new(Xtc { topology }));
    Ok(found)
}

/// What a frame says about itself.
struct Header {
    atoms: usize,
    cell: [f64; 9],
    /// How positions are compressed, unless they are few.
    packed: Option<Packed>,
    /// Bytes of the positions, which follow, with those that pad them.
    bytes: u64,
}

impl Header {
    /// Reads the header of a frame, up to its positions.
    fn read(reader: &mut Reader<'_>, index: usize) -> Result<Self, LoadError> {
        let start = reader.offset;
        let what = format!("the header of frame {index}");
        let magic: i32 = reader.number(&what)?;
        if !matches!(magic, MAGIC | LONG_MAGIC) {
            let message = format!("a frame must start with 1995 or 2023, but starts with {magic}");
            return Err(match start {
                0 => wrong_start("xtc", message),
                _ => LoadError::byte(start, message),
            });
        }
        let offset = reader.offset;
        let wrong =
            |offset, message: String| LoadError::byte(offset, format!("frame {index}: {message}"));
        let atoms: i32 = reader.number(&what)?;
        let _step: i32 = reader.number(&what)?;
        let _time: f32 = reader.number(&what)?;
        let mut cell = [0.0; 9];
        for (value, number) in
            cell.iter_mut().zip(numbers::<f32>(&reader.bytes(36, what.as_str())?, Order::Big))
        {
            *value = number.into();
        }
        let again: i32 = reader.number(&what)?;
        let Some(atoms) = usize::try_from(atoms)
            .ok()
            .filter(|atoms| *atoms > 0 && again == atoms.cast_signed() as i32)
        else {
            return Err(wrong(offset, format!("it declares {atoms} and then {again} atoms")));
        };
        if atoms <= FEW {
            return Ok(Self { atoms, cell, packed: None, bytes: 12 * atoms as u64 });
        }
        let packed = Packed::read(reader, &what).and_then(|packed| {
            packed.check().map_err(|message| wrong(start + HEADER_BYTES, message)).map(|()| packed)
        })?;
        let offset = reader.offset;
        let bytes: u64 = match magic {
            MAGIC => reader.number::<u32>(&what)?.into(),
            _ => reader.number(&what)?,
        };
        // Not even one bit for each atom: memory depends on their number.
        if atoms as u64 / 8 > bytes {
            return Err(wrong(offset, format!("{bytes} bytes are too few for {atoms} atoms")));
        }
        Ok(Self { atoms, cell, packed: Some(packed), bytes: bytes.saturating_add(3) / 4 * 4 })
    }
}

#[derive(Debug)]
struct Xtc {
    topology: Topology,
}

impl FrameReader for Xtc {
    fn read(
        &self,
        source: &mut dyn Bytes,
        frame: usize,
        span: &FrameSpan,
        _: &Options,
    ) -> Result<Loaded, LoadError> {
        let mut reader = Reader::new(source, Order::Big)?;
        reader.seek(span.bytes.start)?;
        let header = Header::read(&mut reader, frame)?;
        self.topology.check(frame, header.atoms)?;
        let cell = cell_of(header.cell, span.bytes.start + 16, frame)?;
        let offset = reader.offset;
        let bytes = reader.bytes(header.bytes, "the positions")?;
        let centers: Vec<[f64; 3]> = match header.packed {
            None => {
                let values: Vec<f64> = numbers::<f32>(&bytes, Order::Big).map(f64::from).collect();
                values.as_chunks().0.to_vec()
            }
            Some(packed) => unpack::positions(&bytes, &packed, header.atoms).map_err(|error| {
                let message = format!("frame {frame}: {}", error.message);
                LoadError::byte(offset + error.byte, message)
            })?,
        };
        for (atom, center) in centers.iter().enumerate() {
            if let Some(axis) = center.iter().position(|value| !value.is_finite()) {
                let (found, axis) = (center[axis], ['x', 'y', 'z'][axis]);
                return Err(wrong_position(offset, frame, atom, axis, found));
            }
        }
        let centers = centers.into_iter().map(|center| center.map(|length| length * ANGSTROMS));
        self.topology
            .join(frame, Positions { centers: centers.collect(), cell, ..Positions::default() })
    }
}
