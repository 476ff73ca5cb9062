//! Reads compressed trajectories of GROMACS (`.xtc`).
//!
//! The crate molly reads them too, but trusts them: it panics on a damaged file and prints warnings.

use super::{ANGSTROMS, cell_of, find_frames};
use crate::load::error::LoadError;
use crate::load::format::{FrameIndex, Frames};
use crate::load::numbers::{Order, Reader, numbers, wrong_position, wrong_start};
use crate::load::source::Bytes;
use crate::load::topology::{Positions, Topology};

pub(crate) const FRAMES: Frames = Frames::Positions { find };

/// The usual number at the start of a frame.
const MAGIC: i32 = 1995;
/// The number at the start of a frame where the count of compressed bytes has 64 bits.
const LONG_MAGIC: i32 = 2023;
const HEADER_BYTES: u64 = 56;
/// Up to this number of atoms, positions are not compressed.
const FEW: usize = 9;

/// Whether the first bytes are those of an XTC file: its magic number, and the number of atoms twice.
pub(crate) fn starts(bytes: &[u8]) -> bool {
    let is_magic = |magic: i32| bytes.starts_with(&magic.to_be_bytes());
    (is_magic(MAGIC) || is_magic(LONG_MAGIC)) && bytes.get(4..8).is_some_and(|atoms| bytes.get(52..56) == Some(atoms))
}

fn find(source: &mut dyn Bytes, last: Option<usize>, topology: Option<Topology>) -> Result<FrameIndex, LoadError> {
    let topology = Topology::required(topology, "xtc")?;
    let next = |reader: &mut Reader<'_>, index| {
        let header = Header::read(reader, index)?;
        reader.check(header.bytes, format!("frame {index}"))?;
        Ok((reader.offset + header.bytes, true))
    };
    find_frames(source, last, topology, next, read)
}

struct Header {
    atoms: usize,
    cell: [f64; 9],
    /// The parameters of the compression; `None` if there are few positions, which are not compressed.
    packed: Option<Packing>,
    /// Number of bytes of the positions after the header, with padding.
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
        let wrong = |offset, message: String| LoadError::byte(offset, format!("frame {index}: {message}"));
        let atoms: i32 = reader.number(&what)?;
        let _step: i32 = reader.number(&what)?;
        let _time: f32 = reader.number(&what)?;
        let mut cell = [0.0; 9];
        for (value, number) in cell.iter_mut().zip(numbers::<f32>(&reader.bytes(36, what.as_str())?, Order::Big)) {
            *value = number.into();
        }
        let again: i32 = reader.number(&what)?;
        let Some(atoms) = usize::try_from(atoms).ok().filter(|atoms| *atoms > 0 && again == atoms.cast_signed() as i32)
        else {
            return Err(wrong(offset, format!("it declares {atoms} and then {again} atoms")));
        };
        if atoms <= FEW {
            return Ok(Self { atoms, cell, packed: None, bytes: 12 * atoms as u64 });
        }
        let packed = Packing::read(reader, &what).and_then(|packed| {
            packed.check().map_err(|message| wrong(start + HEADER_BYTES, message)).map(|()| packed)
        })?;
        let offset = reader.offset;
        let bytes: u64 = match magic {
            MAGIC => reader.number::<u32>(&what)?.into(),
            _ => reader.number(&what)?,
        };
        // Compressed positions take at least one bit for each atom. Memory depends on the number of atoms.
        if atoms as u64 / 8 > bytes {
            return Err(wrong(offset, format!("{bytes} bytes are too few for {atoms} atoms")));
        }
        Ok(Self { atoms, cell, packed: Some(packed), bytes: bytes.saturating_add(3) / 4 * 4 })
    }
}

