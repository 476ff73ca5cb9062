//! Reads trajectories in the format of CHARMM and X-PLOR (`.dcd`), which NAMD, `OpenMM`, LAMMPS and others write as
//! well.
//!
//! The file is a sequence of Fortran records: the number of bytes before and after each, in 32 or 64 bits. The first
//! three are a header of 84 bytes, a title and the number of atoms; if atoms are fixed, the list of those that are not
//! follows. A frame is a record for the unit cell, if the header says so, and one each for all x, y and z in f32, and for
//! a fourth dimension, if the header says so. Only the first frame has the fixed atoms. Lengths are taken as they are, in
//! Å.

mod cell;
mod header;

use std::ops::Range;

pub(super) use header::starts;
use header::{CELL_BYTES, Header};

use super::binary::{Reader, numbers, wrong_position};
use super::error::LoadError;
use super::format::{FrameIndex, FrameReader, Frames, Options};
use super::frame::FrameSpan;
use super::loaded::Loaded;
use super::source::Bytes;
use super::topology::{Positions, Topology};

/// How frames are found and read one by one.
pub(super) const FRAMES: Frames = Frames::Positions { find };

fn find(
    source: &mut dyn Bytes,
    _: Option<usize>,
    topology: Option<Topology>,
) -> Result<FrameIndex, LoadError> {
    let topology = Topology::required(topology, "dcd")?;
    let mut reader = header::reader(source)?;
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
        notes.push(format!(
            "the header declares {} frames, but the file has {count}",
            header.frames
        ));
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
    /// Where the first frame is, which has the fixed atoms.
    first: Range<u64>,
    topology: Topology,
}

impl FrameReader for Dcd {
    fn read(
        &self,
        source: &mut dyn Bytes,
        frame: usize,
        span: &FrameSpan,
        _: &Options,
    ) -> Result<Loaded, LoadError> {
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
    /// Reads a frame; `positions` has those of the fixed atoms if it is not the first.
    fn read_frame(
        &self,
        reader: &mut Reader<'_>,
        frame: usize,
        positions: &mut Positions,
    ) -> Result<(), LoadError> {
        let header = &self.header;
        positions.cell = None;
        if header.has_cell {
            let offset = reader.offset;
            let bytes = header.record(reader, CELL_BYTES, "the unit cell")?;
            let mut cell = [0.0; 6];
            for (value, number) in cell.iter_mut().zip(numbers(&bytes, header.order)) {
                *value = number;
            }
            positions.cell = cell::edges(cell)
                .map_err(|message| LoadError::byte(offset, format!("frame {frame}: {message}")))?;
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
