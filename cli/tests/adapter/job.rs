//! Tests of jobs on an adapter: parts that it renders are merged to the bytes that it writes alone.

use std::fs;

use libtest_mimic::Trial;
use pinhole::gpu::Headless;

use crate::program::{command, command_on, succeed};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("job::merged_bytes_are_those_of_one_machine", same),
        trial("job::a_device_that_hangs_ends_with_a_code_of_its_own", hangs),
        trial("job::noise_is_removed_by_the_device_of_the_parts", denoised),
    ]
}

const SCENE: &str = "[film]\nwidth = 61\nheight = 45\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'red'\n\
                     [[spheres]]\ncenter = [1, 0.5, -1]\nradius = 0.7\n";

/// Renders a scene on the adapter, alone and by parts, and compares all files.
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
        assert!(
            read(format!("m-{layer}.npy")) == read(format!("r-{layer}.npy")),
            "{flags}: {layer}"
        );
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
