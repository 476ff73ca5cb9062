//! Reads LAS files, clouds of points of laser scanners (LAS 1.0 to 1.4, point formats 0 to 10).
//!
//! The reader uses position, intensity, number and count of returns, class, time and colour of a point. LAZ, which is
//! compressed LAS, is refused with advice: with the crates las 0.11 and laz 0.13, a damaged file of a few kilobytes
//! asks for 50 GB of memory, which ends the program.

use crate::load::dataset::Dataset;
use crate::load::error::{LoadError, LoadErrorKind};
use crate::load::format::Options;
use crate::load::table::{Table, TableColumn};
use pinhole::internals::parallel;

/// Bytes of a point of each format, by the specification of LAS 1.4 (R15, tables 7 to 17).
const LENGTHS: [usize; 11] = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67];

/// The largest value of an eight-bit colour, which many programs write into the sixteen bits of LAS.
const EIGHT_BITS: f64 = 255.0;

pub(super) fn starts(bytes: &[u8]) -> bool {
    bytes.starts_with(b"LASF")
}

pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Dataset, LoadError> {
    let points = Points::new(bytes)?;
    let mut notes = Vec::new();
    let columns = points.columns(&mut notes)?;
    let mut loaded = Table { columns }.into_loaded(options)?;
    loaded.notes.extend(notes);
    Ok(loaded)
}

/// The points of a file, with their layout from its header.
struct Points<'a> {
    bytes: &'a [u8],
    count: usize,
    length: usize,
    format: u8,
    scale: [f64; 3],
    offset: [f64; 3],
}

impl<'a> Points<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self, LoadError> {
        if !starts(bytes) {
            return Err(LoadError::new("this is not a LAS file: it does not start with LASF"));
        }
        if bytes.len() < 227 {
            let message =
                format!("the header is cut off: the file has {} bytes, but a header has 227 or more", bytes.len());
            return Err(LoadError::new(message).of_kind(LoadErrorKind::CutOff));
        }
        let byte = |at: usize| bytes.get(at).copied().unwrap_or_default();
        let format = byte(104);
        // Compressors set the highest bits.
        if format & 0xc0 != 0 {
            return Err(LoadError::new(
                "the points are compressed (LAZ), which is not read; decompress the file, such as with `laszip -i a.laz -o \
                 a.las` or `pdal translate a.laz a.las`",
            ));
        }
        let least = LENGTHS.get(usize::from(format)).copied();
        let least = least.ok_or_else(|| {
            LoadError::byte(104, format!("the point format is {format}, but those of LAS are 0 to 10"))
        })?;
        let length = usize::from(u16::from_le_bytes(chunk(bytes, 105)));
        if length < least {
            let message = format!("a point has {length} bytes, but point format {format} takes {least}");
            return Err(LoadError::byte(105, message));
        }
        let start = u64::from(u32::from_le_bytes(chunk(bytes, 96)));
        let header = u16::from_le_bytes(chunk(bytes, 94));
        let legacy = u64::from(u32::from_le_bytes(chunk(bytes, 107)));
        // LAS 1.4 has 64 bits for the number of points.
        let is_long = byte(25) >= 4 && header >= 255;
        let wanted = if is_long { u64::from_le_bytes(chunk(bytes, 247)) } else { legacy };
        let data = usize::try_from(start).ok().and_then(|start| bytes.get(start..));
        let data = data.unwrap_or_default();
        if wanted > (data.len() / length) as u64 {
            let message = format!(
                "the header declares {wanted} points of {length} bytes, but only {} bytes follow; the file is cut off",
                data.len()
            );
            return Err(LoadError::byte(start, message).of_kind(LoadErrorKind::CutOff));
        }
        let three = |at: usize| [0, 8, 16].map(|axis| f64::from_le_bytes(chunk(bytes, at + axis)));
        let (scale, offset) = (three(131), three(155));
        Ok(Self { bytes: data, count: wanted as usize, length, format, scale, offset })
    }

    fn columns(&self, notes: &mut Vec<String>) -> Result<Vec<TableColumn>, LoadError> {
        let is_new = self.format >= 6;
        let mut columns = Vec::new();
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let (scale, offset) = (self.scale[axis], self.offset[axis]);
            let number = |point: &[u8]| f64::from(i32::from_le_bytes(chunk(point, 4 * axis))) * scale + offset;
            columns.push(self.column(name, number)?);
        }
        let short = |at: usize| move |point: &[u8]| f64::from(u16::from_le_bytes(chunk(point, at)));
        let bits = |at: usize, low: u32, count: u32| {
            move |point: &[u8]| {
                let byte = point.get(at).copied().unwrap_or_default();
                f64::from((byte >> low) & ((1_u16 << count) - 1) as u8)
            }
        };
        let returns = if is_new { 4 } else { 3 };
        columns.push(self.column("intensity", short(12))?);
        columns.push(self.column("return_number", bits(14, 0, returns))?);
        columns.push(self.column("number_of_returns", bits(14, returns, returns))?);
        let class = if is_new { bits(16, 0, 8) } else { bits(15, 0, 5) };
        columns.push(self.column("classification", class)?);
        let time = match self.format {
            1 | 3 | 4 | 5 => Some(20),
            6.. => Some(22),
            _ => None,
        };
        if let Some(at) = time {
            let number = move |point: &[u8]| f64::from_le_bytes(chunk(point, at));
            columns.push(self.column("gps_time", number)?);
        }
        let color = match self.format {
            2 => Some(20),
            3 | 5 => Some(28),
            7 | 8 | 10 => Some(30),
            _ => None,
        };
        if let Some(at) = color {
            let mut colors = Vec::new();
            for (index, name) in ["red", "green", "blue"].into_iter().enumerate() {
                colors.push(self.column(name, short(at + 2 * index))?);
            }
            columns.extend(with_range(colors, notes));
        }
        let mut unused = vec!["flags", "scan angle", "user data", "point source"];
        if matches!(self.format, 8 | 10) {
            unused.push("near infrared");
        }
        if matches!(self.format, 4 | 5 | 9 | 10) {
            unused.push("waveforms");
        }
        if self.length > LENGTHS[usize::from(self.format)] {
            unused.push("extra bytes");
        }
        notes.push(format!("not used: {} of the points", unused.join(", ")));
        Ok(columns)
    }

    fn column(&self, name: &str, number: impl Fn(&[u8]) -> f64 + Sync + Send) -> Result<TableColumn, LoadError> {
        let of_row = |row: usize| number(&self.bytes[row * self.length..]);
        let numbers = parallel::try_map(self.count, of_row);
        let numbers =
            numbers.map_err(|_| LoadError::new(format!("there is not enough memory for {} points", self.count)))?;
        Ok(TableColumn::numbers(name, numbers))
    }
}

/// Sets the range of colours. Returns none if all are black, which means that there were no photographs.
fn with_range(mut colors: Vec<TableColumn>, notes: &mut Vec<String>) -> Vec<TableColumn> {
    let largest = colors.iter().map(TableColumn::largest).fold(0.0, f64::max);
    if largest == 0.0 {
        notes.push("the colors are not used: all of them are black".to_owned());
        return Vec::new();
    }
    let full = if largest <= EIGHT_BITS { EIGHT_BITS } else { f64::from(u16::MAX) };
    colors.iter_mut().for_each(|column| column.full = Some(full));
    colors
}

/// Returns the bytes at this offset; zeros if there are too few, which readers check before.
fn chunk<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    bytes.get(at..).and_then(<[u8]>::first_chunk).copied().unwrap_or([0; N])
}
