//! Tests of jobs and of files of bricks on an adapter. Joined parts give the same bytes as rendering without parts.

use std::fs;

use libtest_mimic::Trial;
use pinhole::gpu::Headless;

use crate::trial;
use crate::{command, command_on, succeed};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("bricks::pictures_are_those_of_the_data", pictures_of_bricks),
        trial("bricks::merged_groups_are_the_same_bytes", by_depth),
        trial("job::merged_bytes_are_those_of_one_machine", same),
        trial("job::a_device_that_hangs_ends_with_a_code_of_its_own", hangs),
        trial("job::noise_is_removed_by_the_device_of_the_parts", denoised),
    ]
}

const SCENE: &str = "[film]\nwidth = 61\nheight = 45\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'red'\n\
                     [[spheres]]\ncenter = [1, 0.5, -1]\nradius = 0.7\n";

/// Renders a scene on the adapter, at once and in parts, and compares all files.
fn assert_same(headless: &Headless, scene: &str, flags: &str, layers: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), scene).unwrap();
    let names: String = layers.iter().map(|layer| format!(" --layer {layer}")).collect();
    let outputs = |name: &str| -> String {
        let files = layers.iter().map(|layer| format!(" --layer {layer}={name}-{layer}.npy"));
        format!("-o {name}-p.png -q{}", files.collect::<String>())
    };
    let split = format!("job split a.toml --tiles 3x2 -o job -q{flags}{names}");
    succeed(&mut command_on(headless, &folder, &split));
    succeed(&mut command(&folder, "job part job 3-5 -q"));
    succeed(&mut command(&folder, "job part job 0-5 -q"));
    succeed(&mut command(&folder, &format!("job merge job {}", outputs("m"))));
    succeed(&mut command_on(headless, &folder, &format!("render a.toml {}{flags}", outputs("r"))));
    let read = |name: String| fs::read(folder.path().join(name)).unwrap();
    assert!(read("m-p.png".to_owned()) == read("r-p.png".to_owned()), "{flags}");
    for layer in layers {
        assert!(read(format!("m-{layer}.npy")) == read(format!("r-{layer}.npy")), "{flags}: {layer}");
    }
}

fn same(headless: &'static Headless) {
    let layers = ["depth", "normal", "position", "albedo", "id", "samples", "variance", "alpha"];
    assert_same(headless, SCENE, " --integrator primary", &layers);
    assert_same(headless, SCENE, " --integrator studio --outline 2 --samples 5", &layers);
    assert_same(headless, SCENE, " --integrator path --samples 9 --tone agx", &layers);
}

/// A unit that takes minutes stands for a driver that does not answer.
fn hangs(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), SCENE).unwrap();
    let split = "job split a.toml -o job -q --size 3000x3000 --integrator path --samples 4096";
    succeed(&mut command_on(headless, &folder, split));
    for _ in 0..3 {
        let output = command(&folder, "job part job 0 --timeout 2 -q").output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(5), "{said}");
        let line = "error: unit 0 did not end within 2 s; the device may hang: try again\n";
        assert!(said.ends_with(line), "{said}");
        assert!(fs::read_dir(folder.path().join("job/parts")).unwrap().next().is_none());
    }
}

fn denoised(headless: &'static Headless) {
    let scene = format!("{SCENE}[sampling]\ndenoise = true\nsamples = 6\n");
    assert_same(headless, &scene, " --integrator path", &["variance"]);
    assert_same(headless, &scene, " --integrator studio --outline 2", &["depth"]);
}

const LAYERS: [&str; 7] = ["depth", "normal", "position", "albedo", "id", "alpha", "samples"];

/// Every fifth sphere appears again, so that rays hit equal spheres in several bricks.
fn data(count: usize) -> Vec<u8> {
    let mut rng = fastrand::Rng::with_seed(count as u64);
    let mut all: Vec<[f32; 4]> = Vec::new();
    for index in 0..count {
        let new = [70.0 + rng.f32(), rng.f32(), rng.f32(), 0.01 + 0.02 * rng.f32()];
        all.push(if index % 5 == 4 { all[rng.usize(..index)] } else { new });
    }
    all.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn pictures_of_bricks(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    for (count, bricks) in [(4000, 9), (3000, 70), (12, 5)] {
        fs::write(folder.path().join("a.bin"), data(count)).unwrap();
        let sort = format!("sort a.bin --format raw-f32x4 -o a.bricks -q --bricks {bricks}");
        succeed(&mut command(&folder, &sort));
        for flags in [
            "--style fast --size 123x77",
            "--style fast --size 64x64 --view 5,70",
            "--style fast --size 90x60 --camera orthographic --view iso",
            "--style fast --size 60x40 --eye 70.5,0.5,0.5 --look-at 71,1,1 --accel tree",
            "--style fast --size 60x40 --camera fisheye",
        ] {
            let render = |input: &str, out: &str| {
                let layers = LAYERS.map(|layer| format!("--layer {layer}={out}-{layer}.npy"));
                let layers = layers.join(" ");
                let arguments = format!("render {input} -o {out}.png -q {layers} {flags}");
                succeed(&mut command_on(headless, &folder, &arguments));
            };
            render("a.bin --format raw-f32x4", "whole");
            render("a.bricks", "parts");
            let names = LAYERS.map(|layer| format!("-{layer}.npy"));
            for name in names.iter().map(String::as_str).chain([".png"]) {
                let read = |out: &str| fs::read(folder.path().join(format!("{out}{name}"))).unwrap();
                assert!(read("whole") == read("parts"), "{count} in {bricks}, {flags}: {name}");
            }
        }
    }
    succeed(&mut command_on(headless, &folder, "plan a.bricks --style fast"));
    // The picture has more pixels than one buffer has hits.
    for (input, out) in [("a.bin --format raw-f32x4", "whole"), ("a.bricks", "parts")] {
        let arguments = format!("render {input} -o {out}.png -q --style fast --size 2300x2000");
        succeed(&mut command_on(headless, &folder, &arguments));
    }
    let read = |out: &str| fs::read(folder.path().join(format!("{out}.png"))).unwrap();
    assert!(read("whole") == read("parts"), "in tiles");
}

fn by_depth(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.bin"), data(5000)).unwrap();
    let sort = "sort a.bin --format raw-f32x4 -o a.bricks -q --bricks 11";
    succeed(&mut command(&folder, sort));
    let flags = "--style fast --size 123x77 -q --layer id";
    let split = format!("job split a.bricks --by-depth 4 -o job {flags} --layer normal");
    succeed(&mut command_on(headless, &folder, &split));
    succeed(&mut command(&folder, "job part job 2-3 -q"));
    succeed(&mut command(&folder, "job part job 0-1 -q"));
    let outputs = |out: &str| format!("-o {out}.png --layer id={out}-id.npy --layer normal={out}-n.npy -q");
    succeed(&mut command(&folder, &format!("job merge job {}", outputs("merged"))));
    let render = format!("render a.bin --format raw-f32x4 --style fast --size 123x77 {}", outputs("whole"));
    succeed(&mut command_on(headless, &folder, &render));
    for name in [".png", "-id.npy", "-n.npy"] {
        let read = |out: &str| fs::read(folder.path().join(format!("{out}{name}"))).unwrap();
        assert!(read("whole") == read("merged"), "{name}");
    }
}
