//! Reads spheres from raw numbers without a header: x, y, z and radius of each sphere in little-endian f32.

use std::collections::TryReserveError;

use crate::load::error::LoadError;
use crate::load::format::{Numbers, Rows};
use pinhole::internals::parallel;
use pinhole::scene::sphere_array::SphereArray;

/// Bytes per sphere.
const SPHERE_BYTES: usize = 16;

/// Reads spheres of 16 bytes each: x, y, z and radius in little-endian f32.
///
/// # Errors
/// Returns an error if the number of bytes is not a multiple of 16, or there is not enough memory.
pub fn read_spheres(bytes: &[u8]) -> Result<SphereArray, LoadError> {
    if !bytes.len().is_multiple_of(SPHERE_BYTES) {
        let (bytes, whole, left) = (bytes.len(), bytes.len() / SPHERE_BYTES, bytes.len() % SPHERE_BYTES);
        return Err(LoadError::new(format!(
            "the file has {bytes} bytes, which are {whole} × {SPHERE_BYTES} + {left}, but each sphere takes {SPHERE_BYTES} \
             bytes (x, y, z, radius in little-endian f32); the file is cut off or has another format"
        )));
    }
    let count = bytes.len() / SPHERE_BYTES;
    let layout = Layout { rows: count, columns: 4, by_column: false };
    let spheres = rows(bytes, layout, f32::from_le_bytes, 0.0);
    let memory = |_| LoadError::new(format!("there is not enough memory for {count} spheres"));
    spheres.map(SphereArray::F32).map_err(memory)
}

/// The rows of a file of `size` bytes, if they are whole.
pub(super) fn rows_of(size: u64) -> Option<Rows> {
    let count = usize::try_from(size / SPHERE_BYTES as u64).ok()?;
    let rows = Rows { first: 0, count, columns: 4, numbers: Numbers::F32 };
    (rows.bytes() == Some(size)).then_some(rows)
}

/// The order in which the numbers of a table are stored.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Number of rows, one for each sphere.
    pub(super) rows: usize,
    /// Number of columns: 3 for x, y, z, or 4 for x, y, z, radius.
    pub(super) columns: usize,
    /// Whether the table is stored column by column (Fortran order): all x first, then all y.
    pub(super) by_column: bool,
}

/// Decodes the rows; `radius` is the fourth number of each if there are only three columns. The result is
/// empty if there are fewer `bytes` than the layout needs, which readers check themselves and report.
pub(super) fn rows<T: Copy + Send + Sync, const WIDTH: usize>(
    bytes: &[u8],
    layout: Layout,
    decode: impl Fn([u8; WIDTH]) -> T + Sync + Send,
    radius: T,
) -> Result<Vec<[T; 4]>, TryReserveError> {
    let (numbers, _) = bytes.as_chunks::<WIDTH>();
    let Layout { rows, columns, by_column } = layout;
    if rows.checked_mul(columns).is_none_or(|wanted| numbers.len() < wanted) {
        return Ok(Vec::new());
    }
    // There is one loop for each layout, so that the compiler can turn it into a copy.
    match (columns, by_column) {
        (4, false) => parallel::try_map(rows, |row| {
            let start = row * 4;
            [0, 1, 2, 3].map(|column| decode(numbers[start + column]))
        }),
        _ => parallel::try_map(rows, |row| {
            [0, 1, 2, 3].map(|column| match (column < columns, by_column) {
                (false, _) => radius,
                (true, false) => decode(numbers[row * columns + column]),
                (true, true) => decode(numbers[column * rows + row]),
            })
        }),
    }
}
