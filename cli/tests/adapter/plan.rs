//! Tests of plans, measurements and signals on an adapter.

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use libtest_mimic::Trial;
use pinhole::gpu::Headless;
use tempfile::TempDir;

use crate::{command, command_on, succeed};
use crate::{trial, trial_of_signals};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("plan::it_is_printed_for_people_and_programs", printed),
        trial("plan::what_does_not_fit_is_refused_with_one_line", refused),
        trial("plan::structures_and_limits_change_no_picture", same_picture),
        trial("plan::it_includes_the_buffers_of_light", light),
        trial("plan::shadows_follow_the_choice_of_structure", shadows),
        trial("bench::a_file_is_measured_with_two_structures", bench),
        trial_of_signals("interrupt::tracing_is_stopped", stopped),
        trial("light::a_time_gives_at_least_one_sample", time),
        trial_of_signals("light::a_signal_keeps_the_partial_picture_if_asked", signal),
    ]
}

fn run(folder: &TempDir, arguments: &str) -> Output {
    command(folder, arguments).output().unwrap()
}

#[track_caller]
fn stdout(folder: &TempDir, arguments: &str) -> String {
    let output = succeed(&mut command(folder, arguments));
    String::from_utf8(output.stdout).unwrap()
}

fn folder_with(count: u32) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    stdout(&folder, &format!("generate clusters -n {count} -o a.npy"));
    folder
}

fn printed(headless: &'static Headless) {
    let folder = folder_with(2000);
    let text = stdout(&folder, "plan a.npy --accel tree --size 640x480 --style fast");
    for words in ["spheres: 2000", "8-wide tree (asked for)", "640x480", "hits", "fits\n"] {
        assert!(text.contains(words), "{text} lacks {words}");
    }
    let text = stdout(&folder, "plan a.npy --size 9000x9000 --layer depth --json --style fast");
    let plan: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(plan["fits"], true);
    assert_eq!(plan["problem"], serde_json::Value::Null);
    assert_eq!(plan["scene"]["spheres"], 2000);
    assert_eq!(plan["adapter"]["name"], headless.adapter_info().name);
    assert!(plan["picture"]["tiles"].as_u64().unwrap() >= 20, "{text}");
    let buffers = plan["buffers"].as_array().unwrap();
    let bytes = |buffer: &serde_json::Value| buffer["bytes"].as_u64().unwrap();
    assert_eq!(plan["device_bytes"].as_u64(), Some(buffers.iter().map(bytes).sum()));
    assert!(buffers.iter().any(|buffer| buffer["name"] == "depth read-back"));
}

/// Replaces the number of free bytes in a message, which changes from run to run.
fn without_free_bytes(stderr: &[u8]) -> String {
    let line = String::from_utf8(stderr.to_vec()).unwrap();
    let (start, rest) = line.split_once(", but ").unwrap();
    let (_, end) = rest.split_once(' ').unwrap();
    format!("{start}, but N {end}")
}

fn refused(_: &'static Headless) {
    let folder = folder_with(100);
    let view = "a.npy --size 4000000x4000000";
    let (plan, json) = (run(&folder, &format!("plan {view}")), run(&folder, &format!("plan {view} --json")));
    let render = run(&folder, &format!("render {view} -o out.png --backend gpu"));
    for output in [&plan, &json, &render] {
        assert_eq!(output.status.code(), Some(1));
        let line = without_free_bytes(&output.stderr);
        assert_eq!(line, without_free_bytes(&plan.stderr));
        assert!(line.contains("the picture needs ") && line.contains("a smaller size"), "{line}");
        assert_eq!(line.lines().count(), 1);
    }
    assert!(String::from_utf8(plan.stdout).unwrap().ends_with("does not fit\n"));
    let report: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(report["fits"], false);
    let line = String::from_utf8(json.stderr).unwrap();
    assert_eq!(report["problem"].as_str(), line.trim_end().strip_prefix("error: "));
    assert!(!folder.path().join("out.png").exists());
}

