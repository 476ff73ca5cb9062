//! Tests of lit pictures on an adapter: stop rules, signals and plans.

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use libtest_mimic::Trial;
use pinhole::gpu::Headless;
use tempfile::TempDir;

use crate::{command_on, succeed};
use crate::{trial, trial_of_signals};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("light::noise_decides_how_many_samples_there_are", noise),
        trial("light::a_time_gives_at_least_one_sample", time),
        trial_of_signals("light::a_signal_keeps_the_partial_picture_if_asked", signal),
        trial("light::a_plan_includes_the_buffers_of_light", plan),
        trial("light::shadows_follow_the_choice_of_structure", shadows),
    ]
}

const SCENE: &str = "[film]\nwidth = 64\nheight = 48\n[camera.pinhole]\neye = [0, 1, 6]\nlook_at = [0, 0, 0]\n\
                     [ground]\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'tomato'\n";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

/// Runs the program and returns its standard error.
#[track_caller]
fn run(folder: &Path, headless: &Headless, arguments: &str) -> String {
    let output = succeed(&mut command_on(headless, folder, arguments));
    String::from_utf8(output.stderr).unwrap()
}

/// Reads the number of samples, which is the same in all pixels.
fn samples(folder: &Path) -> u32 {
    let bytes = std::fs::read(folder.join("s.npy")).unwrap();
    let samples: Vec<u32> = npyz::NpyFile::new(&bytes[..]).unwrap().into_vec().unwrap();
    assert!(samples.iter().all(|count| *count == samples[0]));
    samples[0]
}

fn noise(headless: &'static Headless) {
    let folder = folder();
    let render = |flags: &str| {
        let flags = format!("render scene.toml -o out.png --quiet --layer samples=s.npy {flags}");
        let said = run(folder.path(), headless, &flags);
        (samples(folder.path()), said)
    };
    let path = "--integrator path";
    let (few, said) = render(&format!("{path} --noise 0.05"));
    assert!(few >= 16 && said.is_empty(), "{few}: {said}");
    let (more, _) = render(&format!("{path} --noise 0.02"));
    assert!(more > few, "{more} after {few}");
    assert_eq!(render(&format!("{path} --noise 0.05")).0, few);
    let (most, said) = render(&format!("{path} --noise 1e-9 --samples 20"));
    assert_eq!(most, 20);
    assert!(
        said.starts_with("note: the noise is 0.") && said.contains("after 20 samples"),
        "{said}"
    );
}

fn time(headless: &'static Headless) {
    let folder = folder();
    let flags = "render scene.toml -o out.png --layer samples=s.npy --time";
    for (time, most) in [("0.001s --keep-partial", u32::MAX), ("1h --samples 3", 3)] {
        run(folder.path(), headless, &format!("{flags} {time}"));
        assert!((1..=most).contains(&samples(folder.path())), "{time}");
    }
    // This time is too short for a sample in every pixel.
    std::fs::remove_file(folder.path().join("out.png")).unwrap();
    let flags = "render scene.toml -o out.png --integrator path --size 4000x3000 --time 0.02s";
    let output = command_on(headless, folder.path(), flags).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    let words = "nothing was written; give more time or a smaller --size, or wait for it with --keep-partial\n";
    assert!(said.starts_with("error: --time: after 0.020 s ") && said.ends_with(words), "{said}");
    assert!(!folder.path().join("out.png").exists());
}

fn interrupted(folder: &Path, headless: &Headless, flags: &str, after: Duration) -> Output {
    let flags = format!("render scene.toml -o out.png --quiet --layer samples=s.npy {flags}");
    let mut command = command_on(headless, folder, &flags);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(after);
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    child.wait_with_output().unwrap()
}

fn signal(headless: &'static Headless) {
    let folder = folder();
    let endless = "--integrator path --size 320x240 --samples 10000000";
    let output = interrupted(folder.path(), headless, endless, Duration::from_secs(1));
    assert_eq!(output.status.code(), Some(130));
    assert!(!folder.path().join("out.png").exists());
    // Nothing can be kept before the device is open, so later signals are tried until a picture is written.
    for seconds in [1, 2, 4, 8, 16, 32] {
        let flags = format!("{endless} --keep-partial");
        let output = interrupted(folder.path(), headless, &flags, Duration::from_secs(seconds));
        let said = String::from_utf8(output.stderr).unwrap();
        if output.status.code() == Some(0) {
            let count = samples(folder.path());
            // Before every pixel has a sample, the program says that it goes on until then.
            let last = format!("stopped; the picture has {count} samples per pixel");
            assert_eq!(said.lines().last(), Some(&*last), "{said}");
            assert!((1..10_000_000).contains(&count));
            assert!(image::open(folder.path().join("out.png")).is_ok());
            return;
        }
        assert_eq!(output.status.code(), Some(130), "{said}");
        assert!(!folder.path().join("out.png").exists());
    }
    panic!("whenever it is stopped, nothing is kept");
}

fn plan(headless: &'static Headless) {
    let folder = folder();
    let plan = |flags: &str| {
        let flags = format!("plan scene.toml --json {flags}");
        let output = succeed(&mut command_on(headless, &folder, &flags));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let paths =
            report["buffers"].as_array().unwrap().iter().find(|buffer| buffer["name"] == "paths");
        paths.map(|paths| paths["bytes"].as_u64().unwrap())
    };
    // The scene has a ground, so it is lit.
    let state = plan("--size 64x48");
    assert!(state.is_some_and(|bytes| bytes > 0 && bytes % (16 * 64 * 48) == 0), "{state:?}");
    std::fs::write(folder.path().join("scene.toml"), SCENE.replace("[ground]\n", "")).unwrap();
    assert_eq!(plan("--size 64x48"), None);
    // The state of a path has nine vectors, and that of a studio sample ten.
    let path = plan("--size 64x48 --integrator path");
    assert_eq!(path, state.map(|bytes| bytes / 10 * 9));
}

/// Every second of 80 spheres casts no shadow in a studio.
fn shadows(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    let mut scene =
        "[studio]\n[sampling]\nsamples = 2\n[film]\nwidth = 16\nheight = 12\n".to_owned();
    for i in 0..80 {
        let (x, y, opacity) = (i % 10, i / 10, 1.0 - 0.5 * f64::from(i % 2));
        scene +=
            &format!("[[spheres]]\ncenter = [{x}, {y}, 0]\nradius = 0.4\nopacity = {opacity}\n");
    }
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let counts = |flags: &str| {
        let flags = format!("plan scene.toml --json {flags}");
        let output = command_on(headless, &folder, &flags).output().unwrap();
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let names: Vec<_> = report["buffers"]
            .as_array()
            .unwrap()
            .iter()
            .map(|buffer| buffer["name"].clone())
            .collect();
        ["nodes", "cells"]
            .map(|name| names.iter().filter(|found| found.as_str().unwrap().contains(name)).count())
    };
    assert_eq!(counts("--accel tree"), [2, 0]);
    assert_eq!(counts("--accel grid"), [0, 2]);
    assert_eq!(counts("--accel tree --integrator path"), [1, 0]);
    assert_eq!(counts("--accel tree --integrator primary"), [1, 0]);
    let pictures = ["tree", "grid", "list"].map(|accel| {
        run(folder.path(), headless, &format!("render scene.toml -o out.png --accel {accel}"));
        std::fs::read(folder.path().join("out.png")).unwrap()
    });
    assert!(pictures.iter().all(|picture| *picture == pictures[0]));
}
