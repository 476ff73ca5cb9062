//! Small good files of every format that can be read, from which the fuzzer makes bad ones.
//!
//! A new format gets files in `tests/files/good`, with a row each in [`FILES`]; a test fails until it has. Those of DCD, TRR
//! and XTC need a topology, and are written by `binary_files`.

use std::path::Path;

use pinhole::load::{Format, Options};

use crate::binary_files::{dcd as charmm, gromacs, topology};

/// A good file.
pub(crate) struct Seed {
    pub(crate) bytes: Vec<u8>,
    /// What reading it needs beside the format.
    pub(crate) options: Options,
}

/// A format, a good file, and the names of its columns where they must be given, or `radius` where that must be.
type File = (&'static str, &'static [u8], &'static str);

const FILES: &[File] = &[
    ("xyz", include_bytes!("../files/good/water.xyz"), ""),
    ("xyz", include_bytes!("../files/good/water.xyz.gz"), ""),
    ("extxyz", include_bytes!("../files/good/columns.extxyz"), ""),
    ("extxyz", include_bytes!("../files/good/numbers.extxyz"), ""),
    ("pdb", include_bytes!("../files/good/models.pdb"), ""),
    ("pdb", include_bytes!("../files/good/one.pdb"), ""),
    ("lammps-dump", include_bytes!("../files/good/plain.dump"), ""),
    ("lammps-dump", include_bytes!("../files/good/tilted.dump"), ""),
    ("lammps-dump", include_bytes!("../files/good/general.dump"), "id type xsu ysu zsu"),
    ("lammps-data", include_bytes!("../files/good/full.data"), ""),
    ("lammps-data", include_bytes!("../files/good/sphere.data"), ""),
    ("lammps-data", include_bytes!("../files/good/bare.data"), "id type q x y z"),
    ("mmcif", include_bytes!("../files/good/models.cif"), ""),
    ("mmcif", include_bytes!("../files/good/small.cif"), ""),
    ("las", include_bytes!("../files/good/old.las"), ""),
    ("las", include_bytes!("../files/good/new.las"), ""),
    ("gsd", include_bytes!("../files/good/version1.gsd"), ""),
    ("gsd", include_bytes!("../files/good/version2.gsd"), ""),
    ("npy", include_bytes!("../files/good/spheres.npy"), ""),
    ("npy", include_bytes!("../files/good/columns.npy"), "radius"),
    ("npy", include_bytes!("../files/good/structured.npy"), ""),
    ("npz", include_bytes!("../files/good/stored.npz"), ""),
    ("npz", include_bytes!("../files/good/deflated.npz"), ""),
    ("npz", include_bytes!("../files/good/centers.npz"), "radius"),
    ("npz", include_bytes!("../files/good/structured.npz"), ""),
    ("csv", include_bytes!("../files/good/table.csv"), ""),
    ("csv", include_bytes!("../files/good/semicolons.csv"), ""),
    ("csv", include_bytes!("../files/good/bare.csv"), "x y z"),
    ("ply", include_bytes!("../files/good/text.ply"), ""),
    ("ply", include_bytes!("../files/good/little.ply"), ""),
    ("ply", include_bytes!("../files/good/big.ply"), ""),
    ("raw-f32x4", include_bytes!("../files/good/spheres.bin"), ""),
    ("vtk", include_bytes!("../files/good/ascii.vtp"), ""),
    ("vtk", include_bytes!("../files/good/inline.vtp"), ""),
    ("vtk", include_bytes!("../files/good/compressed.vtp"), ""),
    ("vtk", include_bytes!("../files/good/appended.vtp"), ""),
];

/// The good files of a format; none if it is unknown here. What they need, such as a topology, is written into the folder.
pub(crate) fn of(format: &Format, folder: &Path) -> Vec<Seed> {
    let mut seeds = match format.name {
        "dcd" => dcd(folder),
        "trr" => trr(folder),
        "xtc" => xtc(folder),
        _ => Vec::new(),
    };
    for (_, bytes, need) in FILES.iter().filter(|(name, ..)| *name == format.name) {
        let mut options = Options::default();
        match *need {
            "radius" => options.radius = Some(1.0),
            columns => options.columns = columns.split_terminator(' ').map(str::to_owned).collect(),
        }
        seeds.push(Seed { bytes: bytes.to_vec(), options: options.clone() });
        if let (Ok(text), "xyz" | "mmcif") = (str::from_utf8(bytes), format.name) {
            let bytes = text.replace('\n', "\r\n").into_bytes();
            seeds.push(Seed { bytes, options });
        }
    }
    seeds
}

fn dcd(folder: &Path) -> Vec<Seed> {
    let other = charmm::Layout {
        order: charmm::Order::Big,
        marker_bytes: 8,
        cell: Some([10.0, 0.5, 20.0, 0.0, 0.0, 30.0]),
        has_fourth: true,
        has_fixed: true,
    };
    let seed = |layout| with_topology(charmm::file(layout), folder, charmm::ATOMS);
    [charmm::PLAIN, other].map(seed).into()
}

fn trr(folder: &Path) -> Vec<Seed> {
    [false, true]
        .map(|is_double| with_topology(gromacs::trr(is_double), folder, gromacs::ATOMS))
        .into()
}

fn xtc(folder: &Path) -> Vec<Seed> {
    let (old, new) = (molly::Magic::Xtc1995, molly::Magic::Xtc2023);
    // Of fewer than ten atoms the positions are not compressed.
    [(5, old), (12, old), (60, new)]
        .map(|(atoms, magic)| with_topology(gromacs::xtc(2, atoms, magic), folder, atoms))
        .into()
}

fn with_topology(bytes: Vec<u8>, folder: &Path, atoms: usize) -> Seed {
    Seed { bytes, options: Options::default().with_topology(topology(folder, atoms)) }
}
