//! Measures readers of text against a parser of a few lines for the same text, which knows its layout and checks nothing.
//!
//! ```sh
//! cargo bench --bench load
//! cargo bench --bench load -- files 4hhb.pdb trajectory.xyz    # times and peak memory of own files
//! ```
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark may panic, and prints")]

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use pinhole::load::{self, Loaded, Options};

/// How often each is measured, by turns.
const TURNS: usize = 9;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    if let [files, paths @ ..] = arguments.as_slice()
        && files == "files"
    {
        return paths.iter().for_each(|path| file(path));
    }
    let atoms = 300_000;
    compare("xyz", &xyz(atoms), |text| few_lines(text, 2, 0, &[1, 2, 3]));
    let cif = cif(atoms);
    compare("mmcif", &cif, |text| few_lines(text, CIF.len() + 2, 5, &[10, 11, 12, 13, 14, 16]));
    let pdb = pdb(atoms);
    compare("pdb", &pdb, few_columns);
    compare("lammps-dump", &dump(atoms), |text| few_lines(text, 9, 1, &[2, 3, 4, 0, 5, 6, 7]));
}

/// Prints the median times of the reader and of the few lines, and their ratio.
fn compare(format: &str, text: &str, few_lines: impl Fn(&str) -> Atoms) {
    let options = Options::default().with_format(load::Format::of_name(format).unwrap());
    let read = || load::from_bytes(text.as_bytes(), "", &options).unwrap();
    let centers = |loaded: &Loaded| {
        loaded.spheres.with_color(pinhole::LinearRgb::WHITE).map(|s| s.center).collect::<Vec<_>>()
    };
    assert_eq!(centers(&read()), few_lines(text).centers);
    let (mut reader, mut yardstick) = (Vec::new(), Vec::new());
    for _ in 0..TURNS {
        reader.push(seconds(|| drop(black_box(read()))));
        yardstick.push(seconds(|| drop(black_box(few_lines(text)))));
    }
    let (reader, yardstick) = (median(reader), median(yardstick));
    println!(
        "{format:12} {:6.1} MB: {:7.1} ms, few lines {:7.1} ms, ratio {:.2}",
        text.len() as f64 / 1e6,
        reader * 1e3,
        yardstick * 1e3,
        reader / yardstick
    );
}

