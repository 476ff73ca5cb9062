//! Small good files of every format that can be read, from which the fuzzer makes bad ones.
//!
//! A new format gets one function here and one row in [`SEEDS`]; a test fails until it has.

mod arrays;
mod lammps;
mod points;
mod text;
mod trajectories;

use std::path::Path;

use pinhole::load::{Format, Options};

/// A good file.
pub(crate) struct Seed {
    pub(crate) bytes: Vec<u8>,
    /// What reading it needs beside the format.
    pub(crate) options: Options,
}

impl Seed {
    pub(crate) fn new(bytes: impl Into<Vec<u8>>) -> Self {
        Self { bytes: bytes.into(), options: Options::default() }
    }

    pub(crate) fn with_options(bytes: impl Into<Vec<u8>>, options: Options) -> Self {
        Self { bytes: bytes.into(), options }
    }
}

/// Makes the good files of a format. It may write files that they need, such as a topology, into the folder.
type Maker = fn(&Path) -> Vec<Seed>;

/// The good files of each format, by its name.
const SEEDS: &[(&str, Maker)] = &[
    ("xyz", |_| text::xyz()),
    ("extxyz", |_| text::extxyz()),
    ("pdb", |_| text::pdb()),
    ("lammps-dump", |_| lammps::dump()),
    ("lammps-data", |_| lammps::data()),
    ("mmcif", |_| text::mmcif()),
    ("las", |_| points::las()),
    ("gsd", |_| trajectories::gsd()),
    ("dcd", trajectories::dcd),
    ("trr", trajectories::trr),
    ("xtc", trajectories::xtc),
    ("npy", |_| arrays::npy()),
    ("npz", |_| arrays::npz()),
    ("csv", |_| text::csv()),
    ("ply", |_| points::ply()),
    ("raw-f32x4", |_| arrays::raw()),
    ("vtk", |_| points::vtk()),
];

/// The good files of a format; none if it has no row in [`SEEDS`].
pub(crate) fn of(format: &Format, folder: &Path) -> Vec<Seed> {
    let maker = SEEDS.iter().find(|(name, _)| *name == format.name);
    maker.map(|(_, maker)| maker(folder)).unwrap_or_default()
}
