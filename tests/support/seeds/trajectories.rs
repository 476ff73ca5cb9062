//! Good binary files of several frames. Those of DCD, TRR and XTC need a topology.

use std::path::Path;

use pinhole::load::Options;

use super::Seed;
use crate::binary_files::{dcd as charmm, gromacs, gsd as hoomd, topology};

pub(super) fn gsd() -> Vec<Seed> {
    [1, 2].map(|version| Seed::new(hoomd::file(version, &hoomd::chunks()))).into()
}

pub(super) fn dcd(folder: &Path) -> Vec<Seed> {
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

pub(super) fn trr(folder: &Path) -> Vec<Seed> {
    [false, true]
        .map(|is_double| with_topology(gromacs::trr(is_double), folder, gromacs::ATOMS))
        .into()
}

pub(super) fn xtc(folder: &Path) -> Vec<Seed> {
    let (old, new) = (molly::Magic::Xtc1995, molly::Magic::Xtc2023);
    // Of fewer than ten atoms the positions are not compressed.
    [(5, old), (12, old), (60, new)]
        .map(|(atoms, magic)| with_topology(gromacs::xtc(2, atoms, magic), folder, atoms))
        .into()
}

fn with_topology(bytes: Vec<u8>, folder: &Path, atoms: usize) -> Seed {
    Seed::with_options(bytes, Options::default().with_topology(topology(folder, atoms)))
}
