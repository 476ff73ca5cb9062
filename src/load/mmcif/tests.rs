//! Files that are made here.

use super::*;
use crate::load::format::read_from_memory;
use crate::load::tests::{centers, damage, labels};
use crate::load::{Format, from_bytes};

const NAMES: [&str; 12] = [
    "group_PDB",
    "type_symbol",
    "auth_atom_id",
    "label_alt_id",
    "auth_comp_id",
    "auth_asym_id",
    "auth_seq_id",
    "Cartn_x",
    "Cartn_y",
    "Cartn_z",
    "occupancy",
    "pdbx_PDB_model_num",
];

fn header(names: &[&str]) -> String {
    names.iter().fold("loop_\n".to_owned(), |text, name| text + "_atom_site." + name + "\n")
}

/// A file with rows that have the names above.
fn file(rows: &[&str]) -> String {
    format!("data_X\n{}{}\n#\n", header(&NAMES), rows.join("\n"))
}

fn read(text: &str, frame: usize) -> Result<Loaded, LoadError> {
    read_from_memory(text.as_bytes(), FRAMES, &Options::default().with_frame(frame), None)
}

fn loaded(text: &str) -> Loaded {
    read(text, 0).unwrap()
}

fn xs(loaded: &Loaded) -> Vec<f64> {
    centers(loaded).iter().map(|center| center[0]).collect()
}

const CARBON: &str = "ATOM C CA . ALA A 7 1.5 -2.25 103.125 1.00 1";

#[test]
fn the_same_as_from_a_pdb_file() {
    let pdb = "CRYST1   10.000   20.000   30.000  80.00 100.00 110.00 P 1\n\
        ATOM      1  CA AALA A   7       1.500  -2.250 103.125  0.40 12.50           C\n\
        ATOM      2  CA BALA A   7       2.500  -2.250 103.125  0.60 12.50           C\n\
        HETATM    3 FE   HEM B  42A      3.500   0.000   0.000  1.00  0.25          FE\n\
        HETATM    4 CA    CA B  -3       4.500   0.000   0.000  1.00  0.25            \n";
    let cif = "data_4HHB\n_cell.length_a 10.0\n_cell.length_b 20\n_cell.length_c 30.00(2)\n_cell.angle_alpha 80\n\
        _cell.angle_beta 100\n_cell.angle_gamma '110'\nloop_\n_atom_site.label_entity_id\n_atom_site.B_iso_or_equiv\n\
        _atom_site.Cartn_z _atom_site.Cartn_y _atom_site.cartn_X # a comment\n_atom_site.occupancy\n\
        _atom_site.label_atom_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.auth_asym_id\n\
        _atom_site.auth_seq_id\n_atom_site.label_seq_id\n_atom_site.label_alt_id\n_atom_site.pdbx_PDB_ins_code\n\
        _atom_site.type_symbol\n_atom_site.group_PDB\n\
        1 12.50 103.125 -2.250 1.500 0.40 CA ALA Q A 7 1 A ? C ATOM\n\
        1 12.50 103.125 -2.250 2.500 0.60 CA\nALA Q A 7 1 'B' ? C ATOM\n\
        2 0.25 0 0 3.5 1.00 \"FE\" HEM Q B 42 . .\n;A\n;\nFE HETATM 2 .25 0.0 0 4.5 ? CA CA Q B -3 . ? ? . HETATM\n";
    let pdb = from_bytes(pdb.as_bytes(), "a.pdb", &Options::default()).unwrap();
    let mut cif = from_bytes(cif.as_bytes(), "a.cif", &Options::default()).unwrap();
    let entity = cif.columns.pop().unwrap();
    assert_eq!(entity.name, "entity");
    assert_eq!(labels(&pdb, "species"), ["C", "Fe", "Ca"]);
    assert_eq!(cif, pdb);
}

#[test]
fn atoms_without_symbols() {
    let species = |name: &str, residue: &str| {
        let row = format!("ATOM ? {name} . {residue} A 7 0 0 0 1 1");
        labels(&loaded(&file(&[&row])), "species").remove(0)
    };
    for (name, residue, wanted) in [
        ("CA", "ALA", "C"),
        ("CA", "CA", "Ca"),
        ("CA", "LIG", "C"),
        ("ZN", "ZN", "Zn"),
        ("\"O5'\"", "DA", "O"),
        ("HG11", "VAL", "H"),
    ] {
        assert_eq!(species(name, residue), wanted, "{name} of {residue}");
    }
}

