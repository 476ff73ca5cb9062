//! Small good files of every format that can be read, which the fuzzer damages.
//!
//! A new format needs files in `crates/data/tests/files/good`, or a test fails. Files of DCD, TRR and XTC need a topology, and are
//! written by `binary_files`.

use std::path::Path;

use pinhole_data::load::{Format, Options};

use crate::binary_files::{dcd as charmm, gromacs, topology};

/// A valid file, and the options for reading it.
pub(crate) type Seed = (Vec<u8>, Options);

/// Files that need the names of their columns, or `radius`.
const NEEDS: [(&str, &str); 5] = [
    ("general.dump", "id type xsu ysu zsu"),
    ("bare.data", "id type q x y z"),
    ("columns.npy", "radius"),
    ("centers.npz", "radius"),
    ("bare.csv", "x y z"),
];

/// The names and bytes of the good files of a format, by their extensions.
fn files(format: &Format) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/data/tests/files/good");
    let extensions = if format.name == "raw-f32x4" { &["bin"][..] } else { format.extensions };
    let names = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name());
    let mut names: Vec<String> = names.map(|name| name.into_string().unwrap()).collect();
    names.sort();
    names.retain(|name| {
        let (_, extension) = [".gz", ".xz", ".bz2", ".zst"]
            .iter()
            .fold(&**name, |name, end| name.trim_end_matches(end))
            .rsplit_once('.')
            .unwrap();
        extensions.contains(&extension)
    });
    let read = |name: String| (name.clone(), std::fs::read(folder.join(name)).unwrap());
    names.into_iter().map(read).collect()
}

/// The good files of a format; none if it is unknown here. Files that they need are written into the folder.
pub(crate) fn of(format: &Format, folder: &Path) -> Vec<Seed> {
    let mut seeds = match format.name {
        "dcd" => dcd(folder),
        "trr" => trr(folder),
        "xtc" => xtc(folder),
        _ => Vec::new(),
    };
    for (name, bytes) in files(format) {
        let mut options = Options::default();
        match NEEDS.iter().find(|(file, _)| *file == name).map_or("", |(_, need)| need) {
            "radius" => options.radius = Some(1.0),
            columns => options.columns = columns.split_terminator(' ').map(str::to_owned).collect(),
        }
        if let (Ok(text), "xyz" | "mmcif") = (str::from_utf8(&bytes), format.name) {
            seeds.push((text.replace('\n', "\r\n").into_bytes(), options.clone()));
        }
        seeds.push((bytes, options));
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
    [false, true].map(|is_double| with_topology(gromacs::trr(is_double), folder, gromacs::ATOMS)).into()
}

fn xtc(folder: &Path) -> Vec<Seed> {
    let (old, new) = (molly::Magic::Xtc1995, molly::Magic::Xtc2023);
    // Positions of fewer than ten atoms are not compressed.
    [(5, old), (12, old), (60, new)]
        .map(|(atoms, magic)| with_topology(gromacs::xtc(2, atoms, magic), folder, atoms))
        .into()
}

fn with_topology(bytes: Vec<u8>, folder: &Path, atoms: usize) -> Seed {
    (bytes, Options::default().with_topology(topology(folder, atoms)))
}
