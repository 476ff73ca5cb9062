//! XYZ files, and trajectories of any format that are in memory one frame at a time.

use std::fmt::Write as _;
use std::path::PathBuf;

use fastrand::Rng;
use pinhole::{LinearRgb, Sphere};
use pinhole_data::load::{self, Dataset, LoadError, Options, Trajectory, xyz};
use tempfile::TempDir;

use crate::npy::numbers;

const WATER: &str = "3\nwater\nO 0 0 0.1\nH 0.76 0 -0.5\nH -0.76 0 -0.5\n";

/// Reads a frame, and returns its atoms one by one.
fn read(bytes: &[u8], frame: usize) -> Result<(Vec<Sphere>, Dataset), LoadError> {
    let loaded = xyz::read(bytes, frame)?;
    Ok((loaded.colored_spheres(LinearRgb::WHITE).collect(), loaded))
}

#[test]
fn a_molecule() {
    let (spheres, loaded) = read(WATER.as_bytes(), 0).unwrap();
    assert_eq!(spheres.len(), 3);
    assert_eq!(spheres[1].center, [0.76, 0.0, -0.5]);
    assert_eq!(spheres[0].radius, 1.5);
    assert_eq!(spheres[0].color, LinearRgb::from_srgb8([241, 59, 59]));
    assert_eq!(loaded.notes, [""; 0]);
    let species = loaded.labels("species").unwrap();
    assert_eq!(species.names, ["O", "H"]);
    assert_eq!(*species.indices, [0, 1, 1]);
}

#[test]
fn frames_of_a_trajectory() {
    let text = format!("{WATER}1\nlone\nHe 1 2 3\n\n2\n\nNa 0 0 0\nCl 2.8 0 0\n\n");
    let atoms = |frame| read(text.as_bytes(), frame).map(|(spheres, _)| spheres.len());
    assert_eq!([0, 1, 2].map(|frame| atoms(frame).unwrap()), [3, 1, 2]);
}

#[test]
fn ways_to_write_a_file() {
    for (case, text) in [
        ("no line end at the end", "1\n\nO 0 0 0"),
        ("Windows line ends", "1\r\n\r\nO 0 0 0\r\n"),
        ("tabs", " 1 \n\nO\t0\t0\t0\n"),
        ("more columns", "1\n\nO 0 0 0 0.1 0.2 0.3 note\n"),
        ("exponents of Fortran", "1\n\nO 0.0D+00 0d0 0E0\n"),
        ("a comment in two words", "1\na b\nO 0 0 0\n"),
        ("a byte order mark", "\u{feff}1\n\nO 0 0 0\n"),
        ("blank lines before and behind", "\n\n1\n\nO 0 0 0\n\n \n"),
        ("an empty species list key", "1\nProperties2=x\nO 0 0 0\n"),
    ] {
        let (spheres, _) = read(text.as_bytes(), 0).unwrap_or_else(|e| panic!("{case}: {e}"));
        assert_eq!(spheres[0].center, [0.0; 3], "{case}");
    }
    assert!(read(b"1\n1 \xc5 wide, in Latin-1\nO 0 0 0\n", 0).is_ok());
    assert_eq!(read(b"0\nnothing\n", 0).unwrap().0, []);
}

#[test]
fn extended_columns_in_any_order() {
    let text = "2\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=id:I:1:pos:R:3:radius:R:1:color:R:3:species:S:1 Time=0.5\n\
                7 1 2 3 0.25 1 0 0.2 Fe\n8 4 5 6 0.5 0 0 0 C\n";
    let (spheres, _) = read(text.as_bytes(), 0).unwrap();
    assert_eq!(spheres[0].center, [1.0, 2.0, 3.0]);
    assert_eq!(spheres[0].radius, 0.25);
    assert_eq!(spheres[0].color, LinearRgb::from_srgb8([255, 0, 51]));
    assert_eq!(spheres[1].radius, 0.5);

    let by_number = "1\nproperties=\"Z:I:1:pos:R:3\" pbc='T T F'\n8 0 0 0\n";
    let (spheres, loaded) = read(by_number.as_bytes(), 0).unwrap();
    assert_eq!(spheres[0].radius, 1.5);
    // The dataset has numbers instead of names.
    assert!([0, 1].contains(&loaded.labels("species").map_or(0, |labels| labels.indices.len())));
}

