//! Tests of files of bricks. Pictures have the same bytes as those of the data, and damaged files are not used.

use crate::npy_files::npy;
use crate::support::{Folder, Run};

/// Spheres for rays that hit several at one distance: some are equal, and some lie around others.
pub(crate) fn spheres(count: usize, origin: [f64; 3]) -> Vec<[f64; 4]> {
    let mut random = fastrand::Rng::with_seed(count as u64);
    let mut all: Vec<[f64; 4]> = Vec::new();
    for index in 0..count {
        let sphere = match index % 5 {
            0 if index > 0 => all[random.usize(..index)],
            _ => {
                let [x, y, z] = origin.map(|origin| origin + random.f64());
                [x, y, z, 0.01 + 0.02 * random.f64()]
            }
        };
        all.push(sphere);
    }
    all
}

pub(crate) fn f32_array(spheres: &[[f64; 4]]) -> Vec<u8> {
    let bytes = spheres.as_flattened().iter().flat_map(|x| (*x as f32).to_le_bytes());
    npy("<f4", false, &format!("({}, 4)", spheres.len()), &bytes.collect::<Vec<_>>())
}

fn f64_array(spheres: &[[f64; 4]]) -> Vec<u8> {
    let bytes = spheres.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    npy("<f8", false, &format!("({}, 4)", spheres.len()), &bytes.collect::<Vec<_>>())
}

/// A folder with data, and the same data sorted into bricks.
fn sorted(name: &str, data: &[u8], flags: &str) -> Folder {
    let folder = Folder::new();
    std::fs::write(folder.path(name), data).unwrap();
    let run = folder.run(&format!("sort {name} -o a.bricks -q {flags}")).succeeded();
    assert_eq!(run.stderr, "");
    folder
}

/// Compares pictures with all layers.
#[track_caller]
fn assert_same(folder: &Folder, name: &str, flags: &str) {
    let layers = ["depth", "normal", "position", "albedo", "id", "alpha", "samples"];
    let render = |input: &str, out: &str| {
        let layers = layers.map(|layer| format!("--layer {layer}={out}-{layer}.npy")).join(" ");
        let run = folder.run(&format!("render {input} -o {out}.png {layers} --backend cpu {flags}"));
        let run = run.succeeded();
        assert_eq!(run.stderr, "", "{flags}");
        run.said.unwrap()
    };
    let said = [render(&format!("{name} --kind plain"), "whole"), render("a.bricks", "parts")];
    let spheres = |said: &str| said.split(": ").nth(1).unwrap().split(';').next().unwrap().to_owned();
    assert_eq!(spheres(&said[0]), spheres(&said[1]));
    for file in layers.map(|layer| format!("-{layer}.npy")).iter().chain([&".png".to_owned()]) {
        let [whole, parts] = ["whole", "parts"].map(|name| folder.read(&format!("{name}{file}")));
        assert!(whole == parts, "{flags}: {file} differs");
    }
}

#[test]
fn pictures_of_bricks_are_those_of_the_data() {
    let near = spheres(3000, [-0.5; 3]);
    // The frame is far from the world's origin, so offsets were rounded from f64.
    let far = spheres(2000, [3e5, -7.25, 1e4]);
    for (data, bricks) in [(f32_array(&near), 7), (f64_array(&far), 13), (f32_array(&far), 64)] {
        let folder = sorted("a.npy", &data, &format!("--bricks {bricks}"));
        for flags in [
            "--style fast --size 61x47",
            "--style fast --size 50x40 --view 10,80 --margin 0.01",
            "--style fast --size 40x30 --camera orthographic --view iso",
            "--style fast --size 48x40 --camera panorama",
        ] {
            assert_same(&folder, "a.npy", flags);
        }
    }
}

