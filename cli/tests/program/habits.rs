//! Tests of what people type who know other programs.

use crate::support::{Folder, WATER, decode};

const SMALL: &str = "--size 24x16 --backend cpu --style fast";

/// A file of one atom in each frame.
const MOVING: &str = "1\n\nO 0 0 0\n1\n\nO 2 0 0\n2\n\nO 0 0 0\nH 4 0 0\n";

const PDB: &str = "ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  5.00           C\n\
                   ATOM      2  N   ALA B   2       4.000   0.000   0.000  1.00  9.00           N\n";

fn folder() -> Folder {
    Folder::with(&[("water.xyz", WATER), ("moving.xyz", MOVING), ("a.b.pdb", PDB)])
}

/// The RGB bytes of a picture.
#[track_caller]
fn picture(folder: &Folder, arguments: &str) -> Vec<u8> {
    let run = folder.run(&format!("{arguments} -o - {SMALL}")).succeeded();
    assert_eq!(run.stderr, "", "{arguments}");
    decode(&run.stdout).2
}

#[test]
fn a_file_alone_makes_a_picture_with_its_name() {
    let folder = folder();
    let run = folder.run(&format!("a.b.pdb {SMALL}")).succeeded();
    assert_eq!(run.stderr.lines().last(), Some("wrote a.b.png"), "{}", run.stderr);
    assert_eq!(decode(&folder.read("a.b.png")).2, picture(&folder, "render a.b.pdb"));
    folder.refuses("a.b.pdb", 2, "a.b.png: this file exists; add -o a.b.png to replace it, or -o OTHER.png");
    assert_eq!(folder.run(&format!("a.b.pdb -o a.b.png {SMALL} -q")).succeeded().stderr, "");
    folder.refuses("gone.pdb", 1, "gone.pdb: cannot be read");
}

#[test]
fn frames_are_counted_from_the_end() {
    let folder = folder();
    let all = [0, 1, 2].map(|frame| picture(&folder, &format!("moving.xyz --frame {frame}")));
    assert!(all[2] != all[0]);
    for (frame, index) in [("last", 2), ("-1", 2), ("-3", 0)] {
        assert_eq!(picture(&folder, &format!("moving.xyz --frame {frame}")), all[index], "{frame}");
    }
    folder.run(&format!("moving.xyz --every 2 -o f%d.png -q {SMALL}")).succeeded();
    assert_eq!(folder.files(), ["a.b.pdb", "f0.png", "f2.png", "moving.xyz", "water.xyz"]);
}

#[test]
fn atoms_have_one_color_and_one_radius_if_asked_for() {
    let folder = folder();
    for file in ["water.xyz", "a.b.pdb"] {
        let (plain, red) = (picture(&folder, file), picture(&folder, &format!("{file} --color red")));
        assert!(red.chunks(3).all(|rgb| rgb[1] == rgb[2] || rgb[0] == 0), "{file}");
        assert!(plain != red, "{file}");
        let large = picture(&folder, &format!("{file} --radius 0.2"));
        assert_eq!(picture(&folder, &format!("{file} --radius 0.1 --scale 2")), large, "{file}");
        assert!(plain != large, "{file}");
    }
    let run = folder.run("info a.b.pdb --radius 0.25").succeeded();
    assert!(String::from_utf8_lossy(&run.stdout).contains("0.25"), "{run:?}");
    let clear = picture(&folder, "water.xyz --opacity 0.3 --integrator studio --ao 1 --samples 1");
    assert!(clear != picture(&folder, "water.xyz --integrator studio --ao 1 --samples 1"));
    assert_eq!(picture(&folder, "a.b.pdb --color chain"), picture(&folder, "a.b.pdb --color-by chain"));
}

#[test]
fn sides_and_planes_are_views() {
    let folder = folder();
    for (name, view) in [("top", "0,90"), ("front", "0,0"), ("xy", "z"), ("xz", "-y"), ("yz", "x")] {
        let of = |view: &str| picture(&folder, &format!("water.xyz --ortho --view {view}"));
        assert_eq!(of(name), of(view), "{name}");
    }
}
