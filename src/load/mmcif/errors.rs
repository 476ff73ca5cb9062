//! What is wrong with a row of atoms or with a value of an mmCIF file.

use super::tokens::Place;
use crate::load::error::LoadError;
use crate::text::shortened;

/// The last row of the loop has too few values.
pub(super) fn cut_row(place: Place, values: usize, columns: usize) -> LoadError {
    let message = format!(
        "the row of _atom_site that begins here has {values} values, but the loop names {columns} columns; a value is \
         missing in this row or in one before it, or the file is cut off"
    );
    LoadError::line(place.lines_before + 1, message)
}

pub(super) fn not_a_number(text: &[u8], place: Place, what: &str) -> LoadError {
    let found = shortened(&String::from_utf8_lossy(text));
    LoadError::at(place.of_error(), format!("{what} is `{found}`, which is not a finite number"))
}