#[test]
fn other_formats_keep_their_colors_and_their_axes() {
    let water = "3\nwater\nO 0 0 0.1\nH 0.76 0 -0.5\nH -0.76 0 -0.5\n";
    let folder = sorted("a.xyz", water.as_bytes(), "--bricks 3");
    assert_same(&folder, "a.xyz", "--style fast --size 40x30");
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
               property float radius\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n\
               0 0 0 1 255 0 0\n2 0 1 0.5 0 9 77\n0 2 0 0.7 4 5 6\n";
    let folder = sorted("a.ply", ply.as_bytes(), "--brick-bytes 24");
    assert_same(&folder, "a.ply", "--style fast --size 40x30");
    let dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 4\n\
                ITEM: ATOMS id x y z radius\n1 1 1 1 0.5\n2 2 3 1 0.25\n3 2 3 3 0.5\n";
    let folder = sorted("a.dump", dump.as_bytes(), "--bricks 2");
    assert_same(&folder, "a.dump", "--style fast --size 40x30");
    // Without a style, bricks have one ray for each pixel.
    folder.run("render a.bricks -o fast.png --size 40x30 --backend cpu").succeeded();
    assert_eq!(folder.read("fast.png"), folder.read("whole.png"));
}

#[test]
fn few_spheres_make_few_bricks_and_a_color_may_be_chosen() {
    let folder = sorted("a.npy", &f32_array(&spheres(2, [0.0; 3])), "--bricks 40");
    assert_same(&folder, "a.npy", "--style fast --size 20x20 --color teal");
    let run = folder.run("info a.bricks --json").succeeded();
    let report: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!((&report["spheres"], &report["bricks"]), (&2.into(), &2.into()));
    let rows: Vec<u8> = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0_f32].map(f32::to_le_bytes).concat();
    let folder = sorted("a.npy", &npy("<f4", false, "(2, 3)", &rows), "--radius 0.1");
    let render = |input: &str, out: &str| {
        folder.run(&format!("render {input} -o {out} --style fast --backend cpu --size 30x20")).succeeded();
        folder.read(out)
    };
    assert_eq!(render("a.npy --radius 0.1", "a.png"), render("a.bricks", "b.png"));
    assert!(folder.run("info a.bricks").succeeded().stdout.starts_with(b"file: a.bricks\nformat: bricks"));
}

/// Checks for this exit code, one line with these words, and no file.
#[track_caller]
fn assert_refused(folder: &Folder, run: &Run, code: i32, says: &str) {
    run.refused(code, says);
    let is_new = |name: &String| ["out.png", "out.bricks", "job"].contains(&name.as_str());
    assert!(!folder.files().iter().any(is_new));
}

#[test]
fn data_that_are_wrong_are_named_with_their_sphere() {
    for (index, sphere, says) in [
        (7, [0.0, f64::NAN, 0.0, 1.0], "sphere 7: its center"),
        (49, [0.0, 0.0, 0.0, -1.0], "sphere 49: its radius is -1"),
        (0, [0.0, 0.0, 0.0, f64::NAN], "sphere 0: its radius is NaN"),
        (3, [1e300, 0.0, 0.0, 1.0], "sphere 3: its center"),
    ] {
        let mut all = spheres(50, [0.0; 3]);
        all[index] = sphere;
        let folder = Folder::new();
        std::fs::write(folder.path("a.npy"), f64_array(&all)).unwrap();
        assert_refused(&folder, &folder.run("sort a.npy -o out.bricks"), 1, says);
    }
    let folder = Folder::new();
    std::fs::write(folder.path("a.npy"), f32_array(&[])).unwrap();
    assert_refused(&folder, &folder.run("sort a.npy -o out.bricks"), 1, "has no spheres");
    let mut cut = f32_array(&spheres(9, [0.0; 3]));
    cut.pop();
    std::fs::write(folder.path("a.npy"), cut).unwrap();
    assert_refused(&folder, &folder.run("sort a.npy -o out.bricks"), 1, "cut off");
    assert_refused(&folder, &folder.run("sort no.npy -o out.bricks"), 1, "no.npy");
}