fn same_picture(_: &'static Headless) {
    let folder = folder_with(500);
    let view = "render a.npy -o - --size 70x50 --backend gpu";
    let picture = run(&folder, view).stdout;
    assert!(!picture.is_empty());
    for flags in ["--accel grid", "--accel tree", "--accel list", "--limits webgpu"] {
        let output = run(&folder, &format!("{view} {flags}"));
        assert!(output.status.success(), "{flags}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stdout == picture, "{flags}");
    }
    for style in ["--style fast", "--style fast --separation 0.1"] {
        let [grid, tiles] = ["grid", "tiles"].map(|accel| run(&folder, &format!("{view} {style} --accel {accel}")));
        assert!(tiles.status.success() && tiles.stdout == grid.stdout, "{style}");
    }
}

fn bench(headless: &'static Headless) {
    let folder = folder_with(300);
    let text = stdout(&folder, "bench a.npy --reps 2 --size 32x24 --json");
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(report["adapter"]["name"], headless.adapter_info().name);
    let scene = &report["scenes"][0];
    assert_eq!((&scene["name"], &scene["spheres"]), (&"a.npy".into(), &300.into()));
    let runs = scene["runs"].as_array().unwrap();
    assert_eq!(runs.len(), 2);
    for run in runs {
        assert_eq!(run["rays"], 32 * 24);
        assert!(run["trace_wall"]["median_seconds"].as_f64().unwrap() > 0.0);
        assert!(run["submissions"].as_u64().unwrap() > 0);
    }
    assert!(scene["note"].as_str().unwrap().starts_with("auto chose "));
    let text = stdout(&folder, "bench a.npy --reps 1 --size 32x24 --accel list");
    assert!(text.contains("list: list") && text.contains("Mrays/s"), "{text}");
    let text = stdout(&folder, "bench a.npy --reps 1 --size 32x24 --accel tiles");
    assert!(text.contains("tiles: tiles"), "{text}");
    for refused in ["render a.npy --accel tiles -o out.png --style path", "verify a.npy --accel tiles"] {
        let output = run(&folder, refused);
        let line = String::from_utf8(output.stderr).unwrap();
        assert!(
            line.contains("tiles are lists of spheres for one picture: they need one ray for each pixel"),
            "{line}"
        );
        assert_eq!(output.status.code(), Some(1), "{refused}");
    }
}

/// Each of 16 million rays tests 30,000 spheres. The eye is among the spheres, so no ray ends early.
fn stopped(_: &'static Headless) {
    let folder = folder_with(30_000);
    let render =
        "render a.npy -o out.png --backend gpu --accel list --size 4000x4000 --eye 0.5,0.5,0.5 --direction 0,0,-1";
    for delay in [100, 300, 1000] {
        let mut command = command(&folder, render);
        let child = command.stderr(std::process::Stdio::piped()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(delay));
        let id = child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(130), "{stderr}");
        assert_eq!(stderr, "stopped; nothing was written\n");
        let files: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
        assert_eq!(files.len(), 1, "{files:?}");
    }
}

const SCENE: &str = "[film]\nwidth = 64\nheight = 48\n[camera.pinhole]\neye = [0, 1, 6]\nlook_at = [0, 0, 0]\n\
                     [ground]\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'tomato'\n";

fn folder_of_light() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

/// Reads the number of samples, which is the same in all pixels.
fn samples(folder: &Path) -> u32 {
    let bytes = std::fs::read(folder.join("s.npy")).unwrap();
    let samples: Vec<u32> = npyz::NpyFile::new(&bytes[..]).unwrap().into_vec().unwrap();
    assert!(samples.iter().all(|count| *count == samples[0]));
    samples[0]
}

fn time(headless: &'static Headless) {
    let folder = folder_of_light();
    let flags = "render scene.toml -o out.png --layer samples=s.npy --time";
    for (time, most) in [("0.001s --keep-partial", u32::MAX), ("1h --samples 3", 3)] {
        succeed(&mut command_on(headless, &folder, &format!("{flags} {time}")));
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
    let folder = folder_of_light();
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
            // Before every pixel has a sample, the program says that it continues until then.
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

fn light(_: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    let write = |text: &str| std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    write(SCENE);
    let plan = |flags: &str| {
        let report = stdout(&folder, &format!("plan scene.toml --json {flags}"));
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        let paths = report["buffers"].as_array().unwrap().iter().find(|buffer| buffer["name"] == "paths");
        paths.map(|paths| paths["bytes"].as_u64().unwrap())
    };
    // The scene has a ground, so it is lit.
    let state = plan("--size 64x48");
    assert!(state.is_some_and(|bytes| bytes > 0 && bytes % (16 * 64 * 48) == 0), "{state:?}");
    write(&SCENE.replace("[ground]\n", ""));
    assert_eq!(plan("--size 64x48"), None);
    // The state of a path has nine vectors, and that of a studio sample ten.
    let path = plan("--size 64x48 --integrator path");
    assert_eq!(path, state.map(|bytes| bytes / 10 * 9));
}

/// Every second of 80 spheres casts no shadow in a studio.
fn shadows(_: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = "[studio]\n[sampling]\nsamples = 2\n[film]\nwidth = 16\nheight = 12\n".to_owned();
    for i in 0..80 {
        let (x, y, opacity) = (i % 10, i / 10, 1.0 - 0.5 * f64::from(i % 2));
        scene += &format!("[[spheres]]\ncenter = [{x}, {y}, 0]\nradius = 0.4\nopacity = {opacity}\n");
    }
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let counts = |flags: &str| {
        let report = stdout(&folder, &format!("plan scene.toml --json {flags}"));
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        let names: Vec<_> = report["buffers"].as_array().unwrap().iter().map(|buffer| buffer["name"].clone()).collect();
        ["nodes", "cells"].map(|name| names.iter().filter(|found| found.as_str().unwrap().contains(name)).count())
    };
    assert_eq!(counts("--accel tree"), [2, 0]);
    assert_eq!(counts("--accel grid"), [0, 2]);
    assert_eq!(counts("--accel tree --integrator path"), [1, 0]);
    assert_eq!(counts("--accel tree --integrator primary"), [1, 0]);
    let pictures = ["tree", "grid", "list"].map(|accel| {
        stdout(&folder, &format!("render scene.toml -o out.png --accel {accel}"));
        std::fs::read(folder.path().join("out.png")).unwrap()
    });
    assert!(pictures.iter().all(|picture| *picture == pictures[0]));
}
