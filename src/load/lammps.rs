//! Reads files of the molecular dynamics program LAMMPS: dumps of atoms, and data files.
//!
//! The formats are those of its manual, on the pages of the commands `dump`, `dump_modify` and `read_data`. Lengths are
//! taken as they are, in the simulation's unit.

mod cell;
pub(super) mod data;
#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the answers are exact")]
mod data_tests;
pub(super) mod dump;
mod elements;
mod order;
mod styles;
#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the answers are exact")]
mod tests;

use super::error::LoadError;
use crate::text::shortened;

/// Text of the file that stands in the wrong place or cannot be read, with what is wrong about it.
fn wrong_text(line: usize, text: &[u8], what: &str) -> LoadError {
    let text = shortened(&String::from_utf8_lossy(text.trim_ascii()));
    LoadError::line(line, format!("`{text}` {what}"))
}

fn too_few_atoms(line: usize, declared: usize, found: usize) -> LoadError {
    let message = format!("{declared} atoms are declared, but the file ends after {found}");
    LoadError::line(line, message)
}
