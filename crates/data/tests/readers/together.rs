//! Tests of files that are put together.

use std::path::PathBuf;

use pinhole_data::load::{self, ColumnValues, FileSet, Options, Trajectory};
use tempfile::tempdir;

const WATER: &str =
    "3\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3:q:R:1\nO 0 0 0 -2\nH 1 0 0 1\nH 0 1 0 1\n";
const ETHANE: &str = "two\n  x\n\n  2  1  0  0  0  0  0  0  0  0999 V2000\n    0.0000    0.0000    5.0000 C   0  0\n    1.5000    0.0000    5.0000 C   0  0\n  1  2  1  0\nM  END\n$$$$\n";
const POINTS: &str = "x,y,z,radius,q\n1,2,3,0.5,big\n";

#[test]
fn files_of_different_formats_are_one_dataset() {
    let folder = tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for (name, text) in [("a.xyz", WATER), ("b.sdf", ETHANE), ("c.csv", POINTS)] {
        std::fs::write(path(name), text).unwrap();
    }
    let name = FileSet::name_together(&["a.xyz", "b.sdf", "c.csv"].map(path)).unwrap();
    assert!(!FileSet::of(&name).unwrap().unwrap().are_frames());
    assert_eq!(FileSet::of(&path("{a.xyz,b.sdf,c.csv}")).unwrap(), FileSet::of(&name).unwrap());
    let all = load::open(&name, &Options::default()).unwrap();
    let centers: Vec<f64> = (0..6).map(|index| all.spheres.at(index)[2]).collect();
    assert_eq!(centers, [0.0, 0.0, 0.0, 5.0, 5.0, 3.0]);
    assert_eq!(all.bonds, [[3, 4]]);
    assert_eq!((all.cell.map(|cell| cell[0][0]), all.has_all_bonds, all.frames), (Some(9.0), false, Some(1)));
    let texts = |name: &str| {
        let labels = all.labels(name).unwrap();
        labels.indices.iter().map(|index| labels.names[*index as usize].as_str()).collect::<Vec<_>>()
    };
    assert_eq!(texts("file"), ["a.xyz", "a.xyz", "a.xyz", "b.sdf", "b.sdf", "c.csv"]);
    assert_eq!(texts("species"), ["O", "H", "H", "C", "C", ""]);
    assert_eq!(texts("q"), ["-2", "1", "1", "", "", "big"]);
    let colors = all.colors.unwrap();
    assert_eq!(colors.len(), 6);
    assert!(colors[1] == colors[2] && colors[5] != colors[4]);
    // A movie of them has a picture of each.
    let mut frames = Trajectory::open(&name, &Options::default()).unwrap();
    let counts: Vec<usize> = (0..frames.len()).map(|frame| frames.frame(frame).unwrap().spheres.len()).collect();
    assert_eq!(counts, [3, 2, 1]);
}

#[test]
fn cells_that_differ_and_numbers_that_lack() {
    let folder = tempdir().unwrap();
    let other = WATER.replace("9 0 0", "8 0 0");
    for (name, text) in [("a.xyz", WATER), ("b.xyz", &other), ("c.csv", "x,y,z,radius\n0,0,0,1\n")] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let open = |name: &str| load::open(folder.path().join(name), &Options::default()).unwrap();
    let two = open("{a,b}.xyz");
    assert_eq!(two.cell, None);
    assert_eq!(two.notes, ["the files have different cells, of which none is drawn"]);
    let some = open("{a.xyz,c.csv}");
    let Some(ColumnValues::Numbers(charges)) = some.column("q") else { panic!("{:?}", some.columns) };
    assert_eq!(charges[..3], [-2.0, 1.0, 1.0]);
    assert!(charges[3].is_nan());
}

#[test]
fn errors_name_the_file() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("a.xyz"), WATER).unwrap();
    std::fs::write(folder.path().join("b.sdf"), "two\n").unwrap();
    for (name, part) in [("{a.xyz,b.sdf}", "b.sdf: "), ("{a.xyz,none.pdb}", "none.pdb")] {
        let error = load::open(folder.path().join(name), &Options::default()).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
    for names in [&["a,b.xyz", "c.xyz"][..], &["a{.xyz", "c.xyz"], &["a.xyz"]] {
        let paths: Vec<PathBuf> = names.iter().map(PathBuf::from).collect();
        assert_eq!(FileSet::name_together(&paths), None, "{names:?}");
    }
}