fn seconds(what: impl FnOnce()) -> f64 {
    let start = Instant::now();
    what();
    start.elapsed().as_secs_f64()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Prints how long the last frame of a file takes, which is found by passing over the others, and the peak memory of this
/// process.
fn file(path: &str) {
    let frames = load::Trajectory::open(path, &Options::default()).map_or(1, |found| found.len());
    let mut options = Options::default();
    options.frame = (frames > 1).then_some(frames - 1);
    let mut loaded = None;
    let times = (0..TURNS)
        .map(|_| {
            loaded = None;
            seconds(|| loaded = Some(load::open(path, &options).unwrap()))
        })
        .collect();
    let loaded = loaded.unwrap();
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or_default().to_owned();
    println!(
        "{path}: {frames} frames, {} spheres, {:.1} ms; {peak}; {:?}",
        loaded.spheres.len(),
        median(times) * 1e3,
        loaded.notes
    );
}

/// What the few lines keep: places, other numbers, and for each atom which of the different texts one value is.
#[derive(Default)]
struct Atoms {
    centers: Vec<[f64; 3]>,
    numbers: Vec<Vec<f64>>,
    names: Vec<String>,
    indices: Vec<usize>,
}

/// The first three of the `numbers` are places.
fn few_lines(text: &str, head: usize, name: usize, numbers: &[usize]) -> Atoms {
    let mut atoms = Atoms { numbers: vec![Vec::new(); numbers.len() - 3], ..Atoms::default() };
    for line in text.lines().skip(head) {
        let values: Vec<&str> = line.split_ascii_whitespace().collect();
        let number = |index: usize| values[numbers[index]].parse().unwrap();
        atoms.centers.push([0, 1, 2].map(number));
        for (index, column) in atoms.numbers.iter_mut().enumerate() {
            column.push(number(index + 3));
        }
        let known = atoms.names.iter().position(|known| known == values[name]);
        atoms.indices.push(known.unwrap_or(atoms.names.len()));
        if known.is_none() {
            atoms.names.push(values[name].to_owned());
        }
    }
    atoms
}

/// As [`few_lines`], for the fixed columns of PDB.
fn few_columns(text: &str) -> Atoms {
    let mut atoms = Atoms { numbers: vec![Vec::new(); 3], ..Atoms::default() };
    for line in text.lines() {
        let number = |range: std::ops::Range<usize>| line[range].trim().parse::<f64>().unwrap();
        atoms.centers.push([number(30..38), number(38..46), number(46..54)]);
        for (column, range) in atoms.numbers.iter_mut().zip([54..60, 60..66, 22..26]) {
            column.push(number(range));
        }
        let residue = line[17..20].trim();
        let known = atoms.names.iter().position(|known| known == residue);
        atoms.indices.push(known.unwrap_or(atoms.names.len()));
        if known.is_none() {
            atoms.names.push(residue.to_owned());
        }
    }
    atoms
}

const CIF: [&str; 21] = [
    "group_PDB",
    "id",
    "type_symbol",
    "label_atom_id",
    "label_alt_id",
    "label_comp_id",
    "label_asym_id",
    "label_entity_id",
    "label_seq_id",
    "pdbx_PDB_ins_code",
    "Cartn_x",
    "Cartn_y",
    "Cartn_z",
    "occupancy",
    "B_iso_or_equiv",
    "pdbx_formal_charge",
    "auth_seq_id",
    "auth_comp_id",
    "auth_asym_id",
    "auth_atom_id",
    "pdbx_PDB_model_num",
];

/// Atoms of residues: element, name, residue, number, place and B-factor.
fn residues(atoms: usize, mut each: impl FnMut(usize, [&'static str; 3], usize, [f64; 3], f64)) {
    let mut random = fastrand::Rng::with_seed(3);
    for atom in 0..atoms {
        let (element, name) =
            [("N", "N"), ("C", "CA"), ("C", "C"), ("O", "O"), ("C", "CB")][atom % 5];
        let residue = ["ALA", "GLY", "LEU", "SER", "VAL"][atom / 5 % 5];
        let place = [(); 3].map(|()| 100.0 * random.f64());
        each(atom, [element, name, residue], atom / 5 % 9999, place, 90.0 * random.f64());
    }
}

fn cif(atoms: usize) -> String {
    let mut text = CIF
        .iter()
        .fold("data_X\nloop_\n".to_owned(), |text, name| text + "_atom_site." + name + "\n");
    residues(atoms, |atom, [element, name, residue], number, [x, y, z], b| {
        writeln!(
            text,
            "ATOM   {:<6} {element} {name:<3} . {residue} A 1 {number:<4} ? {x:<8.3} {y:<8.3} {z:<8.3} 1.00 {b:<6.2} ? \
             {number:<4} {residue} A {name:<3} 1 ",
            atom + 1
        )
        .unwrap();
    });
    text
}

fn pdb(atoms: usize) -> String {
    let mut text = String::new();
    residues(atoms, |atom, [element, name, residue], number, [x, y, z], b| {
        writeln!(
            text,
            "ATOM  {:5}  {name:<3} {residue} A{number:4}    {x:8.3}{y:8.3}{z:8.3}  1.00{b:6.2}          {element:>2}",
            (atom + 1) % 100_000
        )
        .unwrap();
    });
    text
}

fn xyz(atoms: usize) -> String {
    let mut random = fastrand::Rng::with_seed(1);
    (0..atoms).fold(format!("{atoms}\n\n"), |mut text, _| {
        let [x, y, z] = [(); 3].map(|()| 100.0 * random.f64());
        let element = ["H", "C", "O", "N"][random.usize(..4)];
        writeln!(text, "{element} {x:14.8} {y:14.8} {z:14.8}").unwrap();
        text
    })
}

fn dump(atoms: usize) -> String {
    let mut random = fastrand::Rng::with_seed(2);
    let head = format!(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{atoms}\nITEM: BOX BOUNDS pp pp pp\n0 100\n0 100\n0 100\n\
         ITEM: ATOMS id type x y z vx vy vz\n"
    );
    (0..atoms).fold(head, |mut text, id| {
        let [x, y, z] = [(); 3].map(|()| 100.0 * random.f32());
        let [vx, vy, vz] = [(); 3].map(|()| random.f32() - 0.5);
        let kind = random.u8(1..4);
        writeln!(text, "{id} {kind} {x} {y} {z} {vx} {vy} {vz}").unwrap();
        text
    })
}
