//! Reads trajectories in the format of CHARMM and X-PLOR (`.dcd`), which NAMD, `OpenMM`, LAMMPS and others write as
//! well.
//!
//! The file is a sequence of Fortran records, with the number of bytes before and after each, in 32 or 64 bits. The
//! first three are a header of 84 bytes, a title and the number of atoms. If atoms are fixed, the list of the others
//! follows. A frame is a record for the unit cell, if the header says so, one each for all x, y and z in f32, and one
//! for a fourth dimension, if the header says so. Only the first frame has the fixed atoms. Lengths are taken as they
//! are, in Å.

use std::ops::Range;

use crate::load::atoms::edges_of;
use crate::load::dataset::Dataset;
use crate::load::error::LoadError;
use crate::load::format::{FrameIndex, FrameReader, FrameSpan, Frames, Options};
use crate::load::numbers::{Order, Reader, numbers, wrong_position, wrong_start};
use crate::load::source::Bytes;
use crate::load::topology::{Positions, Topology};

pub(super) const FRAMES: Frames = Frames::Positions { find };

fn find(source: &mut dyn Bytes, _: Option<usize>, topology: Option<Topology>) -> Result<FrameIndex, LoadError> {
    let topology = Topology::required(topology, "dcd")?;
    let mut reader = reader(source)?;
    let header = Header::read(&mut reader)?;
    topology.check(0, header.atoms)?;
    let start = reader.offset;
    let first = header.frame_bytes(0);
    reader.check(first, "frame 0")?;
    let others = header.frame_bytes(1);
    let count = 1 + (reader.left() - first) / others;
    let spans = (0..count).map(|index| match index {
        0 => start..start + first,
        _ => start + first + (index - 1) * others..start + first + index * others,
    });
    let frames: Vec<_> = spans.map(|bytes| FrameSpan { bytes, lines_before: 0 }).collect();
    let end = frames.last().map_or(start, |last| last.bytes.end);
    reader.seek(end)?;
    let problem = match reader.left() {
        0 => None,
        _ => reader.check(others, format!("frame {count}")).err(),
    };
    let mut notes = Vec::new();
    if problem.is_none() && u64::from(header.frames) > count {
        notes.push(format!("the header declares {} frames, but the file has {count}", header.frames));
    }
    if header.has_fourth {
        notes.push("the fourth dimension of the positions is not used".to_owned());
    }
    let reader = Some(Box::new(Dcd { first: start..start + first, header, topology }) as Box<_>);
    Ok(FrameIndex {
        frames,
        is_whole: problem.is_none(),
        stands_alone: true,
        problem,
        notes,
        reader,
        ..FrameIndex::default()
    })
}

#[derive(Debug)]
struct Dcd {
    header: Header,
    /// Range of bytes of the first frame, which has the fixed atoms.
    first: Range<u64>,
    topology: Topology,
}

impl FrameReader for Dcd {
    fn read(&self, source: &mut dyn Bytes, frame: usize, span: &FrameSpan, _: &Options) -> Result<Dataset, LoadError> {
        let header = &self.header;
        let mut reader = Reader::new(source, header.order)?;
        let mut positions = Positions::default();
        if frame > 0 && !header.free.is_empty() {
            positions.centers = vec![[0.0; 3]; header.atoms];
            reader.seek(self.first.start)?;
            self.read_frame(&mut reader, 0, &mut positions)?;
        }
        reader.seek(span.bytes.start)?;
        self.read_frame(&mut reader, frame, &mut positions)?;
        self.topology.join(frame, positions)
    }
}

impl Dcd {
    /// Reads a frame. After the first frame, `positions` must already have the fixed atoms.
    fn read_frame(&self, reader: &mut Reader<'_>, frame: usize, positions: &mut Positions) -> Result<(), LoadError> {
        let header = &self.header;
        positions.cell = None;
        if header.has_cell {
            let offset = reader.offset;
            let bytes = header.record(reader, CELL_BYTES, "the unit cell")?;
            let mut cell = [0.0; 6];
            for (value, number) in cell.iter_mut().zip(numbers(&bytes, header.order)) {
                *value = number;
            }
            positions.cell =
                edges(cell).map_err(|message| LoadError::byte(offset, format!("frame {frame}: {message}")))?;
        }
        let moving = header.moving(frame);
        positions.centers.resize(header.atoms, [0.0; 3]);
        for (component, axis) in ['x', 'y', 'z'].into_iter().enumerate() {
            let start = reader.offset + header.marker_bytes;
            let what = format!("frame {frame}: the {axis} coordinates");
            let bytes = header.record(reader, 4 * moving as u64, &what)?;
            for (index, number) in numbers::<f32>(&bytes, header.order).enumerate() {
                let all_move = moving == header.atoms;
                let atom = if all_move { index } else { header.free[index] as usize };
                let found = f64::from(number);
                if !found.is_finite() {
                    let offset = start + 4 * index as u64;
                    return Err(wrong_position(offset, frame, atom, axis, found));
                }
                positions.centers[atom][component] = found;
            }
        }
        Ok(())
    }
}