#[test]
fn the_directions_in_which_a_cell_repeats() {
    let of = |pbc: &str| read(format!("1\nLattice=\"1 0 0 0 1 0 0 0 1\" {pbc}\nC 0 0 0\n").as_bytes(), 0);
    let found = |pbc: &str| of(pbc).unwrap().1.is_periodic;
    assert_eq!(found(""), [true; 3]);
    assert_eq!(found("pbc=\"T F T\""), [true, false, true]);
    assert_eq!(found("pbc=[False, 1, 0]"), [false; 3]);
    assert_eq!(found("pbc='[False, 1, 0]'"), [false, true, false]);
    assert!(of("pbc=\"T T\"").unwrap_err().to_string().ends_with("pbc=T T is not a list of three values T or F"));
    let dump = |ends: &str| {
        let text = format!(
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS{ends}\n0 1\n0 1\n0 1\n\
                            ITEM: ATOMS id x y z\n1 0 0 0\n"
        );
        load::from_bytes(text.as_bytes(), "a.dump", &load::Options::default()).unwrap().is_periodic
    };
    assert_eq!([dump(""), dump(" pp ff sm")], [[true; 3], [true, false, false]]);
}

#[test]
fn unknown_species_are_reported_once_each() {
    let (_, loaded) = read(b"4\n\nA 0 0 0\nO 0 0 0\nB 0 0 0\nA 1 1 1\n", 0).unwrap();
    // B is not in the list, because it is boron.
    assert!(loaded.notes[0].contains("not chemical elements: A; "), "{:?}", loaded.notes);
}

/// The time must not grow with the square of the number of names.
#[test]
fn many_unknown_species() {
    let text: String = (0..50_000).map(|i| format!("bead{i} 0 0 0\n")).collect();
    let (_, loaded) = read(format!("50001\n\n{text}O 0 0 0").as_bytes(), 0).unwrap();
    assert_eq!(loaded.labels("species").unwrap().names.len(), 50_001);
    assert!(loaded.notes[0].contains("and 49995 more"), "{:?}", loaded.notes);
}

fn loaded(text: &str) -> load::Dataset {
    load::from_bytes(text.as_bytes(), "a.xyz", &Options::default()).unwrap()
}

#[test]
fn every_declared_column_and_the_cell_are_kept() {
    let text = "2\nLattice=\"4 0 0 0 5 0 1 0 6\" Properties=id:I:1:species:S:1:pos:R:3:forces:R:3:site:S:1:fixed:L:1:q:R:4\n\
        7 H 0 0 0 0.5 -1 2e3 top T 1 2 3 4\n9 O 1 1 1 1D2 0 0 hollow F 5 6 7 8\n";
    let loaded = loaded(text);
    assert_eq!(loaded.cell, Some([[4.0, 0.0, 0.0], [0.0, 5.0, 0.0], [1.0, 0.0, 6.0]]));
    let names: Vec<&str> = loaded.columns.iter().map(|column| column.name.as_str()).collect();
    let expected = "species id forces.x forces.y forces.z site fixed q.0 q.1 q.2 q.3";
    assert_eq!(names.join(" "), expected);
    assert_eq!(numbers(&loaded, "id"), [7.0, 9.0]);
    assert_eq!(numbers(&loaded, "forces.x"), [0.5, 100.0]);
    assert_eq!(numbers(&loaded, "q.3"), [4.0, 8.0]);
    assert_eq!(loaded.labels("site").unwrap().names, ["top", "hollow"]);
    assert_eq!(loaded.labels("fixed").unwrap().indices, [0, 1]);
}

/// Names mean the same as in all tables (`tests/files/accepted/csv.txt` has more cases). Notes name unused columns.
#[test]
fn columns_are_used_or_noted() {
    let one = |columns: &str, values: &str| {
        loaded(&format!("1\nProperties=species:S:1:pos:R:3:{columns}\nO 0 0 0 {values}\n"))
    };
    let srgb = |loaded: &Dataset| loaded.colors.as_ref().unwrap()[0].to_srgb8();
    for (columns, values) in [("colour:R:3", "1 0 0.2"), ("rgb:I:3", "255 0 51"), ("color:R:4", "1 0 0.2 0.5")] {
        assert_eq!(srgb(&one(columns, values)), [255, 0, 51], "{columns}");
    }
    assert_eq!(one("color:R:4", "1 0 0.2 0.5").opacities, Some(vec![0.5]));
    let odd = one("color:R:3", "-1 0 0");
    assert_eq!(srgb(&odd), [241, 59, 59]);
    assert_eq!(numbers(&odd, "color.x"), [-1.0]);
    // Missing values are kept in columns that spheres do not need.
    assert!(numbers(&one("q:R:1", "nan"), "q")[0].is_nan());
    let plain = loaded("1\n\nO 0 0 0 7 8\n");
    assert_eq!(
        plain.notes,
        ["columns 5 to 6 are not used, because the file does not name them; line 2 can do so with \
             Properties=species:S:1:pos:R:3:NAME:R:1"]
    );
}

