//! Reads files of the molecular dynamics program LAMMPS: dumps of atoms, and data files.
//!
//! The formats are those of its manual, on the pages of the commands `dump`, `dump_modify` and `read_data`. Lengths are
//! taken as they are, in the simulation's unit.

mod cell;
pub(super) mod dump;
mod error;
mod order;
#[cfg(test)]
mod tests;

pub use cell::Shape;
pub use error::LammpsError;
