//! Tests of `pinhole generate`.

use crate::support::Folder;

#[test]
fn files_are_the_same_each_time_and_can_be_rendered() {
    let folder = Folder::new();
    for kind in ["random", "lattice", "clusters", "sphereflake"] {
        let run = folder.run(&format!("generate {kind} -n 30 -o a.npy --seed 3")).succeeded();
        assert_eq!(run.stderr, "a.npy: 30 spheres, 480 bytes\n");
        folder.run(&format!("generate {kind} -n 30 -o b.npy --seed 3")).succeeded();
        folder.run(&format!("generate {kind} -n 30 -o c.bin --seed 3")).succeeded();
        let file = folder.read("a.npy");
        assert_eq!(file, folder.read("b.npy"));
        let raw = folder.read("c.bin");
        assert_eq!(raw.len(), 480);
        assert!(file.ends_with(&raw));
        let view = "-o a.png --size 9x9 --backend cpu";
        folder.run(&format!("render a.npy {view}")).succeeded();
        let picture = folder.read("a.png");
        folder.run(&format!("render c.bin --format raw-f32x4 {view}")).succeeded();
        assert_eq!(picture, folder.read("a.png"));
    }
    folder.run("generate random -n 0 -o none.npy").succeeded();
    folder.run("render none.npy -o none.png --size 2x2 --backend cpu").succeeded();
    assert_eq!(folder.files(), ["a.npy", "a.png", "b.npy", "c.bin", "none.npy", "none.png"]);
}

#[test]
fn refused_jobs_leave_no_file() {
    let folder = Folder::new();
    for (arguments, words) in [
        ("random -n 4294967295 -o a.npy", "-n 4294967295: 4294967295 spheres are too many"),
        ("random -n 10 -o a.txt", "a.txt: spheres are written as .npy or .bin"),
        ("random -n 10 -o no/a.npy", "the folder no does not exist"),
        ("random -n ten -o a.npy", "ten"),
        ("random -n=-1 -o a.npy", "-1"),
        ("spiral -n 10 -o a.npy", "sphereflake"),
        ("random -o a.npy", "-n"),
        ("random -n 10", "--output"),
        ("random -n 10 -o a.npy --seed x", "--seed"),
    ] {
        let run = folder.run(&format!("generate {arguments}"));
        assert_eq!(run.code, 2, "{arguments}: {}", run.stderr);
        assert_eq!(run.stderr.lines().count(), 1, "{arguments}: {}", run.stderr);
        assert!(run.stderr.contains(words), "{arguments}: {}", run.stderr);
        assert!(folder.files().is_empty(), "{arguments}");
    }
}