#[test]
fn no_changed_file_of_bricks_is_used() {
    let folder = sorted("a.npy", &f32_array(&spheres(60, [0.0; 3])), "--bricks 3");
    let good = folder.read("a.bricks");
    let render = |bytes: &[u8]| {
        std::fs::write(folder.path("b.bricks"), bytes).unwrap();
        folder.run("render b.bricks -o out.png --backend cpu --size 9x9")
    };
    // Bricks that are not visible are not read, so only changes in others must be noticed.
    for place in (0..good.len()).step_by(37).chain([good.len() - 1]) {
        let mut bytes = good.clone();
        bytes[place] ^= 4;
        let run = render(&bytes);
        if run.code == 0 {
            std::fs::remove_file(folder.path("out.png")).unwrap();
            let brick = (40..good.len() - 1).contains(&place);
            assert!(brick, "byte {place} of {}", good.len());
            continue;
        }
        assert_refused(&folder, &run, 1, "b.bricks: this ");
    }
    for length in (0..good.len()).step_by(131) {
        assert_refused(&folder, &render(&good[..length]), 1, "b.bricks: this ");
    }
    let mut longer = good.clone();
    longer.push(0);
    assert_refused(&folder, &render(&longer), 1, "damaged or cut off");
    assert_refused(&folder, &render(b"x,y,z\n1,2,3\n"), 1, "this is not a file of bricks");
    let other = [b"pinhole bricks 1\n", &good[17..]].concat();
    assert_refused(&folder, &render(&other), 1, "of another version of its format");
    assert_refused(&folder, &folder.run("render c.bricks -o out.png"), 1, "c.bricks");
}

/// A header with a valid digest, but with false contents.
#[test]
fn a_table_that_lies_is_refused() {
    let folder = sorted("a.npy", &f32_array(&spheres(60, [0.0; 3])), "--bricks 3");
    let good = folder.read("a.bricks");
    let word = |at: usize| u64::from_le_bytes(good[at..at + 8].try_into().unwrap()) as usize;
    let (place, length) = (word(24), word(32));
    let header: serde_json::Value = serde_json::from_slice(&good[place..place + length]).unwrap();
    let render = |header: &serde_json::Value| {
        use sha2::{Digest, Sha256};
        let text = serde_json::to_vec(header).unwrap();
        let mut bytes = good[..place].to_vec();
        bytes[32..40].copy_from_slice(&(text.len() as u64).to_le_bytes());
        let digest = Sha256::new().chain_update(&bytes[..40]).chain_update(&text).finalize();
        bytes.extend(text);
        bytes.extend_from_slice(&digest);
        std::fs::write(folder.path("b.bricks"), bytes).unwrap();
        folder.run("render b.bricks -o out.png --backend cpu --size 9x9")
    };
    assert_eq!(render(&header).code, 0);
    std::fs::remove_file(folder.path("out.png")).unwrap();
    type Lie = fn(&mut serde_json::Value);
    let lies: [Lie; 9] = [
        // Bricks overlap, leave a gap, or have too many spheres.
        |header| header["bricks"][1]["section"]["offset"] = 40.into(),
        |header| header["bricks"][0]["section"]["count"] = 21.into(),
        |header| header["bricks"][2]["section"]["count"] = u64::MAX.into(),
        |header| header["bricks"] = serde_json::json!([]),
        |header| header["whole"]["count"] = 61.into(),
        |header| header["whole"]["bounds"][0][0] = f64::NAN.to_bits().into(),
        |header| header["whole"]["spheres"][1][2] = f32::to_bits(0.5).into(),
        |header| header["bricks"][0]["min"][0] = f32::to_bits(-7.0).into(),
        |header| header["more"] = 1.into(),
    ];
    for (number, lie) in lies.into_iter().enumerate() {
        let mut header = header.clone();
        lie(&mut header);
        let run = render(&header);
        assert!(run.code == 1, "{number}: {}", run.stderr);
        assert_refused(&folder, &run, 1, "b.bricks: this file of bricks is damaged");
    }
    let mut other = header;
    other["version"] = "0.0.1".into();
    assert_refused(&folder, &render(&other), 1, "this file is of pinhole 0.0.1");
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_no_file_of_bricks() {
    let folder = Folder::new();
    std::fs::write(folder.path("a.npy"), f32_array(&spheres(20_000, [0.0; 3]))).unwrap();
    for blocks in [0, 1, 40, 400] {
        let run = folder.run_with_blocks(blocks, "sort a.npy -o out.bricks");
        run.refused(1, "out.bricks: cannot be written");
        assert_eq!(folder.files(), ["a.npy"]);
    }
}
