//! Good files of formats that are text with one atom on each line, one of them compressed.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::Seed;

pub(super) fn xyz() -> Vec<Seed> {
    let two =
        "3\nwater\nO 0 0 0.1\nH 0.76 0 -0.5\nH -0.76 0 -0.5\n2\n\nFe 1e1 2.5D0 -3\nXx 0 0 0\n";
    let mut gz = GzEncoder::new(Vec::new(), Compression::fast());
    gz.write_all(two.as_bytes()).unwrap();
    vec![Seed::new(two), Seed::new(two.replace('\n', "\r\n")), Seed::new(gz.finish().unwrap())]
}

pub(super) fn extxyz() -> Vec<Seed> {
    let head = "2\nLattice=\"4 0 0 0 4 0 0 0 4\" Properties=species:S:1:pos:R:3:radius:R:1:color:R:3:forces:R:3:id:I:1 \
                energy=-1.5\n";
    let atoms = "O 0 0 0.1 0.5 1 0 0.5 1 2 3 7\nH 0.76 0 -0.5 0.3 0 0 1 -1 -2 -3 8\n";
    let numbers = "1\nProperties=Z:I:1:pos:R:3:label:S:1:fixed:L:1\n6 1 2 3 CA T\n";
    vec![Seed::new([head, atoms, head, atoms].concat()), Seed::new(numbers)]
}

pub(super) fn pdb() -> Vec<Seed> {
    let atoms = "ATOM      1  N   VAL A   1       6.204  16.869   4.854  1.00 49.05           N\n\
                 ATOM      2  CA AVAL A   1       6.913  17.759   4.607  0.50 43.14           C\n\
                 ATOM      3  CA BVAL A   1       6.913  17.859   4.607  0.50 43.14           C\n\
                 HETATM 4430 FE   HEM A 142       8.128   7.371 -15.022  1.00 16.74          FE\n";
    let cell = "HEADER    OXYGEN TRANSPORT\n\
                CRYST1   63.150   83.590   53.800  90.00  99.34  90.00 P 1 21 1      4\n";
    let models =
        format!("{cell}MODEL        1\n{atoms}ENDMDL\nMODEL        2\n{atoms}TER\nENDMDL\nEND\n");
    vec![Seed::new(models), Seed::new([cell, atoms].concat())]
}
