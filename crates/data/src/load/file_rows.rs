//! Reads the rows of a plain array straight from its file, on all cores, so that the file itself is never in memory.

use std::fs::File;
use std::io;

use super::compressed::Compression;
use super::dataset::Dataset;
use super::error::LoadError;
use super::format::{Format, Numbers, Options, Rows};
use super::table::Table;
use pinhole::internals::parallel;
use pinhole::scene::sphere_array::SphereArray;

/// Number of first bytes of a file in which a header ends.
const HEAD: u64 = 1 << 14;

/// Number of rows that are read at a time.
const PIECE: usize = 1 << 15;

/// A plain array of spheres in an open file.
#[derive(Debug)]
pub struct FileRows<'a> {
    file: &'a File,
    rows: Rows,
    options: &'a Options,
}

impl<'a> FileRows<'a> {
    /// Finds the array of a file. `None` means that [`Format::read`] must read it, because it has something else, which
    /// includes all that is wrong.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, or an option does not apply to the format.
    pub fn find(format: &Format, file: &'a File, options: &'a Options) -> Result<Option<Self>, LoadError> {
        format.check(options)?;
        let size = file.metadata()?.len();
        let mut head = vec![0; size.min(HEAD) as usize];
        if !read_at(file, &mut head, 0)? || Compression::of(&head).is_some() {
            return Ok(None);
        }
        let rows = (format.rows)(&head, size, options);
        Ok(rows.map(|rows| Self { file, rows, options }))
    }

    /// Returns the bytes of memory that reading takes.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        4 * self.rows.numbers.width() * self.rows.count as u64
    }

    /// Reads the array.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or has become shorter, or if there is not enough memory.
    pub fn read(&self) -> Result<Dataset, LoadError> {
        let spheres = match self.rows.numbers {
            Numbers::F32 => SphereArray::F32(self.spheres(f32::from_le_bytes, 0.0)?),
            Numbers::F64 => SphereArray::F64(self.spheres(f64::from_le_bytes, 0.0)?),
        };
        Table::default().dress(spheres, self.rows.columns == 4, self.options)
    }

    fn spheres<T: Copy + Send + Sync, const WIDTH: usize>(
        &self,
        decode: impl Fn([u8; WIDTH]) -> T + Sync,
        zero: T,
    ) -> Result<Vec<[T; 4]>, LoadError> {
        let Rows { first, count, columns, .. } = self.rows;
        let memory = |_| LoadError::new(format!("there is not enough memory for {count} spheres"));
        let mut spheres = parallel::try_map(count, |_| [zero; 4]).map_err(memory)?;
        let pieces = spheres.chunks_mut(PIECE).enumerate().collect();
        let read = parallel::map_parts(pieces, |(piece, spheres): (usize, &mut [[T; 4]])| -> io::Result<()> {
            let mut bytes = vec![0; spheres.len() * columns * WIDTH];
            read_at(self.file, &mut bytes, first + (piece * PIECE * columns * WIDTH) as u64)?;
            let (numbers, _) = bytes.as_chunks::<WIDTH>();
            for (sphere, row) in spheres.iter_mut().zip(numbers.chunks_exact(columns)) {
                sphere.iter_mut().zip(row).for_each(|(number, bytes)| *number = decode(*bytes));
            }
            Ok(())
        });
        read.into_iter().collect::<io::Result<()>>()?;
        Ok(spheres)
    }
}

/// Fills `bytes` with those from a place of a file, which any thread may do; false where the system cannot.
#[cfg(unix)]
fn read_at(file: &File, bytes: &mut [u8], place: u64) -> io::Result<bool> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, place)?;
    Ok(true)
}

#[cfg(not(unix))]
fn read_at(_: &File, _: &mut [u8], _: u64) -> io::Result<bool> {
    Ok(false)
}

#[cfg(all(test, unix))]
mod tests {
    use std::io::Write as _;

    use super::*;

    #[test]
    fn arrays_are_read_in_pieces_as_they_are_as_a_whole() {
        let spheres: Vec<[f32; 4]> = (0..PIECE + 77).map(|i| [i as f32, -0.5 * i as f32, 3.0, 0.25]).collect();
        let wide: Vec<f64> = spheres.iter().flatten().map(|number| f64::from(*number) / 3.0).collect();
        let raw: Vec<u8> = spheres.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
        let array = |descr: &str, shape: &str, data: Vec<u8>| {
            let mut text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
            text = format!("{text:<117}\n");
            [b"\x93NUMPY\x01\x00\x76\x00".as_slice(), text.as_bytes(), &data].concat()
        };
        let count = spheres.len();
        let of_wide = |count| wide[..count].iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
        let cases = [
            ("raw-f32x4", raw.clone(), true),
            ("raw-f32x4", raw[1..].to_vec(), false),
            ("npy", array("<f4", &format!("({count}, 4)"), raw.clone()), true),
            ("npy", array("<f8", &format!("({count}, 4)"), of_wide(4 * count)), true),
            ("npy", array("<f8", &format!("({count}, 3)"), of_wide(3 * count)), true),
            ("npy", array(">f4", &format!("({count}, 4)"), raw.clone()), false),
            ("npy", array("<f4", &format!("({count}, 4)"), raw[4..].to_vec()), false),
            ("npy", array("<f4", &format!("({}, 4)", u64::MAX), raw), false),
        ];
        for (name, bytes, is_plain) in cases {
            let mut file = tempfile::tempfile().unwrap();
            file.write_all(&bytes).unwrap();
            let (format, options) = (Format::of_name(name).unwrap(), Options::default());
            let found = FileRows::find(format, &file, &options).unwrap();
            assert_eq!(found.is_some(), is_plain, "{name}");
            if let Some(found) = found {
                assert_eq!(found.read().unwrap(), format.read(&bytes, &options).unwrap());
                file.set_len(bytes.len() as u64 - 5).unwrap();
                assert!(found.read().is_err());
            }
        }
    }
}
