//! The records before the first frame of a DCD file.

use crate::load::binary::{Order, Reader, numbers, wrong_start};
use crate::load::error::LoadError;
use crate::load::source::Bytes;

/// Bytes of the first record.
const HEADER_BYTES: u64 = 84;
const NAME: &[u8] = b"CORD";

/// Bytes of the record of a unit cell.
pub(super) const CELL_BYTES: u64 = 48;

/// What a file says about its frames.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) order: Order,
    /// Bytes of the length before and after each record.
    pub(super) marker_bytes: u64,
    pub(super) atoms: usize,
    /// Number of frames; 0 where a program did not come to write it.
    pub(super) frames: u32,
    pub(super) has_cell: bool,
    /// Whether positions have a fourth dimension.
    pub(super) has_fourth: bool,
    /// Indices of the atoms that are not fixed, from 0, if some are fixed.
    pub(super) free: Vec<u32>,
}

/// The order of bytes, and the bytes of the length of a record, if the first bytes are those of a file of this kind.
fn layout(bytes: &[u8]) -> Option<(Order, u64)> {
    for order in [Order::Little, Order::Big] {
        for marker_bytes in [4, 8] {
            let is_after = bytes
                .get(marker_bytes..)
                .is_some_and(|rest| rest.starts_with(NAME) || rest.starts_with(b"VELD"));
            if is_after && marker(bytes, order, marker_bytes as u64) == HEADER_BYTES {
                return Some((order, marker_bytes as u64));
            }
        }
    }
    None
}

fn marker(bytes: &[u8], order: Order, marker_bytes: u64) -> u64 {
    match marker_bytes {
        4 => numbers::<u32>(bytes, order).next().unwrap_or_default().into(),
        _ => numbers(bytes, order).next().unwrap_or_default(),
    }
}

/// Whether the first bytes are those of a DCD file.
pub(in crate::load) fn starts(bytes: &[u8]) -> bool {
    layout(bytes).is_some()
}

/// A reader in the order of a file's bytes.
pub(super) fn reader(source: &mut dyn Bytes) -> Result<Reader<'_>, LoadError> {
    let mut reader = Reader::new(source, Order::Little)?;
    let first = reader.bytes(reader.size.min(12), "the header")?;
    let message = "it does not start with a record of 84 bytes for CORD";
    let (order, _) = layout(&first).ok_or_else(|| wrong_start("dcd", message))?;
    reader.order = order;
    reader.seek(0)?;
    Ok(reader)
}

impl Header {
    /// Reads all records before the first frame.
    pub(super) fn read(reader: &mut Reader<'_>) -> Result<Self, LoadError> {
        let first = reader.bytes(reader.size.min(12), "the header")?;
        reader.seek(0)?;
        let marker_bytes = layout(&first).map_or(4, |(_, bytes)| bytes);
        let mut header = Self {
            order: reader.order,
            marker_bytes,
            atoms: 0,
            frames: 0,
            has_cell: false,
            has_fourth: false,
            free: Vec::new(),
        };
        let first = header.record(reader, HEADER_BYTES, "the header")?;
        if !first.starts_with(NAME) {
            let message =
                "the file has velocities (VELD) and no positions; give the trajectory of positions";
            return Err(LoadError::byte(marker_bytes, message));
        }
        let control: Vec<u32> = numbers(&first[4..], reader.order).collect();
        header.frames = control[0];
        // Only files of CHARMM's kind, which have a version at the end, have these.
        let is_charmm = control[19] != 0;
        header.has_cell = is_charmm && control[10] != 0;
        header.has_fourth = is_charmm && control[11] != 0;
        let title = header.marker(reader, "the title")?;
        header.end_of_record(reader, title, "the title")?;
        let start = reader.offset + marker_bytes;
        let atoms = header.record(reader, 4, "the number of atoms")?;
        let atoms: i32 = numbers(&atoms, reader.order).next().unwrap_or_default();
        header.atoms = usize::try_from(atoms)
            .ok()
            .filter(|atoms| *atoms > 0)
            .ok_or_else(|| LoadError::byte(start, format!("the file declares {atoms} atoms")))?;
        let fixed = control[8] as usize;
        if fixed >= header.atoms {
            let message = format!("{fixed} of {atoms} atoms are fixed; at least one must move");
            return Err(LoadError::byte(marker_bytes + 36, message));
        }
        // What one frame takes is checked before memory depends on the number of atoms.
        reader.check(header.frame_bytes(0), format!("a frame of {atoms} atoms"))?;
        if fixed > 0 {
            let start = reader.offset + marker_bytes;
            let free = 4 * (header.atoms - fixed) as u64;
            let free = header.record(reader, free, "the list of atoms that move")?;
            for (index, number) in numbers::<i32>(&free, reader.order).enumerate() {
                let is_atom = (1..=atoms).contains(&number);
                if !is_atom {
                    let message =
                        format!("{number} is not the number of an atom, from 1 to {atoms}");
                    return Err(LoadError::byte(start + 4 * index as u64, message));
                }
                header.free.push(number as u32 - 1);
            }
        }
        Ok(header)
    }

    /// Number of atoms that a frame has.
    pub(super) fn moving(&self, frame: usize) -> usize {
        if frame == 0 || self.free.is_empty() { self.atoms } else { self.free.len() }
    }

    /// Bytes of a frame.
    pub(super) fn frame_bytes(&self, frame: usize) -> u64 {
        let markers = 2 * self.marker_bytes;
        let cell = if self.has_cell { CELL_BYTES + markers } else { 0 };
        let axes = if self.has_fourth { 4 } else { 3 };
        cell + axes * (4 * self.moving(frame) as u64 + markers)
    }

    /// Reads a record, which must have this length.
    pub(super) fn record(
        &self,
        reader: &mut Reader<'_>,
        length: u64,
        what: &str,
    ) -> Result<Vec<u8>, LoadError> {
        let offset = reader.offset;
        let found = self.marker(reader, what)?;
        if found != length {
            let message = format!("{what} must take {length} bytes, but the file says {found}");
            return Err(LoadError::byte(offset, message));
        }
        let bytes = reader.bytes(length, what)?;
        self.check_end(reader, length, what)?;
        Ok(bytes)
    }

    fn marker(&self, reader: &mut Reader<'_>, what: &str) -> Result<u64, LoadError> {
        match self.marker_bytes {
            4 => Ok(reader.number::<u32>(what)?.into()),
            _ => reader.number(what),
        }
    }

    /// Skips the rest of a record.
    fn end_of_record(
        &self,
        reader: &mut Reader<'_>,
        length: u64,
        what: &str,
    ) -> Result<(), LoadError> {
        reader.check(length, what)?;
        reader.seek(reader.offset + length)?;
        self.check_end(reader, length, what)
    }

    fn check_end(&self, reader: &mut Reader<'_>, length: u64, what: &str) -> Result<(), LoadError> {
        let offset = reader.offset;
        let found = self.marker(reader, what)?;
        if found == length {
            return Ok(());
        }
        let message = format!("{what} takes {length} bytes, but the file says {found} at its end");
        Err(LoadError::byte(offset, message))
    }
}
