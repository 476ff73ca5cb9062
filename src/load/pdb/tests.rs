//! Tests of the PDB reader with files that are made here.

use super::*;
use crate::load::elements::appearance;
use crate::load::tests::{damage, labels, numbers, spheres};
use crate::load::{ColumnValues, Labels};

/// The fields of an atom record that tests vary. The other fields are constant.
struct Row {
    record: &'static str,
    name: &'static str,
    letter: char,
    residue: &'static str,
    number: &'static str,
    x: f64,
    occupancy: f64,
    symbol: &'static str,
}

const ROW: Row = Row {
    record: "ATOM",
    name: " CA ",
    letter: ' ',
    residue: "ALA",
    number: "1",
    x: 1.5,
    occupancy: 1.0,
    symbol: "C",
};

impl Row {
    fn line(&self) -> String {
        let Self { record, name, letter, residue, number, x, occupancy, symbol } = self;
        let (y, z, b) = (-2.25, 103.125, 12.5);
        format!(
            "{record:<6}   ** {name:4}{letter}{residue:>3} A{number:>4}    \
             {x:8.3}{y:8.3}{z:8.3}{occupancy:6.2}{b:6.2}          {symbol:>2}  \n"
        )
    }
}

fn file(rows: &[Row]) -> String {
    rows.iter().map(Row::line).collect()
}

fn loaded(text: &str) -> Loaded {
    read(text.as_bytes(), 0).unwrap()
}

fn xs(loaded: &Loaded) -> Vec<f64> {
    spheres(loaded).iter().map(|sphere| sphere[0]).collect()
}

#[test]
fn every_column() {
    let rows = [
        ROW,
        Row { record: "HETATM", name: "FE  ", residue: "HEM", number: "A000", symbol: "FE", ..ROW },
    ];
    let text = format!("HEADER    X\nREMARK ATOM\n{}TER\nEND\n", file(&rows));
    let loaded = loaded(&text);
    let (carbon, iron) = (appearance("C"), appearance("Fe"));
    assert_eq!(
        spheres(&loaded),
        [[1.5, -2.25, 103.125, carbon.radius], [1.5, -2.25, 103.125, iron.radius]]
    );
    assert_eq!(loaded.colors, Some(vec![carbon.color, iron.color]));
    assert_eq!(labels(&loaded, "species"), ["C", "Fe"]);
    assert_eq!(labels(&loaded, "name"), ["CA", "FE"]);
    assert_eq!(labels(&loaded, "residue"), ["ALA", "HEM"]);
    assert_eq!(labels(&loaded, "chain"), ["A", "A"]);
    assert_eq!(labels(&loaded, "record"), ["ATOM", "HETATM"]);
    assert_eq!(numbers(&loaded, "residue_number"), [1.0, 10_000.0]);
    assert_eq!(numbers(&loaded, "b_factor"), [12.5, 12.5]);
    assert_eq!(numbers(&loaded, "occupancy"), [1.0, 1.0]);
    assert_eq!((loaded.cell, loaded.frames), (None, Some(1)));
    assert_eq!(loaded.notes, [""; 0]);
}

#[test]
fn one_name_in_two_places_of_its_field() {
    let loaded = loaded(&file(&[ROW, Row { name: "CA  ", ..ROW }]));
    let Some(ColumnValues::Labels(Labels { names, .. })) = loaded.column("name") else { panic!() };
    assert_eq!(names, &["CA"]);
}

#[test]
fn line_ends_blanks_marks_and_short_lines() {
    let text = file(&[ROW, ROW]);
    let wanted = loaded(&text);
    for same in [
        text.replace('\n', "\r\n"),
        format!("\u{feff}{text}"),
        text.trim_end().to_owned(),
        text.replace('\n', "          \n"),
        format!("\n\n{text}\n\n"),
        text.replace("   **", "A0000"),
        text.replace("ATOM     **", "ATOM 100000"),
        // Only records that are read must be ASCII.
        format!("REMARK caf\u{e9}\n{text}"),
    ] {
        assert_eq!(loaded(&same), wanted, "{same:?}");
    }
    let cut: String = text.lines().map(|line| format!("{}\n", &line[..54])).collect();
    let cut = loaded(&cut);
    assert_eq!(cut.spheres, wanted.spheres);
    assert_eq!(numbers(&cut, "occupancy"), [1.0, 1.0]);
    assert_eq!(numbers(&cut, "b_factor"), [0.0, 0.0]);
}

