//! Arrays of spheres that are read piece by piece: `.npy` files of rows of three or four little-endian f32 or f64, and raw
//! f32. Other files, and all that are not as they should be, are left to the readers of the library, which say what is
//! wrong.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use pinhole::load::Format;

/// Where the numbers of an array are in its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Array {
    pub(super) count: u64,
    /// The first byte.
    offset: u64,
    /// 3 without radii, and 4.
    columns: usize,
    is_wide: bool,
    /// The radius of all spheres, where the array has none.
    radius: f64,
}

/// The first bytes of an `.npy` file.
const MAGIC: &[u8] = b"\x93NUMPY";

impl Array {
    /// The array in a file; `None` if it must be read otherwise.
    pub(super) fn of(path: &Path, format: &Format, radius: Option<f64>) -> Option<Self> {
        if !path.is_file() {
            return None;
        }
        let mut file = File::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        let array = match format.name {
            "raw-f32x4" => {
                Self { count: length / 16, offset: 0, columns: 4, is_wide: false, radius: 0.0 }
            }
            "npy" => Self::of_npy(&mut file, radius)?,
            _ => return None,
        };
        let bytes = array.count.checked_mul(array.row() as u64)?.checked_add(array.offset)?;
        let has_radius = array.columns == 4;
        (bytes == length && array.count > 0 && has_radius == radius.is_none()).then_some(array)
    }

    fn of_npy(file: &mut File, radius: Option<f64>) -> Option<Self> {
        let mut start = [0; 12];
        file.read_exact(&mut start).ok()?;
        let (length, before) = match (start.starts_with(MAGIC), start[6]) {
            (true, 1) => (u64::from(u16::from_le_bytes([start[8], start[9]])), 10),
            (true, 2 | 3) => {
                let length = [start[8], start[9], start[10], start[11]];
                (u64::from(u32::from_le_bytes(length)), 12)
            }
            _ => return None,
        };
        file.seek(SeekFrom::Start(before)).ok()?;
        let mut text = String::new();
        (length < 4096).then(|| file.take(length).read_to_string(&mut text))?.ok()?;
        let text: String = text.split_whitespace().collect();
        let is_wide = match text.split_once("'descr':'")?.1.get(..3)? {
            "<f4" => false,
            "<f8" => true,
            _ => return None,
        };
        text.contains("'fortran_order':False").then_some(())?;
        let shape = text.split_once("'shape':(")?.1.split_once(')')?.0;
        let (count, columns) = shape.split_once(',')?;
        let (count, columns) = (count.parse().ok()?, columns.trim_end_matches(',').parse().ok()?);
        let radius = radius.unwrap_or(0.0);
        (3..=4).contains(&columns).then_some(Self {
            count,
            offset: before + length,
            columns,
            is_wide,
            radius,
        })
    }

    /// Bytes of a row.
    pub(super) fn row(&self) -> usize {
        self.columns * if self.is_wide { 8 } else { 4 }
    }

    /// Puts the file to the first row.
    pub(super) fn begin(&self, file: &mut File) -> std::io::Result<()> {
        file.seek(SeekFrom::Start(self.offset)).map(drop)
    }

    /// The sphere of a row, as the readers of the library make it.
    pub(super) fn sphere(&self, row: &[u8]) -> [f64; 4] {
        let mut sphere = [0.0, 0.0, 0.0, self.radius];
        if self.is_wide {
            let numbers = row.as_chunks::<8>().0.iter().map(|number| f64::from_le_bytes(*number));
            sphere.iter_mut().zip(numbers).for_each(|(to, number)| *to = number);
        } else {
            let numbers = row.as_chunks::<4>().0.iter().map(|number| f32::from_le_bytes(*number));
            sphere.iter_mut().zip(numbers).for_each(|(to, number)| *to = number.into());
            // An array of f32 has its radius in f32 as well.
            if self.columns == 3 {
                sphere[3] = f64::from(self.radius as f32);
            }
        }
        sphere
    }
}
