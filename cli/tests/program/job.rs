//! Tests of jobs: what is merged from parts is what one machine writes, to the byte.

use std::path::PathBuf;

use crate::support::{Folder, Run, SCENE};

/// Five frames of three atoms that move and change their charges.
pub(crate) fn moving() -> String {
    let head = "Properties=species:S:1:pos:R:3:charge:R:1";
    (0..5)
        .map(|frame| {
            let x = 0.4 * f64::from(frame);
            format!("3\n{head}\nO {x} 0 0 {frame}\nH 1 {x} 0.3 0.5\nC -1 0.2 {x} 1.5\n")
        })
        .collect()
}

/// A folder with frames and scenes.
pub(crate) fn folder() -> Folder {
    let sky = "[sky]\nkind = 'gradient'\nzenith = '#4080ff'\nhorizon = 'white'\n";
    let sampling = "[sampling]\nsamples = 5\ndenoise = true\n";
    let path = format!("integrator = 'path'\n{SCENE}{sampling}{sky}");
    let stereo = "data = 'a.xyz'\n[film]\nwidth = 41\nheight = 30\n[camera.pinhole]\neye = [0, 0, 12]\n\
                  look_at = [0, 0, 0]\nstereo = { separation = 0.4, convergence = 12 }\n";
    let camera = "[[keys]]\ntime = 0\nview = 'z'\n[[keys]]\ntime = 3\nview = 'y'\n";
    Folder::with(&[
        ("a.xyz", &moving()),
        ("path.toml", &path),
        ("stereo.toml", stereo),
        ("camera.toml", camera),
        ("scene.toml", SCENE),
    ])
}

/// Splits, renders all parts in two processes and merges. The folder of the job is `job`.
#[track_caller]
pub(crate) fn through_parts(folder: &Folder, split: &str, merge: &str) -> Run {
    if folder.path("job").exists() {
        std::fs::remove_dir_all(folder.path("job")).unwrap();
    }
    folder.run(&format!("job split {split} -o job --backend cpu -q")).succeeded();
    let units = units(folder);
    if units > 1 {
        folder.run(&format!("job part job {}-{} -q", units / 2, units - 1)).succeeded();
    }
    folder.run(&format!("job part job 0-{} -q", units - 1)).succeeded();
    folder.run(&format!("job merge job {merge} -q")).succeeded()
}

/// The units that have no part, or one that is not whole.
pub(crate) fn missing(folder: &Folder) -> Vec<usize> {
    let run = folder.run("job status job --missing --check").succeeded();
    assert_eq!(run.stderr, "");
    let text = String::from_utf8(run.stdout).unwrap();
    text.lines().map(|line| line.parse().unwrap()).collect()
}

fn units(folder: &Folder) -> u64 {
    let manifest: serde_json::Value = serde_json::from_slice(&folder.read("job/job.json")).unwrap();
    manifest["units"].as_u64().unwrap()
}

pub(crate) fn part(folder: &Folder, unit: usize) -> PathBuf {
    folder.path(&format!("job/parts/{unit:06}.part"))
}

/// Renders with the same flags on one machine and compares all files, whose names begin with `m` and `r`.
#[track_caller]
fn assert_same(flags: &str, tiles: &str, outputs: &str) {
    let folder = folder();
    let layers: Vec<&str> = outputs
        .split_whitespace()
        .filter_map(|word| word.split_once('=').map(|(layer, _)| layer).or(Some(word)))
        .collect();
    let names: String = layers
        .windows(2)
        .filter(|pair| pair[0] == "--layer")
        .map(|pair| format!(" --layer {}", pair[1]))
        .collect();
    let exr = if outputs.contains(".exr") { "--exr" } else { "" };
    let merged = through_parts(
        &folder,
        &format!("{flags} --tiles {tiles} {exr}{names}"),
        &outputs.replace('@', "m"),
    );
    assert_eq!(merged.stderr, "", "{flags}");
    let outputs = outputs.replace('@', "r");
    let rendered = folder.run(&format!("render {flags} {outputs} --backend cpu -q")).succeeded();
    assert!(merged.stdout == rendered.stdout, "{flags}: standard output differs");
    let files = folder.files();
    let ours: Vec<&String> = files.iter().filter(|name| name.starts_with("m-")).collect();
    let theirs: Vec<&String> = files.iter().filter(|name| name.starts_with("r-")).collect();
    assert_eq!(ours.len(), theirs.len(), "{flags}: {files:?}");
    assert!(!ours.is_empty() || !rendered.stdout.is_empty());
    for (ours, theirs) in ours.into_iter().zip(theirs) {
        assert_eq!(ours[1..], theirs[1..]);
        assert!(folder.read(ours) == folder.read(theirs), "{flags}: {ours} differs");
    }
}