#[test]
fn unknown_elements_are_noted() {
    let named = |symbol| Row { name: " J  ", residue: "LIG", symbol, ..ROW };
    let note = |names: &str| {
        format!(
            "these species are not chemical elements: {names}; they are drawn in pink with radius 2 unless a scene \
             file has a table `[elements.NAME]` for them"
        )
    };
    let one = loaded(&file(&[named("X"), ROW, named("X")]));
    assert_eq!(one.notes, [note("X")]);
    assert!((spheres(&one)[0][3] - 2.0).abs() < 1e-12);
    let many = ["X", "QA", "QB", "QC", "QD", "QE", "QF", "QG"].map(named);
    assert_eq!(loaded(&file(&many)).notes, [note("X, QA, QB, QC, QD and 3 more")]);
}

#[test]
fn names_that_calcium_and_alpha_carbon_share() {
    let at = |name, residue, number, symbol| Row { name, residue, number, symbol, ..ROW };
    let species = |rows: &[Row]| {
        let loaded = loaded(&file(rows));
        (labels(&loaded, "species"), loaded.notes)
    };
    let none = Vec::<String>::new();
    assert_eq!(species(&[at("CA  ", "ALA", "1", "")]), (vec!["C".to_owned()], none.clone()));
    assert_eq!(species(&[at(" CA ", "LIG", "1", "")]), (vec!["C".to_owned()], none.clone()));
    assert_eq!(species(&[at("CA  ", "CA", "1", "")]), (vec!["Ca".to_owned()], none.clone()));
    assert_eq!(species(&[at("CA  ", "LIG", "1", "CA")]), (vec!["Ca".to_owned()], none));
    // A residue that is not known, whose name is in the wrong columns.
    let residue =
        [at("N   ", "SEP", "1", ""), at("CA  ", "SEP", "1", ""), at("CA  ", "XXX", "2", "")];
    let (found, notes) = species(&residue);
    assert_eq!(found, ["N", "C", "Ca"]);
    assert_eq!(
        notes,
        [
            "1 atoms CA of the residues SEP have no element and are taken as carbon, because these residues have atoms C \
             or N as well",
            "1 atoms CA of the residues XXX have no element and are taken as calcium, because the place of the name says \
             so"
        ]
    );
}

#[test]
fn alternate_locations() {
    let at = |name, letter, occupancy, x| Row { name, letter, occupancy, x, ..ROW };
    let rows = [
        at(" N  ", ' ', 1.0, 0.0),
        at(" CA ", 'A', 0.4, 1.0),
        at(" CA ", 'B', 0.6, 2.0),
        at(" CB ", 'A', 0.4, 3.0),
        at(" CB ", 'B', 0.6, 4.0),
        // This atom occurs only at the location with the lower occupancy.
        at(" CG ", 'A', 0.4, 5.0),
        // The blank location has precedence over the others.
        at(" N  ", 'B', 0.6, 6.0),
        // In this residue the occupancies are equal.
        Row { number: "2", ..at(" CA ", 'B', 0.5, 7.0) },
        Row { number: "2", ..at(" CA ", 'A', 0.5, 8.0) },
        // Two residues are alternatives at the same place in the chain.
        Row { number: "3", residue: "SER", ..at(" CA ", 'A', 0.3, 9.0) },
        Row { number: "3", residue: "SER", ..at(" OG ", 'A', 0.3, 10.0) },
        Row { number: "3", residue: "THR", ..at(" CA ", 'B', 0.7, 11.0) },
    ];
    let all = loaded(&file(&rows));
    assert_eq!(xs(&all), [0.0, 2.0, 4.0, 5.0, 7.0, 11.0]);
    assert_eq!(labels(&all, "residue"), ["ALA", "ALA", "ALA", "ALA", "ALA", "THR"]);
    let Some(ColumnValues::Labels(Labels { names, .. })) = all.column("residue") else { panic!() };
    assert_eq!(names, &["ALA", "THR"]);
    let kept = "the locations with the highest occupancy are kept";
    let six = format!("6 atoms are left out as alternate locations of other atoms; {kept}");
    assert_eq!(all.notes, [six]);
    let one = format!("1 atom is left out as alternate location of another atom; {kept}");
    assert_eq!(loaded(&file(&rows[1..3])).notes, [one]);
    assert_eq!(loaded(&file(&rows[1..2])).notes, [""; 0]);
}

