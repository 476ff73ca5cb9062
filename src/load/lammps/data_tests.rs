//! Data files that are made here.

use super::tests::{centers, labels, numbers, spheres};
use crate::load::{self, Loaded, Options};

pub(super) const DATA: &str = "made by hand\n\n3 atoms\n2 atom types\n0 4 xlo xhi\n0 5 ylo yhi # a comment\n-1 5 zlo zhi\n\
    1 0 0.5 xy xz yz\n\nMasses\n\n1 15.9994 # O\n2 1.008\n\nBond Coeffs\n\n1 2 3\n\nAtoms # full\n\n2 1 2 0.4 1 0 0 0 0 -1\n\
    1 1 1 -0.8 0 0 0 0 0 0 # first\n3 1 2 0.4 0 1 0 0 0 0\n\nVelocities\n\n3 7 8 9\n1 1 2 3\n2 4 5 6\n\nBonds\n\n1 1 1 2\n";

fn data(text: &str) -> Result<Loaded, String> {
    let loaded = load::from_bytes(text.as_bytes(), "a.data", &Options::default());
    loaded.map_err(|error| error.to_string())
}

#[test]
fn data_files() {
    let loaded = data(DATA).unwrap();
    assert_eq!(centers(&loaded), [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(labels(&loaded, "species"), ["O", "H", "H"]);
    assert_eq!(labels(&loaded, "type"), ["1", "2", "2"]);
    assert_eq!(numbers(&loaded, "q"), [-0.8, 0.4, 0.4]);
    assert_eq!(numbers(&loaded, "iz"), [0.0, -1.0, 0.0]);
    assert_eq!(numbers(&loaded, "vy"), [2.0, 5.0, 8.0]);
    assert_eq!(loaded.cell, Some([[4.0, 0.0, 0.0], [1.0, 5.0, 0.0], [0.0, 0.5, 6.0]]));
    assert!(loaded.notes[0].ends_with("by their masses: 2 is H, 1 is O"), "{:?}", loaded.notes);
    // By content, as these files often have no extension.
    let named = load::from_bytes(DATA.as_bytes(), "data.water", &Options::default()).unwrap();
    assert_eq!(named, loaded);
    let labelled = DATA.replace("\nMasses", "\nAtom Type Labels\n\n1 OW\n2 HW\n\nMasses");
    let labelled = data(&labelled).unwrap();
    assert_eq!(labels(&labelled, "type"), ["OW", "HW", "HW"]);
    assert_eq!(labels(&labelled, "species"), ["O", "H", "H"]);
    // Masses of one are in units of their own; masses of beads are of no element.
    for masses in ["1 1\n2 1\n", "1 45.5\n2 36.3\n"] {
        let beads = data(&DATA.replace("1 15.9994 # O\n2 1.008\n", masses)).unwrap();
        assert_eq!(beads.labels("species"), None, "{masses}");
    }
}

#[test]
fn styles_of_data_files() {
    let atom =
        |style: &str, values: &str| data(&format!("\n1 atoms\n\nAtoms{style}\n\n{values}\n"));
    for (style, values) in [
        ("", "1 1 1 2 3"),
        ("", "1 1 1 2 3 0 0 0"),
        (" # atomic", "1 1 1 2 3"),
        (" # charge", "1 1 0.5 1 2 3"),
        ("# molecular", "1 1 1 1 2 3 0 0 -1"),
        (" # sphere", "1 1 0.5 2.5 1 2 3"),
    ] {
        let loaded = atom(style, values).unwrap();
        assert_eq!(centers(&loaded), [[1.0, 2.0, 3.0]], "{style}");
    }
    assert_eq!(spheres(&atom(" # sphere", "1 1 0.5 2.5 1 2 3").unwrap())[0][3], 0.25);
    let named = Options::default().with_columns(["id", "type", "q", "x", "y", "z"]);
    let text = b"\n1 atoms\n\nAtoms\n\n1 1 0.5 1 2 3\n";
    assert_eq!(centers(&load::from_bytes(text, "a.lmp", &named).unwrap()), [[1.0, 2.0, 3.0]]);
}
