//! Tests of stereo pairs.

use npyz::NpyFile;

use crate::support::{Folder, decode};

const SCENE: &str = "[film]\nwidth = 40\nheight = 30\n\
                     [camera.pinhole]\neye = [0, 0, 5]\ndirection = [0, 0, -1]\n\
                     stereo = { separation = 1, convergence = 5 }\n\
                     [[spheres]]\ncenter = [0, 0, 2]\nradius = 0.4\ncolor = 'red'\n";

/// Width, height, and for every row the columns that are red.
fn red(png: &[u8]) -> (u32, u32, Vec<Vec<usize>>) {
    let (width, height, pixels) = decode(png);
    let rows = pixels.chunks(3 * width as usize).map(|row| {
        let is_red = |pixel: &[u8]| pixel[1] == 0;
        (0..width as usize).filter(|i| is_red(&row[3 * i..3 * i + 3])).collect()
    });
    (width, height, rows.collect())
}

#[test]
fn side_by_side_and_two_files_have_the_same_pictures() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let layers = "--layer depth=depth.npy --layer id=id.npy --backend cpu";
    folder.run(&format!("render scene.toml -o both.png {layers}")).succeeded();
    let two = "--stereo two-files --layer depth=d.npy --layer normal=n.npy --backend cpu";
    folder.run(&format!("render scene.toml -o eye.png {two}")).succeeded();
    assert_eq!(
        folder.files(),
        [
            "both.png",
            "d-left.npy",
            "d-right.npy",
            "depth.npy",
            "eye-left.png",
            "eye-right.png",
            "id.npy",
            "n-left.npy",
            "n-right.npy",
            "scene.toml"
        ]
    );
    let (width, height, both) = red(&folder.read("both.png"));
    assert_eq!((width, height), (80, 30));
    let (_, _, left) = red(&folder.read("eye-left.png"));
    let (_, _, right) = red(&folder.read("eye-right.png"));
    for (both, (left, right)) in both.iter().zip(left.iter().zip(&right)) {
        let joined = left.iter().copied().chain(right.iter().map(|i| i + 40));
        assert_eq!(*both, joined.collect::<Vec<_>>());
    }
    // The sphere is nearer than the screen, so the left eye sees it farther to the right.
    let middle = |rows: &[Vec<usize>]| {
        let all: Vec<usize> = rows.iter().flatten().copied().collect();
        all.iter().sum::<usize>() as f64 / all.len() as f64
    };
    assert!(middle(&left) > middle(&right) + 5.0);

    let array = |name: &str| {
        let bytes = folder.read(name);
        let file = NpyFile::new(&bytes[..]).unwrap();
        (file.shape().to_vec(), file.into_vec::<f32>().unwrap())
    };
    let (shape, depth) = array("depth.npy");
    assert_eq!(shape, [30, 80]);
    let [(_, left), (_, right)] = [array("d-left.npy"), array("d-right.npy")];
    for (row, both) in depth.chunks(80).enumerate() {
        assert_eq!(both[..40], left[row * 40..][..40]);
        assert_eq!(both[40..], right[row * 40..][..40]);
    }
}

#[test]
fn flags_make_two_eyes_as_well() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    folder.run("render scene.toml -o table.png --backend cpu").succeeded();
    let flags = "--eye 0,0,5 --direction 0,0,-1 --separation 1 --convergence 5";
    folder.run(&format!("render scene.toml -o flags.png --backend cpu {flags}")).succeeded();
    assert_eq!(folder.read("table.png"), folder.read("flags.png"));
    let around = "--camera panorama --eye 0,0,5 --direction 0,0,-1 --separation 1";
    folder.run(&format!("render scene.toml -o around.png --backend cpu {around}")).succeeded();
    assert_eq!(decode(&folder.read("around.png")).0, 80);
}

#[test]
fn standard_output_takes_one_picture() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let run = folder.run("render scene.toml -o - --backend cpu").succeeded();
    assert_eq!(decode(&run.stdout).0, 80);
    let run = folder.run("render scene.toml -o - --stereo two-files --backend cpu");
    assert_eq!((run.code, run.stdout.len()), (2, 0));
    let line =
        "error: --stereo two-files: standard output can take only one picture; name a file\n";
    assert_eq!(run.stderr, line);
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_work() {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    std::fs::create_dir(folder.path("eye-left.png")).unwrap();
    let run = folder.run("render scene.toml -o eye.png --stereo two-files --backend cpu");
    assert_eq!((run.code, run.stderr.lines().count()), (2, 1), "{}", run.stderr);
    assert!(run.stderr.contains("eye-left.png: this is a folder"), "{}", run.stderr);
    assert!(!folder.path("eye-right.png").exists());
}