fn written(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn xyz_text(frames: usize, random: &mut Rng) -> String {
    (0..frames).fold(String::new(), |mut text, frame| {
        let atoms = random.usize(0..5);
        let blank = if random.bool() { "\n  \r\n" } else { "" };
        write!(text, "{blank}{atoms}\r\nframe {frame} {}\n", "x".repeat(random.usize(0..3000))).unwrap();
        for _ in 0..atoms {
            let [x, y, z] = [(); 3].map(|()| random.f64());
            writeln!(text, "{} {x} {y} {z}", if random.bool() { "H" } else { "C" }).unwrap();
        }
        text
    })
}

fn pdb_text(frames: usize, random: &mut Rng) -> String {
    let mut text = "CRYST1   63.150   83.590   53.800  90.00  99.34  90.00 P 1\n".to_owned();
    for frame in 0..frames {
        writeln!(text, "MODEL     {:4}", frame + 1).unwrap();
        for atom in 0..random.usize(1..5) {
            let [x, y, z] = [(); 3].map(|()| random.f64() * 9.0);
            writeln!(text, "ATOM  {atom:5}  CA  ALA A{atom:4}    {x:8.3}{y:8.3}{z:8.3}  1.00  0.00           C")
                .unwrap();
        }
        text += "ENDMDL\n";
    }
    text + "END\n"
}

/// Frames are the same in any order, from the whole text, and when opened one by one.
#[test]
fn frames_are_those_of_the_whole_text() {
    let folder = TempDir::new().unwrap();
    for seed in 0..20 {
        let mut random = Rng::with_seed(seed);
        let count = random.usize(1..8);
        for (name, text) in [("a.xyz", xyz_text(count, &mut random)), ("a.pdb", pdb_text(count, &mut random))] {
            let text = if random.bool() { format!("\u{feff}{text}") } else { text };
            let path = written(&folder, name, &text);
            let mut trajectory = Trajectory::open(&path, &Options::default()).unwrap();
            assert_eq!((trajectory.len(), trajectory.problem().is_none()), (count, true));
            let mut order: Vec<usize> = (0..count).collect();
            random.shuffle(&mut order);
            for frame in order {
                let options = Options::default().with_frame(frame);
                let whole = load::from_bytes(text.as_bytes(), name, &options).unwrap();
                let mut found = trajectory.frame(frame).unwrap();
                assert_eq!(found.frames, Some(count));
                let mut opened = load::open(&path, &options).unwrap();
                (found.frames, opened.frames) = (whole.frames, whole.frames);
                assert_eq!((&found, &opened), (&whole, &whole), "{name}, frame {frame}");
                assert!(trajectory.frame_bytes(frame).unwrap() > 0);
            }
            let none = trajectory.frame(count).unwrap_err().to_string();
            assert!(none.starts_with(&format!("there is no frame {count}; the file has {count} frame")), "{none}");
            assert_eq!(trajectory.frame_bytes(count), None);
            let none = load::open(&path, &Options::default().with_frame(count)).unwrap_err();
            assert!(none.to_string().starts_with(&format!("there is no frame {count};")), "{none}");
        }
    }
}

/// Several files are one trajectory, in the order of their numbers.
#[test]
fn files_under_one_name_are_frames() {
    let folder = TempDir::new().unwrap();
    let atoms = |x: f64| format!("1\n\nH {x} 0 0\n");
    for (name, text) in [("a9.xyz", atoms(0.0)), ("a10.xyz", atoms(1.0) + &atoms(2.0)), ("a100.xyz", atoms(3.0))] {
        written(&folder, name, &text);
    }
    let all = folder.path().join("a*.xyz");
    let mut trajectory = Trajectory::open(&all, &Options::default()).unwrap();
    for frame in [3, 0, 2, 1, 2] {
        assert_eq!(trajectory.frame(frame).unwrap().spheres.at(0)[0], frame as f64);
        let opened = load::open(&all, &Options::default().with_frame(frame)).unwrap();
        assert_eq!(opened.spheres.at(0)[0], frame as f64);
        assert!(trajectory.frame_bytes(frame).unwrap() > 0);
    }
    let none = load::open(&all, &Options::default().with_frame(4)).unwrap_err().to_string();
    assert!(none.starts_with("there is no frame 4; the file has 4 frames"), "{none}");
    // The frames end before a fault, whose file is named, but a file that is not there is an error.
    written(&folder, "a20.xyz", "2\n\nH 5 0 0\n");
    let trajectory = Trajectory::open(&all, &Options::default()).unwrap();
    let problem = trajectory.problem().unwrap().to_string();
    assert!(trajectory.len() == 3 && problem.contains("a20.xyz: line 1: "), "{problem}");
    let error = Trajectory::open(folder.path().join("a{9,7}.xyz"), &Options::default()).unwrap_err().to_string();
    assert!(error.contains("a7.xyz: cannot be read"), "{error}");
}

/// The radius of spheres without one is that of the first frame, so that they keep their size.
#[test]
fn spheres_keep_their_size_in_all_frames() {
    let folder = TempDir::new().unwrap();
    let table = |x: f64| format!("x,y,z\n0,0,0\n{x},0,0\n");
    written(&folder, "t0.csv", &table(2.0));
    written(&folder, "t1.csv", &table(3.0));
    let all = folder.path().join("t*.csv");
    let mut trajectory = Trajectory::open(&all, &Options::default()).unwrap();
    for loaded in [trajectory.frame(1), load::open(&all, &Options::default().with_frame(1)), trajectory.frame(0)] {
        let loaded = loaded.unwrap();
        assert_eq!(loaded.spheres.at(1)[3], 1.0);
        assert!(loaded.notes.len() == 1 && loaded.notes[0].contains("the radius 1,"), "{:?}", loaded.notes);
    }
    let alone = load::open(folder.path().join("t1.csv"), &Options::default()).unwrap();
    assert_eq!(alone.spheres.at(1)[3], 1.5);
}

/// Complete frames can be read while a program is still writing.
#[test]
fn a_file_that_ends_within_a_frame_has_those_before_it() {
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "a.xyz", "1\n\nH 0 0 0\n2\n\nH 1 0 0\n");
    let mut trajectory = Trajectory::open(&path, &Options::default()).unwrap();
    assert_eq!(trajectory.len(), 1);
    let problem = trajectory.problem().unwrap().to_string();
    assert_eq!(problem, "line 4: frame 1 declares 2 atoms, but the file ends after 1");
    assert_eq!(trajectory.frame(0).unwrap().spheres.len(), 1);
}

