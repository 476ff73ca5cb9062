//! Trajectories: one frame at a time is in memory, and is the one that reading the whole file gives.

use std::fmt::Write as _;
use std::path::PathBuf;

use fastrand::Rng;
use pinhole::load::{self, Options, Trajectory};
use tempfile::TempDir;

fn written(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

fn xyz(frames: usize, random: &mut Rng) -> String {
    (0..frames).fold(String::new(), |mut text, frame| {
        let atoms = random.usize(0..5);
        let blank = if random.bool() { "\n  \r\n" } else { "" };
        write!(text, "{blank}{atoms}\r\nframe {frame} {}\n", "x".repeat(random.usize(0..3000)))
            .unwrap();
        for _ in 0..atoms {
            let [x, y, z] = [(); 3].map(|()| random.f64());
            writeln!(text, "{} {x} {y} {z}", if random.bool() { "H" } else { "C" }).unwrap();
        }
        text
    })
}

fn pdb(frames: usize, random: &mut Rng) -> String {
    let mut text = "CRYST1   63.150   83.590   53.800  90.00  99.34  90.00 P 1\n".to_owned();
    for frame in 0..frames {
        writeln!(text, "MODEL     {:4}", frame + 1).unwrap();
        for atom in 0..random.usize(1..5) {
            let [x, y, z] = [(); 3].map(|()| random.f64() * 9.0);
            writeln!(
                text,
                "ATOM  {atom:5}  CA  ALA A{atom:4}    {x:8.3}{y:8.3}{z:8.3}  1.00  0.00           C"
            )
            .unwrap();
        }
        text += "ENDMDL\n";
    }
    text + "END\n"
}

/// Every frame, in any order, is what reading the text as a whole gives; so is a frame that is opened by itself.
#[test]
fn frames_are_those_of_the_whole_text() {
    let folder = TempDir::new().unwrap();
    for seed in 0..20 {
        let mut random = Rng::with_seed(seed);
        let count = random.usize(1..8);
        for (name, text) in [("a.xyz", xyz(count, &mut random)), ("a.pdb", pdb(count, &mut random))]
        {
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
            assert!(
                none.starts_with(&format!("there is no frame {count}; the file has {count} frame")),
                "{none}"
            );
            assert_eq!(trajectory.frame_bytes(count), None);
            let none = load::open(&path, &Options::default().with_frame(count)).unwrap_err();
            assert!(none.to_string().starts_with(&format!("there is no frame {count};")), "{none}");
        }
    }
}

/// A program may still be writing: frames that are complete can be read.
#[test]
fn a_file_that_ends_within_a_frame_has_those_before_it() {
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "a.xyz", "1\n\nH 0 0 0\n2\n\nH 1 0 0\n");
    let mut trajectory = Trajectory::open(&path, &Options::default()).unwrap();
    assert_eq!(trajectory.len(), 1);
    let problem = trajectory.problem().unwrap().to_string();
    assert_eq!(problem, "line 4: frame 1 declares 2 atoms, but the file ends after 1");
    assert_eq!(trajectory.frame(0).unwrap().spheres.len(), 1);
    // A single frame is refused where what follows it is no frame, as a wrong number of atoms shows there.
    for (text, expected) in [
        ("1\n\nH 0 0 0\nH 1 0 0\n", "line 4: `H 1 0 0` is not a valid number of atoms"),
        ("3\n\nH 0 0 0\n", "line 1: frame 0 declares 3 atoms, but the file ends after 1"),
        ("", "the file is empty"),
        ("\u{e9}t\u{e9}\n", "line 1: `\u{e9}t\u{e9}` is not a valid number"),
    ] {
        let path = written(&folder, "b.xyz", text);
        let open = load::open(&path, &Options::default()).unwrap_err().to_string();
        assert!(open.starts_with(expected), "{open}");
        let whole = load::from_bytes(text.as_bytes(), "b.xyz", &Options::default()).unwrap_err();
        assert_eq!(open, whole.to_string());
    }
}

#[test]
fn errors_count_lines_from_the_start_of_the_file() {
    let folder = TempDir::new().unwrap();
    let path = written(&folder, "a.xyz", "1\n\nH 0 0 0\n1\n\nH 0 x 0\n");
    let error = Trajectory::open(&path, &Options::default()).unwrap().frame(1).unwrap_err();
    assert_eq!(error.to_string(), "line 6, column 3: y is `x`, which is not a number");
    let mut text = pdb(3, &mut Rng::with_seed(1));
    let at = text.rfind("ATOM").unwrap();
    text.replace_range(at + 30..at + 38, "   x.123");
    let line = text[..at].matches('\n').count() + 1;
    let path = written(&folder, "a.pdb", &text);
    let error = Trajectory::open(&path, &Options::default()).unwrap().frame(2).unwrap_err();
    assert!(error.to_string().starts_with(&format!("line {line}")), "{error}");
}

#[test]
fn pdb_models_out_of_order_and_other_files_are_refused() {
    let folder = TempDir::new().unwrap();
    let atom = "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  1.00  0.00           C\n";
    for text in [
        format!("MODEL        1\n{atom}MODEL        2\n{atom}ENDMDL\n"),
        format!("MODEL        1\n{atom}ENDMDL\n{atom}MODEL        2\n{atom}ENDMDL\n"),
        format!("{atom}MODEL        1\n{atom}ENDMDL\n"),
        "REMARK nothing\n".to_owned(),
        "data_4HHB\n".to_owned(),
        "MODEL        1\nENDMDL\n".to_owned(),
    ] {
        let path = written(&folder, "a.pdb", &text);
        let opened = load::open(&path, &Options::default()).unwrap_err().to_string();
        let whole = load::from_bytes(text.as_bytes(), "a.pdb", &Options::default()).unwrap_err();
        assert_eq!(opened, whole.to_string());
    }
    let path = written(&folder, "a.npy", "");
    let error = Trajectory::open(&path, &Options::default()).unwrap_err().to_string();
    assert_eq!(error, "a file of the format npy has no frames; read it as a whole");
    let error = Trajectory::open(folder.path().join("none.xyz"), &Options::default()).unwrap_err();
    assert!(error.to_string().contains("none.xyz: cannot be read: "), "{error}");
}