const HEADER_BYTES: u64 = 84;
const NAME: &[u8] = b"CORD";

const CELL_BYTES: u64 = 48;

/// The layout of the frames, as a file declares it.
#[derive(Debug)]
struct Header {
    order: Order,
    /// Number of bytes of the length that stands before and after each record.
    marker_bytes: u64,
    atoms: usize,
    /// Number of frames; 0 if the program that wrote the file was stopped early.
    frames: u32,
    has_cell: bool,
    /// Whether positions have a fourth dimension.
    has_fourth: bool,
    /// Indices of the atoms that are not fixed, from 0; empty if none is fixed.
    free: Vec<u32>,
}

/// The byte order and the number of bytes of a record's length, if the first bytes are those of a DCD file.
fn layout(bytes: &[u8]) -> Option<(Order, u64)> {
    for order in [Order::Little, Order::Big] {
        for marker_bytes in [4, 8] {
            let is_after =
                bytes.get(marker_bytes..).is_some_and(|rest| rest.starts_with(NAME) || rest.starts_with(b"VELD"));
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

pub(super) fn starts(bytes: &[u8]) -> bool {
    layout(bytes).is_some()
}

/// Returns a reader in the byte order of the file.
fn reader(source: &mut dyn Bytes) -> Result<Reader<'_>, LoadError> {
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
    fn read(reader: &mut Reader<'_>) -> Result<Self, LoadError> {
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
            let message = "the file has velocities (VELD) and no positions; give the trajectory of positions";
            return Err(LoadError::byte(marker_bytes, message));
        }
        let control: Vec<u32> = numbers(&first[4..], reader.order).collect();
        header.frames = control[0];
        // Only files of CHARMM's kind, which have a version at the end of the header, have a cell or a fourth axis.
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
        // The size of a frame is checked before memory depends on the number of atoms.
        reader.check(header.frame_bytes(0), format!("a frame of {atoms} atoms"))?;
        if fixed > 0 {
            let start = reader.offset + marker_bytes;
            let free = 4 * (header.atoms - fixed) as u64;
            let free = header.record(reader, free, "the list of atoms that move")?;
            for (index, number) in numbers::<i32>(&free, reader.order).enumerate() {
                let is_atom = (1..=atoms).contains(&number);
                if !is_atom {
                    let message = format!("{number} is not the number of an atom, from 1 to {atoms}");
                    return Err(LoadError::byte(start + 4 * index as u64, message));
                }
                header.free.push(number as u32 - 1);
            }
        }
        Ok(header)
    }

    fn moving(&self, frame: usize) -> usize {
        if frame == 0 || self.free.is_empty() { self.atoms } else { self.free.len() }
    }

    fn frame_bytes(&self, frame: usize) -> u64 {
        let markers = 2 * self.marker_bytes;
        let cell = if self.has_cell { CELL_BYTES + markers } else { 0 };
        let axes = if self.has_fourth { 4 } else { 3 };
        cell + axes * (4 * self.moving(frame) as u64 + markers)
    }

    /// Reads a record, which must have this length.
    fn record(&self, reader: &mut Reader<'_>, length: u64, what: &str) -> Result<Vec<u8>, LoadError> {
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

    fn end_of_record(&self, reader: &mut Reader<'_>, length: u64, what: &str) -> Result<(), LoadError> {
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

/// Returns the edge vectors of a cell; `None` if its lengths are 0, which means no cell.
///
/// The six numbers are a, the angle between a and b, b, the angle between a and c, the angle between b and c, and c.
/// Angles are degrees, or cosines (CHARMM, NAMD). Newer versions of CHARMM write the six different elements of a
/// symmetric matrix whose rows are the edges. They are assumed if the numbers cannot be lengths and angles.
fn edges(cell: [f64; 6]) -> Result<Option<[[f64; 3]; 3]>, String> {
    let [a, gamma, b, beta, alpha, c] = cell;
    if cell.iter().any(|value| !value.is_finite()) {
        return Err(format!("the unit cell {cell:?} has a number that is not finite"));
    }
    if a == 0.0 && b == 0.0 && c == 0.0 {
        return Ok(None);
    }
    if let Some(edges) = from_angles([a, b, c], [alpha, beta, gamma]) {
        return Ok(Some(edges));
    }
    let [xx, xy, yy, xz, yz, zz] = cell;
    if xx > 0.0 && yy > 0.0 && zz > 0.0 {
        return Ok(Some([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]));
    }
    Err(format!("the unit cell {cell:?} is neither lengths and angles nor a matrix"))
}

fn from_angles(lengths: [f64; 3], angles: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    if lengths.iter().any(|length| *length <= 0.0) || angles.iter().any(|angle| *angle < -1.0 || *angle >= 180.0) {
        return None;
    }
    let are_cosines = angles.iter().all(|angle| angle.abs() <= 1.0);
    let cosines = angles.map(|angle| match angle {
        cosine if are_cosines => cosine,
        90.0 => 0.0,
        degrees => degrees.to_radians().cos(),
    });
    edges_of(lengths, cosines)
}
