//! Reads trajectories of GROMACS in full precision (`.trr`). Velocities become columns in Å/ps, and forces in
//! kJ/(mol Å).

use super::{ANGSTROMS, cell_of, find_frames};
use crate::load::dataset::{Column, ColumnValues};
use crate::load::error::LoadError;
use crate::load::format::{FrameIndex, Frames};
use crate::load::numbers::{Order, Reader, component_names, numbers, wrong_position, wrong_start};
use crate::load::source::Bytes;
use crate::load::topology::{Positions, Topology};

pub(crate) const FRAMES: Frames = Frames::Positions { find };

const MAGIC: i32 = 1993;
/// The text that starts a frame, after its length with and without a NUL.
const NAME: &[u8] = b"\0\0\0\x0d\0\0\0\x0cGMX_trn_file";
/// Names of the parts of a frame, in order. The first two, the topology and the symbols were never used.
const PARTS: [&str; 10] = [
    "the input record",
    "the energies",
    "the box",
    "the virial",
    "the pressure",
    "the topology",
    "the symbols",
    "the positions",
    "the velocities",
    "the forces",
];
const BOX: usize = 2;
const POSITIONS: usize = 7;

pub(crate) fn starts(bytes: &[u8]) -> bool {
    bytes.strip_prefix(&MAGIC.to_be_bytes()).is_some_and(|rest| rest.starts_with(NAME))
}

fn find(source: &mut dyn Bytes, last: Option<usize>, topology: Option<Topology>) -> Result<FrameIndex, LoadError> {
    let topology = Topology::required(topology, "trr")?;
    let next = |reader: &mut Reader<'_>, index| {
        let header = Header::read(reader, index)?;
        let bytes = header.sizes.iter().sum();
        reader.check(bytes, format!("frame {index}"))?;
        Ok((reader.offset + bytes, header.sizes[POSITIONS] > 0))
    };
    find_frames(source, last, topology, next, read)
}

struct Header {
    /// Number of bytes of each part.
    sizes: [u64; 10],
    atoms: usize,
    is_double: bool,
}

impl Header {
    /// Reads the header of a frame, up to its first part.
    fn read(reader: &mut Reader<'_>, index: usize) -> Result<Self, LoadError> {
        let what = format!("the header of frame {index}");
        let start = reader.offset;
        let magic: i32 = reader.number(&what)?;
        let name = reader.bytes(NAME.len() as u64, what.as_str())?;
        if magic != MAGIC || name != NAME {
            let message = "a frame must start with 1993 and GMX_trn_file";
            return Err(match start {
                0 => wrong_start("trr", message),
                _ => LoadError::byte(start, message),
            });
        }
        let mut sizes = [0; 10];
        for (size, part) in sizes.iter_mut().zip(PARTS) {
            let offset = reader.offset;
            let found: i32 = reader.number(&what)?;
            *size = u64::try_from(found)
                .map_err(|_| LoadError::byte(offset, format!("frame {index}: {part} takes {found} bytes")))?;
        }
        let offset = reader.offset;
        let declared: i32 = reader.number(&what)?;
        let wrong = |message: String| LoadError::byte(offset, format!("frame {index}: {message}"));
        let atoms = u64::try_from(declared)
            .ok()
            .filter(|atoms| *atoms > 0)
            .ok_or_else(|| wrong(format!("it declares {declared} atoms")))?;
        let is_of = |width: u64| {
            let is_table = |size: u64| size == 0 || size == 3 * atoms * width;
            (sizes[BOX] == 0 || sizes[BOX] == 9 * width) && sizes[POSITIONS..].iter().copied().all(is_table)
        };
        if !is_of(4) && !is_of(8) {
            let [x, v, f] = [0, 1, 2].map(|part| sizes[POSITIONS + part]);
            return Err(wrong(format!(
                "box, positions, velocities and forces of {atoms} atoms take {}, {x}, {v} and {f} bytes, which is \
                 neither single nor double precision",
                sizes[BOX]
            )));
        }
        // The header ends with the step and the number of energy records, then the time and lambda.
        let is_double = !is_of(4);
        let rest = if is_double { 24 } else { 16 };
        reader.check(rest, what)?;
        reader.seek(reader.offset + rest)?;
        // The number of atoms is plausible, because a frame of this size can hold them.
        Ok(Self { sizes, atoms: atoms as usize, is_double })
    }
}

fn read(reader: &mut Reader<'_>, frame: usize, topology: &Topology) -> Result<Positions, LoadError> {
    let header = Header::read(reader, frame)?;
    topology.check(frame, header.atoms)?;
    let mut positions = Positions::default();
    for (part, what) in PARTS.into_iter().enumerate() {
        let offset = reader.offset;
        let size = header.sizes[part];
        if size == 0 || !(part == BOX || part >= POSITIONS) {
            reader.seek(offset + size)?;
            continue;
        }
        let bytes = reader.bytes(size, what)?;
        let values: Vec<f64> = match header.is_double {
            true => numbers::<f64>(&bytes, Order::Big).collect(),
            false => numbers::<f32>(&bytes, Order::Big).map(f64::from).collect(),
        };
        match part {
            BOX => {
                let edges = *values.first_chunk().unwrap_or(&[0.0; 9]);
                positions.cell = cell_of(edges, offset, frame)?;
            }
            POSITIONS => {
                positions.centers = values
                    .as_chunks()
                    .0
                    .iter()
                    .map(|center: &[f64; 3]| center.map(|length| length * ANGSTROMS))
                    .collect();
                if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                    let width = if header.is_double { 8 } else { 4 };
                    let (byte, atom) = (offset + width * index as u64, index / 3);
                    let (axis, found) = (['x', 'y', 'z'][index % 3], values[index]);
                    return Err(wrong_position(byte, frame, atom, axis, found));
                }
            }
            // Velocities are lengths per time, and forces are energies per length.
            8 => positions.columns.extend(columns("velocity", &values, ANGSTROMS)),
            _ => positions.columns.extend(columns("force", &values, 1.0 / ANGSTROMS)),
        }
    }
    Ok(positions)
}

/// Makes a column of each component of vectors.
pub(super) fn columns(name: &str, values: &[f64], factor: f64) -> impl Iterator<Item = Column> {
    let names = component_names(name, 3).into_iter().enumerate();
    names.map(move |(first, name)| {
        let values = values.iter().skip(first).step_by(3).map(|value| value * factor);
        Column { name, values: ColumnValues::Numbers(values.collect()) }
    })
}