#[test]
fn models_and_blocks_are_frames() {
    let model = |number: &str, x: &str| {
        CARBON.replace("1.5", x).replace(" 1.00 1", &format!(" 1.00 {number}"))
    };
    let (a, b, c) = (model("1", "1"), model("2", "2"), model("x", "3"));
    let by_lines = format!("{}{}", file(&[&a, &a, &b, &c, &c]), file(&[&model("1", "4")]));
    for text in [
        by_lines.clone(),
        by_lines.replace('\n', "\r\n"),
        // Rows over several lines, and several rows on a line.
        by_lines.replace(" A 7 ", " A\n 7 "),
        by_lines.replace(" A 7 ", "\n;A\n; 7\n"),
        by_lines.replace("ATOM", " ATOM").replace(" 1\n ATOM", " 1 ATOM").replace("x\n ", "x "),
        by_lines.replace("\nATOM", "\n# comment\n\nATOM"),
    ] {
        let frames: Vec<_> = (0..4).map(|frame| xs(&read(&text, frame).unwrap())).collect();
        assert_eq!(frames, [vec![1.0, 1.0], vec![2.0], vec![3.0, 3.0], vec![4.0]], "{text}");
    }
    // The model is not the last column, or there is none.
    let first = format!(
        "data_X\n{}1 1 0 0\n1 2 0 0\n2 3 0 0\n",
        header(&["pdbx_PDB_model_num", "Cartn_x", "Cartn_y", "Cartn_z"])
    );
    assert_eq!(
        [xs(&read(&first, 0).unwrap()), xs(&read(&first, 1).unwrap())],
        [vec![1.0, 2.0], vec![3.0]]
    );
    let none = format!(
        "data_X\n{}1 0 0\n2 0 0\nloop_\n_a\nb\n",
        header(&["Cartn_x", "Cartn_y", "Cartn_z"])
    );
    assert_eq!(xs(&loaded(&none)), [1.0, 2.0]);
}

#[test]
fn each_block_has_its_cell() {
    let cell = |a: &str| {
        format!(
            "_cell.length_a {a} _cell.length_b 2 _cell.length_c 2\n_cell.angle_alpha 90\n_cell.angle_beta 90 _cell.angle_gamma 90\n"
        )
    };
    let atoms = file(&[CARBON]);
    let text = format!(
        "{}{atoms}{}{atoms}{}data_X\n{}",
        cell("3"),
        cell("4"),
        "data_Y\n_a b\n",
        cell("6")
    );
    // The first cell stands before any block, the second after the atoms of its block, the third in another block.
    let edges: Vec<_> =
        (0..2).map(|frame| read(&text, frame).unwrap().cell.map(|cell| cell[0][0])).collect();
    assert_eq!(edges, [Some(4.0), None]);
}

#[test]
fn small_molecules() {
    let text = "data_x\n_cell_length_a 10\n_cell_length_b 20\n_cell_length_c 30\n_cell_angle_alpha 90\n\
        _cell_angle_beta 90\n_cell_angle_gamma 90\nloop_\n_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n\
        _atom_site_fract_z\nFe1 0.5000(3) -0.25 1\nC12A 0 0 0\nloop_\n_atom_site_aniso_label\nFe1\n";
    let found = loaded(text);
    assert_eq!(centers(&found), [[5.0, -5.0, 30.0], [0.0; 3]]);
    assert_eq!(labels(&found, "species"), ["Fe", "C"]);
    assert!(
        found.notes[0].contains("the symmetry of the crystal is not applied"),
        "{:?}",
        found.notes
    );
}

#[test]
fn no_input_panics() {
    let text = file(&[CARBON, &CARBON.replace(" 1.00 1", " 1.00 2")])
        .repeat(2)
        .replace("data_X", "data_X\n_cell.length_a 3");
    let format = Format::of_name("mmcif").unwrap();
    damage(&text, b"\n\t '\";#_.\xff\0\x01", |bytes, frame| {
        format.read(bytes, &Options::default().with_frame(frame)).ok()
    });
}
