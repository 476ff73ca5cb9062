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
mod error;
mod order;
mod styles;
#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the answers are exact")]
mod tests;

pub use cell::Shape;
pub use error::LammpsError;
