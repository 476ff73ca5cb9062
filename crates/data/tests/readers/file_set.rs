//! Tests of names that stand for several files.

use std::path::PathBuf;

use pinhole_data::load::FileSet;
use tempfile::{TempDir, tempdir};

fn folder(names: &[&str]) -> TempDir {
    let folder = tempdir().unwrap();
    names.iter().for_each(|name| std::fs::write(folder.path().join(name), "").unwrap());
    folder
}

fn names(set: &FileSet) -> Vec<&str> {
    set.files().iter().map(|file| file.file_name().unwrap().to_str().unwrap()).collect()
}

#[test]
fn a_star_stands_for_numbers_in_their_order() {
    let all = ["dump.1000", "dump.0", "dump.90", "dump.old", "dump.", "dumps.5", "a{1}.xyz", "a1.xyz"];
    let folder = folder(&all);
    let of = |name: &str| FileSet::of(&folder.path().join(name));
    assert_eq!(names(&of("dump.*").unwrap().unwrap()), ["dump.0", "dump.90", "dump.1000"]);
    assert_eq!(names(&of("dump.{90,0}").unwrap().unwrap()), ["dump.90", "dump.0"]);
    for one in ["dump.0", "a{1}.xyz", "a{}.xyz", "a}1{.xyz", "*.*", "none.xyz"] {
        assert_eq!(of(one).unwrap(), None, "{one}");
    }
    assert!(of("b*").unwrap_err().to_string().contains("a number in the place of the *"));
    assert!(FileSet::of(&folder.path().join("none/a*")).is_err());
}

#[test]
fn files_that_differ_in_a_number_have_a_name() {
    let folder = folder(&["f9.xyz", "f10.xyz", "f100.xyz", "g1.xyz", "g1.gro", "h1a1", "h2a2", "i01", "i1"]);
    let name = |files: &[&str]| {
        let paths: Vec<PathBuf> = files.iter().map(|name| folder.path().join(name)).collect();
        FileSet::name_of(&paths).map(|path| path.file_name().unwrap().to_str().unwrap().to_owned())
    };
    assert_eq!(name(&["f9.xyz", "f100.xyz", "f10.xyz"]).as_deref(), Some("f*.xyz"));
    assert_eq!(name(&["f100.xyz", "f10.xyz"]).as_deref(), Some("f{10,100}.xyz"));
    assert_eq!(name(&["i01", "i1"]).as_deref(), Some("i*"));
    for none in [&["f9.xyz"][..], &["f9.xyz", "f9.xyz"], &["g1.xyz", "g1.gro"], &["h1a1", "h2a2"], &[]] {
        assert_eq!(name(none), None, "{none:?}");
    }
}
