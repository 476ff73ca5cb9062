//! Dumps and data files that are made here.

use crate::load::tests::{centers, damage, labels, numbers, spheres};
use crate::load::{self, Loaded, Options};

fn dump(text: &str) -> Loaded {
    load::from_bytes(text.as_bytes(), "dump.0", &Options::default()).unwrap()
}

const HEAD: &str = "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\n";
const BOX: &str = "ITEM: BOX BOUNDS pp pp pp\n-1 3\n0 10\n5 25\n";

#[test]
fn columns_in_any_order_and_atoms_in_the_order_of_their_ids() {
    let text = format!(
        "ITEM: UNITS\nmetal\nITEM: TIME\n0.5\n{HEAD}{BOX}ITEM: ATOMS z id type vx vy vz x y radius c_1[2] element \n\
         6 9 2 .1 .2 .3 1 2 0.5 -7 O \n7 3 1 1 2 3 4 5 1.5 1e3 H\n"
    );
    let loaded = dump(&text);
    assert_eq!(spheres(&loaded), [[4.0, 5.0, 7.0, 1.5], [1.0, 2.0, 6.0, 0.5]]);
    assert_eq!(loaded.cell, Some([[4.0, 0.0, 0.0], [0.0, 10.0, 0.0], [0.0, 0.0, 20.0]]));
    assert_eq!(labels(&loaded, "species"), ["H", "O"]);
    assert_eq!(labels(&loaded, "type"), ["1", "2"]);
    assert_eq!(numbers(&loaded, "vx"), [1.0, 0.1]);
    assert_eq!(numbers(&loaded, "c_1[2]"), [1000.0, -7.0]);
    assert_eq!((loaded.frames, loaded.colors.is_some()), (Some(1), true));
}

#[test]
fn positions_are_fractions_or_unwrapped() {
    let atoms = |names: &str, values: &str| {
        centers(&dump(&format!("{HEAD}{BOX}ITEM: ATOMS {names}\n{values}\n{values}\n")))[0]
    };
    assert_eq!(atoms("xu yu zu", "1 2 3"), [1.0, 2.0, 3.0]);
    assert_eq!(atoms("xs ys zs", "0.5 0.25 1"), [1.0, 2.5, 25.0]);
    assert_eq!(atoms("xsu ysu zsu", "1.5 -0.5 0"), [5.0, -5.0, 5.0]);
    assert_eq!(atoms("xs ys zs x y z", "0.5 0.25 1 7 8 9"), [7.0, 8.0, 9.0]);
}

#[test]
fn boxes_that_are_not_orthogonal() {
    let scaled =
        |bounds: &str| dump(&format!("{HEAD}{bounds}ITEM: ATOMS id xs ys zs\n1 0 0 0\n2 1 1 1\n"));
    // xlo = 0, xhi = 4, xy = -1, xz = 2, ylo = 0, yhi = 3, yz = 1, zlo = -1, zhi = 1.
    let tilted = scaled("ITEM: BOX BOUNDS xy xz yz pp pp ff\n-1 6 -1\n0 4 2\n-1 1 1\n");
    assert_eq!(tilted.cell, Some([[4.0, 0.0, 0.0], [-1.0, 3.0, 0.0], [2.0, 1.0, 2.0]]));
    assert_eq!(tilted.cell_origin, [0.0, 0.0, -1.0]);
    assert_eq!(centers(&tilted), [[0.0, 0.0, -1.0], [5.0, 4.0, 1.0]]);
    let general = scaled("ITEM: BOX BOUNDS abc origin pp pp pp\n1 2 3 10\n0 1 0 20\n0 0 2 30\n");
    assert_eq!(general.cell, Some([[1.0, 2.0, 3.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]]));
    assert_eq!(general.cell_origin, [10.0, 20.0, 30.0]);
    assert_eq!(centers(&general), [[10.0, 20.0, 30.0], [11.0, 23.0, 35.0]]);
}

#[test]
fn types_that_are_symbols_are_elements() {
    let typed = |a: &str, b: &str| {
        dump(&format!("{HEAD}{BOX}ITEM: ATOMS id type x y z\n1 {a} 0 0 0\n2 {b} 1 1 1\n"))
    };
    let symbols = typed("O", "H");
    assert_eq!(labels(&symbols, "species"), ["O", "H"]);
    assert!(symbols.notes[0].contains("are taken as such"), "{:?}", symbols.notes);
    for (a, b) in [("1", "2"), ("O", "bead")] {
        let types = typed(a, b);
        assert_eq!(
            (labels(&types, "type"), types.labels("species")),
            (vec![a.to_owned(), b.to_owned()], None)
        );
        assert!(types.notes[0].contains("--radius sets it"), "{:?}", types.notes);
    }
}

#[test]
fn ids_that_are_not_consecutive() {
    for (ids, wanted) in
        [([7, 3, 5], [1.0, 2.0, 0.0]), ([2, 2, 1], [2.0, 0.0, 1.0]), ([3, 1, 2], [1.0, 2.0, 0.0])]
    {
        let lines: String =
            ids.iter().enumerate().map(|(x, id)| format!("{id} {x} 0 0\n")).collect();
        let head = HEAD.replace("\n2\n", "\n3\n");
        let loaded = dump(&format!("{head}{BOX}ITEM: ATOMS id x y z\n{lines}"));
        let found: Vec<f64> = centers(&loaded).iter().map(|center| center[0]).collect();
        assert_eq!(found, wanted);
    }
}

#[test]
fn frames() {
    let frame = |x: &str| format!("{HEAD}{BOX}ITEM: ATOMS id x y z\n1 {x} 0 0\n2 0 0 1\n");
    let text = frame("1") + &frame("2") + &frame("3");
    for wanted in 0..3 {
        let options = Options::default().with_frame(wanted);
        let loaded = load::from_bytes(text.as_bytes(), "", &options).unwrap();
        assert_eq!((centers(&loaded)[0][0], loaded.frames), (wanted as f64 + 1.0, Some(3)));
    }
}

#[test]
fn names_of_columns_may_be_given() {
    let whole = format!("{HEAD}{BOX}ITEM: ATOMS id x y z\n1 0 0 0\n2 0 0 1\n");
    let named = Options::default().with_columns(["id", "x", "y", "z"]);
    let bare = whole.replace(" id x y z", "");
    assert_eq!(load::from_bytes(bare.as_bytes(), "a.dump", &named).unwrap(), dump(&whole));
}

#[test]
fn no_input_panics() {
    let text =
        format!("{HEAD}{BOX}ITEM: ATOMS id type xs ys zs\n2 1 .5 .5 .5\n1 2 0 0 0\n").repeat(2);
    for (text, format) in [
        (text.as_str(), "lammps-dump"),
        (&text, "lammps-data"),
        (DATA, "lammps-dump"),
        (DATA, "lammps-data"),
    ] {
        let format = load::Format::of_name(format).unwrap();
        damage(text, b"\n\t -.e09\xff", |bytes, frame| {
            let options = Options::default();
            let options = if format.has_frames() { options.with_frame(frame) } else { options };
            format.read(bytes, &options).ok()
        });
    }
}

const DATA: &str = "made by hand\n\n3 atoms\n2 atom types\n0 4 xlo xhi\n0 5 ylo yhi # a comment\n-1 5 zlo zhi\n\
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
