//! Rows of numbers out of bytes.

use std::collections::TryReserveError;

use crate::parallel;

/// How the numbers of a table lie one behind the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// How many spheres.
    pub(super) rows: usize,
    /// 3: x, y, z; or 4: and the radius.
    pub(super) columns: usize,
    /// Whether all x come first, then all y, as Fortran has it.
    pub(super) by_column: bool,
}

/// The rows, with `radius` in the fourth place where there are but three columns. What the layout wants
/// and `bytes` lack is an empty list; readers refuse such files with words of their own.
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
    // One loop for each layout, so that the compiler can make it a copy.
    match (columns, by_column) {
        (4, false) => parallel::try_map(rows, |row| {
            let place = row * 4;
            [0, 1, 2, 3].map(|column| decode(numbers[place + column]))
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