fn read(reader: &mut Reader<'_>, frame: usize, topology: &Topology) -> Result<Positions, LoadError> {
    let start = reader.offset;
    let header = Header::read(reader, frame)?;
    topology.check(frame, header.atoms)?;
    let cell = cell_of(header.cell, start + 16, frame)?;
    let offset = reader.offset;
    let bytes = reader.bytes(header.bytes, "the positions")?;
    let centers: Vec<[f64; 3]> = match header.packed {
        None => {
            let values: Vec<f64> = numbers::<f32>(&bytes, Order::Big).map(f64::from).collect();
            values.as_chunks().0.to_vec()
        }
        Some(packed) => positions(&bytes, &packed, header.atoms).map_err(|error| {
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
    Ok(Positions { centers: centers.collect(), cell, ..Positions::default() })
}

/// The sizes of differences between positions: about 2^(n/3), so that three differences fit into n bits.
#[rustfmt::skip]
const SIZES: [u32; 73] = [
    0, 0, 0, 0, 0, 0, 0, 0, 0, 8, 10, 12, 16, 20, 25, 32, 40, 50, 64, 80, 101, 128, 161, 203, 256, 322, 406, 512, 645,
    812, 1024, 1290, 1625, 2048, 2580, 3250, 4096, 5060, 6501, 8192, 10321, 13003, 16384, 20642, 26007, 32768, 41285,
    52015, 65536, 82570, 104031, 131072, 165140, 208063, 262144, 330280, 416127, 524287, 660561, 832255, 1048576,
    1321122, 1664510, 2097152, 2642245, 3329021, 4194304, 5284491, 6658042, 8388607, 10568983, 13316085, 16777216,
];
/// Index of the first size that is not zero.
const FIRST_SIZE: usize = 9;
/// Above this range, the three numbers of a position are written separately.
const LARGEST_MIXED: u64 = 0xff_ffff;

/// The parameters of a frame's compressed positions.
#[derive(Clone, Copy, Debug)]
struct Packing {
    /// The whole number that 1 nm becomes.
    precision: f32,
    lowest: [i32; 3],
    highest: [i32; 3],
    /// Index in `SIZES` of the first size of differences.
    size: u32,
}

impl Packing {
    fn read(reader: &mut Reader<'_>, what: &str) -> Result<Self, LoadError> {
        let precision = reader.number(what)?;
        let (mut lowest, mut highest) = ([0; 3], [0; 3]);
        for value in lowest.iter_mut().chain(&mut highest) {
            *value = reader.number(what)?;
        }
        Ok(Self { precision, lowest, highest, size: reader.number(what)? })
    }

    fn check(&self) -> Result<(), String> {
        let Self { precision, lowest, highest, size } = *self;
        if !(precision.is_finite() && precision > 0.0) {
            return Err(format!("the precision is {precision}"));
        }
        if lowest.iter().zip(highest).any(|(low, high)| *low > high) {
            return Err(format!("positions go from {lowest:?} to {highest:?}"));
        }
        if !(FIRST_SIZE..SIZES.len()).contains(&(size as usize)) {
            return Err(format!("the size of differences has the index {size}, which does not exist"));
        }
        Ok(())
    }
}

/// An error in compressed positions.
#[derive(Debug)]
struct UnpackError {
    /// Index of the wrong byte, from the first byte of the positions.
    byte: u64,
    message: String,
}

/// Decompresses positions, in nm.
fn positions(bytes: &[u8], packed: &Packing, atoms: usize) -> Result<Vec<[f64; 3]>, UnpackError> {
    let Packing { lowest, highest, .. } = *packed;
    let mut bits = Bits { bytes, position: 0 };
    let ranges = [0, 1, 2].map(|axis| (i64::from(highest[axis]) - i64::from(lowest[axis])) as u64 + 1);
    let is_mixed = ranges.iter().all(|range| *range <= LARGEST_MIXED);
    let mixed_bits = bit_length(ranges.iter().map(|range| u128::from(*range)).product());
    let mut size = packed.size as usize;
    let half = |size: usize| i64::from(SIZES[size] / 2);
    let mut run = 0;
    let mut found: Vec<[f64; 3]> = Vec::new();
    // GROMACS divides in f32.
    let in_nm = |numbers: [i64; 3]| numbers.map(|number| f64::from(number as f32 * (1.0 / packed.precision)));
    while found.len() < atoms {
        let mut numbers = if is_mixed {
            bits.mixed(mixed_bits, ranges)?
        } else {
            let mut numbers = [0; 3];
            for (number, range) in numbers.iter_mut().zip(ranges) {
                *number = bits.take(bit_length(range.into()))? as i64;
            }
            numbers
        };
        for (number, low) in numbers.iter_mut().zip(lowest) {
            *number += i64::from(low);
        }
        let mut change = 0;
        if bits.take(1)? == 1 {
            let of_run = bits.take(5)? as usize;
            change = of_run % 3;
            run = of_run / 3;
            change = change.wrapping_sub(1);
        }
        if found.len() + 1 + run > atoms {
            return Err(bits.wrong(format!("there are more than {atoms} atoms")));
        }
        let first = numbers;
        for index in 0..run {
            let differences = bits.mixed(size as u32, [u64::from(SIZES[size]); 3])?;
            for (number, difference) in numbers.iter_mut().zip(differences) {
                *number += difference - half(size);
            }
            found.push(in_nm(numbers));
            if index == 0 {
                found.push(in_nm(first));
            }
        }
        if run == 0 {
            found.push(in_nm(first));
        }
        size = size.wrapping_add(change);
        if !(FIRST_SIZE..SIZES.len()).contains(&size) {
            return Err(bits.wrong(format!("the size of differences has the index {size}, which does not exist")));
        }
    }
    Ok(found)
}

fn bit_length(number: u128) -> u32 {
    u128::BITS - number.leading_zeros()
}

/// Bits of a range of bytes, the highest bit of each byte first.
struct Bits<'a> {
    bytes: &'a [u8],
    /// Index of the next bit.
    position: usize,
}

impl Bits<'_> {
    fn wrong(&self, message: impl Into<String>) -> UnpackError {
        UnpackError { byte: (self.position / 8) as u64, message: message.into() }
    }

    /// Takes up to 32 bits.
    fn take(&mut self, count: u32) -> Result<u64, UnpackError> {
        let end = self.position + count as usize;
        let (first, last) = (self.position / 8, end.div_ceil(8));
        let Some(bytes) = self.bytes.get(first..last) else {
            return Err(self.wrong("the compressed positions end too early"));
        };
        let all = bytes.iter().fold(0_u64, |all, byte| all << 8 | u64::from(*byte));
        self.position = end;
        Ok(all >> (8 * last - end) & ((1 << count) - 1))
    }

    /// Takes three numbers that are written as one number of `count` bits, the lowest byte first.
    fn mixed(&mut self, count: u32, ranges: [u64; 3]) -> Result<[i64; 3], UnpackError> {
        let mut all = 0_u128;
        for byte in 0..count / 8 {
            all |= u128::from(self.take(8)?) << (8 * byte);
        }
        all |= u128::from(self.take(count % 8)?) << (count / 8 * 8);
        let [x, y, z] = match u64::try_from(all) {
            Ok(all) => [all / ranges[2] / ranges[1], all / ranges[2] % ranges[1], all % ranges[2]],
            Err(_) => {
                let [_, y, z] = ranges.map(u128::from);
                [all / z / y, all / z % y, all % z].map(|number| number as u64)
            }
        };
        if x >= ranges[0] {
            return Err(self.wrong("the compressed positions are damaged"));
        }
        Ok([x, y, z].map(|number| number as i64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_numbers_as_one() {
        let ranges = [16_000_000_u64, 15_999_999, 7];
        for numbers in [[0, 0, 0], [15_999_999, 15_999_998, 6], [1, 0, 5], [12_345_678, 7_654_321, 3]] {
            for (scale, count) in [(1, 51), (2_000_000, 72)] {
                let ranges = [ranges[0], ranges[1], ranges[2] * scale];
                let number = numbers
                    .iter()
                    .zip(ranges)
                    .fold(0, |all: u128, (number, range)| all * u128::from(range) + *number as u128);
                assert_eq!(bit_length(ranges.iter().map(|range| u128::from(*range)).product()), count);
                // After three other bits: the lowest byte first, and the rest in as many bits as it has.
                let mut bits = vec![1, 0, 1];
                for byte in 0..count.div_ceil(8) {
                    let width = (count - 8 * byte).min(8);
                    bits.extend((0..width).rev().map(|bit| (number >> (8 * byte + bit) & 1) as u8));
                }
                bits.resize(bits.len().next_multiple_of(8), 0);
                let bytes = bits.chunks(8).map(|bits| bits.iter().fold(0, |all, bit| all << 1 | bit));
                let bytes: Vec<u8> = bytes.collect();
                let mut reader = Bits { bytes: &bytes, position: 0 };
                assert_eq!(reader.take(3).unwrap(), 5);
                assert_eq!(reader.mixed(count, ranges).unwrap(), numbers);
                assert!(reader.take(9).is_err());
            }
        }
    }
}