#[test]
fn models() {
    let second = file(&[Row { x: 2.0, ..ROW }, Row { x: 3.0, ..ROW }]);
    let text = format!(
        "{}MODEL        1\n{}ENDMDL\nCRYST1    2.000    3.000    4.000  90.00  90.00  90.00 P 1\n\
         MODEL        2\n{second}ENDMDL\nMODEL 3\nENDMDL\nEND\n",
        "CRYST1    1.000    1.000    1.000  90.00  90.00  90.00 P 1\n",
        file(&[ROW])
    );
    let first = loaded(&text);
    assert_eq!((xs(&first), first.cell, first.frames), (vec![1.5], None, Some(3)));
    let second = read(text.as_bytes(), 1).unwrap();
    assert_eq!((xs(&second), second.frames), (vec![2.0, 3.0], Some(3)));
    assert_eq!(second.cell, Some([[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]]));
}

#[test]
fn atoms_after_the_end_are_noted() {
    let atom = ROW.line();
    for end in ["END", "ENDMDL", "END   "] {
        let loaded = loaded(&format!("{atom}{end}\n{atom}{atom}{end}\n"));
        assert_eq!(xs(&loaded), [1.5]);
        assert_eq!(
            loaded.notes,
            [
                "the atoms from line 3 on are left out, because they follow the end of the structure; if they are \
                 further frames, enclose each frame with MODEL and ENDMDL"
            ]
        );
    }
}

fn cell(fields: &str) -> Option<[[f64; 3]; 3]> {
    loaded(&format!("CRYST1{fields}\n{}", ROW.line())).cell
}

#[test]
fn cells() {
    let edges = cell("   10.000   20.000   30.000  80.00 100.00 110.00 P 1").unwrap();
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let [a, b, c] = edges;
    for (found, wanted) in [
        (dot(a, a).sqrt(), 10.0),
        (dot(b, b).sqrt(), 20.0),
        (dot(c, c).sqrt(), 30.0),
        (dot(b, c) / 600.0, 80_f64.to_radians().cos()),
        (dot(a, c) / 300.0, 100_f64.to_radians().cos()),
        (dot(a, b) / 200.0, 110_f64.to_radians().cos()),
    ] {
        assert!((found - wanted).abs() < 1e-12, "{found} is not {wanted}");
    }
    assert!([a[1], a[2], b[2]].iter().all(|zero| zero.abs() < 1e-12));
    assert_eq!(cell("    1.000    1.000    1.000  90.00  90.00  90.00"), None);
    assert_eq!(cell("    0.000    0.000    0.000   0.00   0.00   0.00"), None);
}

#[test]
fn no_input_panics() {
    let text = format!(
        "CRYST1   10.000   20.000   30.000  80.00 100.00 110.00 P 1\nMODEL 1\n{}ENDMDL\nMODEL 2\n{}ENDMDL\n",
        file(&[ROW, Row { letter: 'A', ..ROW }]),
        file(&[Row { letter: 'B', number: "zzzz", ..ROW }])
    );
    damage(&text, b" \n\r0Aa.-_\xff\0HE", |bytes, frame| read(bytes, frame).ok());
}
