//! Reads files of GROMACS: coordinates as text (`.gro`), and the trajectories `.trr` (full precision) and `.xtc`
//! (compressed). The trajectories are in XDR, which is big-endian and pads everything to 4 bytes. Lengths are nm in the
//! file and Å in the result, to fit other files of atoms.

mod gro;
mod trr;
mod xtc;

pub(super) use gro::{FRAMES as GRO, starts as starts_gro};
pub(super) use trr::{FRAMES as TRR, starts as starts_trr};
pub(super) use xtc::{FRAMES as XTC, starts as starts_xtc};

use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, LoadErrorKind};
use crate::load::format::{FrameIndex, FrameReader, FrameSpan, Options};
use crate::load::numbers::{Order, Reader};
use crate::load::source::Bytes;
use crate::load::topology::{Positions, Topology};

const ANGSTROMS: f64 = 10.0;

/// Checks a frame's header, and returns where the frame ends and whether it has positions.
type NextFrame = fn(&mut Reader<'_>, usize) -> Result<(u64, bool), LoadError>;

/// Reads the positions of a frame. The topology has the number of atoms.
type ReadFrame = fn(&mut Reader<'_>, usize, &Topology) -> Result<Positions, LoadError>;

#[derive(Debug)]
struct Trajectory {
    topology: Topology,
    read: ReadFrame,
}

impl FrameReader for Trajectory {
    fn read(&self, source: &mut dyn Bytes, frame: usize, span: &FrameSpan, _: &Options) -> Result<Dataset, LoadError> {
        let mut reader = Reader::new(source, Order::Big)?;
        reader.seek(span.bytes.start)?;
        let positions = (self.read)(&mut reader, frame, &self.topology)?;
        self.topology.join(frame, positions)
    }
}

/// Finds frames one after the other.
fn find_frames(
    source: &mut dyn Bytes,
    last: Option<usize>,
    topology: Topology,
    next: NextFrame,
    read: ReadFrame,
) -> Result<FrameIndex, LoadError> {
    let reader = &mut Reader::new(source, Order::Big)?;
    let mut found = FrameIndex { stands_alone: true, ..FrameIndex::default() };
    let mut without = 0_u64;
    loop {
        let start = reader.offset;
        let index = found.frames.len();
        if reader.left() == 0 {
            found.is_whole = true;
            break;
        }
        if last.is_some_and(|last| index > last) {
            break;
        }
        match next(reader, index) {
            Ok((end, has_positions)) => {
                if has_positions {
                    found.frames.push(FrameSpan { bytes: start..end, lines_before: 0 });
                } else {
                    without += 1;
                }
                reader.seek(end)?;
            }
            Err(error) if error.kind == LoadErrorKind::Io => return Err(error),
            Err(problem) => {
                found.problem = Some(problem);
                break;
            }
        }
    }
    if without > 0 {
        found.notes.push(format!("{without} frames without positions are left out"));
    }
    if found.frames.is_empty() && found.problem.is_none() {
        let message = "no frame has positions";
        found.problem = Some(LoadError::byte(0, message));
    }
    found.reader = Some(Box::new(Trajectory { topology, read }));
    Ok(found)
}

/// The edges of a cell, in nm; `None` if they are 0, which means no cell.
fn cell_of(edges: [f64; 9], offset: u64, frame: usize) -> Result<Option<[[f64; 3]; 3]>, LoadError> {
    if edges.iter().any(|value| !value.is_finite()) {
        let message = format!("frame {frame}: the cell has a number that is not finite");
        return Err(LoadError::byte(offset, message));
    }
    let [a, b, c, d, e, f, g, h, i] = edges.map(|edge| edge * ANGSTROMS);
    Ok(edges.iter().any(|edge| *edge != 0.0).then_some([[a, b, c], [d, e, f], [g, h, i]]))
}
