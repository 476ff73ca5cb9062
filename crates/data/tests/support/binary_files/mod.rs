//! Writes binary files in memory, for tests of their readers and for the fuzzer.

pub(crate) mod dcd;
pub(crate) mod gromacs;
pub(crate) mod gsd;

use std::path::{Path, PathBuf};

/// Writes a topology with this number of oxygen atoms into a folder.
pub(crate) fn topology(folder: &Path, atoms: usize) -> PathBuf {
    let path = folder.join(format!("{atoms}.xyz"));
    std::fs::write(&path, format!("{atoms}\n\n{}", "O 0 0 0\n".repeat(atoms))).unwrap();
    path
}