#[test]
fn errors_count_lines_from_the_start_of_the_file() {
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "a.xyz", "1\n\nH 0 0 0\n1\n\nH 0 x 0\n");
    let error = Trajectory::open(&path, &Options::default()).unwrap().frame(1).unwrap_err();
    assert_eq!(error.to_string(), "line 6, column 3: y is `x`, which is not a number");
    let mut text = pdb_text(3, &mut Rng::with_seed(1));
    let at = text.rfind("ATOM").unwrap();
    text.replace_range(at + 30..at + 38, "   x.123");
    let line = text[..at].matches('\n').count() + 1;
    let path = written(&folder, "a.pdb", &text);
    let error = Trajectory::open(&path, &Options::default()).unwrap().frame(2).unwrap_err();
    assert!(error.to_string().starts_with(&format!("line {line}")), "{error}");
}

/// The test `files` makes sure that opened files are refused as files in memory are.
#[test]
fn files_without_frames_are_refused() {
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "a.npy", "");
    let error = Trajectory::open(&path, &Options::default()).unwrap_err().to_string();
    assert_eq!(error, "a file of the format npy has no frames; read it as a whole");
    let error = Trajectory::open(folder.path().join("none.xyz"), &Options::default()).unwrap_err();
    assert!(error.to_string().contains("none.xyz: cannot be read: "), "{error}");
}