#[test]
fn single_pictures_are_the_same_bytes() {
    assert_same("scene.toml", "3x2", "-o @-.png");
    assert_same("scene.toml --integrator primary", "40x30", "-o @-.png");
    assert_same("scene.toml --tone agx --exposure 1 --transparent", "1x1", "-o @-.png");
    assert_same("a.xyz --size 61x47 --samples 3", "4x4", "-o -");
    // Outlines, denoising, and layers that guide neither.
    let layers = "--layer depth=@-d.npy --layer id=@-i.npy --layer variance=@-v.npy";
    assert_same(
        "a.xyz --size 61x47 --samples 3 --outline 3",
        "5x3",
        &format!("-o @-.png {layers}"),
    );
    assert_same("path.toml", "3x4", &format!("-o @-.png {layers}"));
    assert_same("path.toml", "2x2", "-o @-.exr --layer normal --layer samples");
    assert_same("stereo.toml --samples 2", "3x2", "-o @-.png --layer position=@-p.npy");
    let legend = "--color-by charge --legend=right --scale-bar=nm --samples 2 --size 120x90";
    assert_same(&format!("a.xyz {legend}"), "2x2", "-o @-.png");
}

#[test]
fn frames_are_the_same_bytes() {
    let small = "--size 40x30 --samples 2";
    assert_same(&format!("a.xyz --frames : {small}"), "2x2", "-o @-%03d.png");
    assert_same(&format!("a.xyz --frames ::-2 {small} --color-by charge"), "2x1", "-o @-%d.png");
    assert_same(&format!("a.xyz --frames 1:4 --camera-from 0 {small}"), "1x1", "-o @-.apng");
    assert_same(&format!("a.xyz --frames : {small}"), "2x2", "-o @-.gif --fps 12");
    assert_same(&format!("a.xyz --frames :2 {small}"), "3x1", "-o - --raw y4m");
    assert_same(&format!("a.xyz --turntable 3 {small}"), "2x2", "-o @-%d.png");
    let path = format!("a.xyz --frames :3 --camera-path camera.toml {small}");
    assert_same(&path, "1x2", "-o @-%d.exr --layer id");
    assert_same("stereo.toml --frames 1:3 --samples 2", "2x2", "-o @-%d.png");
}

#[test]
fn parts_that_are_there_are_left_as_they_are() {
    let folder = folder();
    through_parts(&folder, "scene.toml --tiles 2x2", "-o m.png");
    let times = || {
        let time = |unit| std::fs::metadata(part(&folder, unit)).unwrap().modified().unwrap();
        (0..4).map(time).collect::<Vec<_>>()
    };
    let before = times();
    let run = folder.run("job part job 0-3").succeeded();
    assert_eq!((run.stderr.as_str(), run.said), ("", None));
    assert_eq!(times(), before);
    let left = std::fs::read_dir(folder.path("job/parts")).unwrap().count();
    assert_eq!(left, 4, "temporary files are left");
}

#[test]
fn status_lists_what_is_missing() {
    let folder = folder();
    folder.run("job split a.xyz --frames :3 --tiles 2x1 --backend cpu -o job -q").succeeded();
    assert_eq!(missing(&folder), [0, 1, 2, 3, 4, 5]);
    folder.run("job part job 1,3-4 -q").succeeded();
    assert_eq!(missing(&folder), [0, 2, 5]);
    let run = folder.run("job merge job -o m%d.png");
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("3 of 6 parts cannot be merged: missing 0,2,5;"), "{}", run.stderr);
    assert!(run.stderr.ends_with("--array=0,2,5\n"), "{}", run.stderr);
    assert!(!folder.path("m0.png").exists());
    // Without --check, only the headers and lengths of parts are looked at.
    std::fs::write(part(&folder, 4), "x").unwrap();
    let run = folder.run("job status job --missing").succeeded();
    assert_eq!(run.stdout, b"0\n2\n4\n5\n");
    folder.run("job part job 0-5 -q").succeeded();
    assert_eq!(folder.run("job status job --missing").succeeded().stdout, b"");
}

/// Parts may be rendered and merged from any folder.
#[test]
fn paths_mean_what_they_meant_when_the_job_was_split() {
    let folder = folder();
    let split = "job split a.xyz --frames :2 --tiles 2x1 --layer alpha --backend cpu -o job -q";
    folder.run(split).succeeded();
    std::fs::create_dir(folder.path("else")).unwrap();
    let elsewhere = |arguments: &str| {
        let mut command = folder.command(arguments);
        let output = command.current_dir(folder.path("else")).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    elsewhere("job part ../job 0-3");
    elsewhere("job merge ../job -o m%d.png --layer alpha=a%d.npy");
    for name in ["else/m0.png", "else/m1.png", "else/a0.npy", "else/a1.npy"] {
        assert!(folder.path(name).is_file(), "{name}");
    }
}
