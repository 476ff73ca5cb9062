//! Tests of jobs. Merged parts have the same bytes as the picture of one machine, and bad files are not used.

use std::fs;
use std::path::PathBuf;

use crate::bricks::{f32_array, spheres};
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

/// Splits, renders all parts in two processes, and merges. The folder of the job is `job`.
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

/// The units without a whole part.
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

/// Renders with the same flags on one machine, and compares all files. Their names begin with `m` and `r`.
#[track_caller]
fn assert_same(flags: &str, tiles: &str, outputs: &str) {
    let folder = folder();
    let layers: Vec<&str> = outputs
        .split_whitespace()
        .filter_map(|word| word.split_once('=').map(|(layer, _)| layer).or(Some(word)))
        .collect();
    let names: String =
        layers.windows(2).filter(|pair| pair[0] == "--layer").map(|pair| format!(" --layer {}", pair[1])).collect();
    let exr = if outputs.contains(".exr") { "--exr" } else { "" };
    let merged = through_parts(&folder, &format!("{flags} --tiles {tiles} {exr}{names}"), &outputs.replace('@', "m"));
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
    assert_same("a.xyz --size 61x47 --samples 3 --outline 3", "5x3", &format!("-o @-.png {layers}"));
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
    run.refused(1, "3 of 6 parts cannot be merged: missing 0,2,5;");
    run.refused(1, "--array=0,2,5\n");
    assert!(!folder.path("m0.png").exists());
    // Without --check, only the headers and lengths of parts are checked.
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

const LAYERS: [&str; 4] = ["depth", "normal", "position", "id"];

const FLAGS: &str = "--style fast --size 61x47";

/// A folder with data, the same data in 13 bricks, and its picture.
fn bricks() -> Folder {
    let folder = Folder::new();
    fs::write(folder.path("a.npy"), f32_array(&spheres(4000, [-0.5; 3]))).unwrap();
    folder.run("sort a.npy -o a.bricks -q --bricks 13").succeeded();
    let layers = layers("whole");
    folder.run(&format!("render a.npy -o whole.png -q {layers} {FLAGS} --backend cpu")).succeeded();
    folder
}

fn layers(name: &str) -> String {
    LAYERS.map(|layer| format!("--layer {layer}={name}-{layer}.npy")).join(" ")
}

#[track_caller]
fn split_by_depth(folder: &Folder, groups: u32) {
    let layers = LAYERS.map(|layer| format!("--layer {layer}")).join(" ");
    let run = format!("job split a.bricks --by-depth {groups} -o job -q {layers} {FLAGS}");
    folder.run(&format!("{run} --backend cpu")).succeeded();
}

#[track_caller]
fn assert_merged(folder: &Folder) {
    folder.run(&format!("job merge job -o merged.png -q {}", layers("merged"))).succeeded();
    for name in LAYERS.map(|layer| format!("-{layer}.npy")).iter().chain([&".png".to_owned()]) {
        let [whole, merged] = ["whole", "merged"].map(|file| folder.read(&format!("{file}{name}")));
        assert!(whole == merged, "{name} differs");
    }
}

#[test]
fn merged_groups_are_the_same_bytes() {
    let folder = bricks();
    for groups in [1, 2, 13] {
        split_by_depth(&folder, groups);
        folder.run(&format!("job part job 0-{} -q", groups - 1)).succeeded();
        assert_eq!(missing(&folder), [0_usize; 0]);
        assert_merged(&folder);
        fs::remove_dir_all(folder.path("job")).unwrap();
    }
    // Each unit for tiles of bricks has all bricks.
    let run = format!("job split a.bricks --tiles 3x2 -o job -q {FLAGS} --backend cpu");
    folder.run(&run).succeeded();
    folder.run("job part job 0-5 -q").succeeded();
    folder.run("job merge job -o tiles.png -q").succeeded();
    assert_eq!(folder.read("tiles.png"), folder.read("whole.png"));
}

#[test]
fn missing_damaged_and_foreign_groups_are_named() {
    let folder = bricks();
    split_by_depth(&folder, 4);
    folder.run("job part job 0-2 -q").succeeded();
    let merge = || folder.run("job merge job -o merged.png -q");
    merge().refused(1, "missing 3; render them again with --array=3");
    folder.run("job part job 3 -q").succeeded();
    let good = fs::read(part(&folder, 2)).unwrap();
    fs::write(part(&folder, 2), &good[..good.len() - 9]).unwrap();
    fs::copy(part(&folder, 0), part(&folder, 1)).unwrap();
    merge().refused(1, "damaged 2, of another job 1");
    folder.run("job part job 0-3 -q").succeeded();
    assert_merged(&folder);
    // The part belongs to the same groups of another file.
    let other = Folder::new();
    fs::write(other.path("a.npy"), f32_array(&spheres(4000, [-0.25; 3]))).unwrap();
    other.run("sort a.npy -o a.bricks -q --bricks 13").succeeded();
    split_by_depth(&other, 4);
    other.run("job part job 0 -q").succeeded();
    fs::copy(part(&other, 0), part(&folder, 0)).unwrap();
    merge().refused(1, "of another job 0");
    fs::copy(other.path("a.bricks"), folder.path("a.bricks")).unwrap();
    folder.refuses("job part job 0", 1, "this file has changed since the job was split");
}

/// A complete job of four parts.
fn complete() -> Folder {
    let folder = folder();
    through_parts(&folder, "a.xyz --frames :2 --tiles 2x1 --size 40x30 --samples 2", "-o good%d.png");
    folder
}

/// Each file of a job is missing, cut off, changed, or from another job or version.
#[test]
fn damaged_files_of_a_job_are_refused() {
    let folder = complete();
    let read = |name: &str| folder.read(name);
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path(name), bytes).unwrap();
    let merge = "job merge job -o bad%d.png";
    let layer = format!("{merge} --layer depth=d%d.npy");
    folder.refuses(&layer, 2, "split the job with --layer depth");
    let all = ["job part job 0", "job status job --missing", merge];
    let good = read("job/job.json");
    let text = String::from_utf8(good.clone()).unwrap();
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    for (bytes, words) in [
        (good[..good.len() / 2].to_vec(), "this file is damaged"),
        (Vec::new(), "this file is damaged"),
        (b"{}".to_vec(), "this is not the file of a job"),
        (b"[1]".to_vec(), "this is not the file of a job"),
        (text.replace(&version, "\"version\": \"9.9.9\"").into(), "this job is of pinhole 9.9.9"),
        (text.replace("\"pinhole_job\": 1", "\"pinhole_job\": 2").into(), "use the same version"),
        (text.replace("\"samples\": 2", "\"samples\": 3").into(), "this file is damaged"),
        (text.replace("\"units\": 4", "\"units\": 40").into(), "this file is damaged"),
        (text.replace("\"samples\"", "\"sample\"").into(), "this file is damaged"),
    ] {
        write("job/job.json", &bytes);
        all.iter().for_each(|arguments| folder.refuses(arguments, 1, words));
    }
    std::fs::remove_file(folder.path("job/job.json")).unwrap();
    all.iter().for_each(|arguments| folder.refuses(arguments, 1, "not the folder of a job"));
    write("job/job.json", &good);
    // Only missing parts need the facts about all frames.
    let overview = read("job/overview.bin");
    std::fs::remove_file(part(&folder, 0)).unwrap();
    for bytes in [&overview[8..], &[]] {
        write("job/overview.bin", bytes);
        folder.refuses("job part job 0", 1, "this file is damaged; split the job again");
    }
    std::fs::remove_file(folder.path("job/overview.bin")).unwrap();
    folder.refuses("job part job 0", 1, "overview.bin: cannot be read");
    write("job/overview.bin", &overview);
    // The data has changed, but has the same length.
    let data = read("a.xyz");
    let mut other = data.clone();
    let last = other.iter().rposition(u8::is_ascii_digit).unwrap();
    other[last] ^= 1;
    write("a.xyz", &other);
    folder.refuses("job part job 0", 1, "a.xyz: this file has changed since the job was split");
    write("a.xyz", &data);
    folder.run("job part job 0 -q").succeeded();
    folder.run(&format!("{merge} -q")).succeeded();
    assert!(read("bad0.png") == read("good0.png") && read("bad1.png") == read("good1.png"));
}

#[test]
fn damaged_and_foreign_parts_are_refused_and_rendered_again() {
    let folder = complete();
    let good: Vec<Vec<u8>> = (0..4).map(|unit| std::fs::read(part(&folder, unit)).unwrap()).collect();
    let put = |unit: usize, bytes: &[u8]| std::fs::write(part(&folder, unit), bytes).unwrap();
    let flipped = |at: usize| {
        let mut bytes = good[0].clone();
        bytes[at] ^= 1;
        bytes
    };
    let end = good[0].len();
    // One byte is changed: of the start, the header's length, the header, the pixels, or the digest.
    let mut damaged: Vec<Vec<u8>> = [0, 16, 20, 60, 200, end / 2, end - 33, end - 32, end - 1].map(flipped).to_vec();
    damaged.extend([vec![], good[0][..end / 2].to_vec(), good[0][..end - 1].to_vec()]);
    damaged.extend([[&good[0][..], b"x"].concat(), vec![0; end], b"pinhole part 1\n".to_vec()]);
    for bytes in damaged {
        put(0, &bytes);
        folder.refuses("job merge job -o m%d.png", 1, "damaged 0; render them again with --array=0");
        assert_eq!(missing(&folder), [0]);
        folder.run("job part job 0 -q").succeeded();
        assert_eq!(missing(&folder), [0_usize; 0]);
    }
    // The part belongs to another unit, and then to another job.
    put(2, &good[1]);
    folder.refuses("job merge job -o m%d.png", 1, "of another job 2; ");
    put(2, &good[2]);
    let other = complete();
    std::fs::remove_dir_all(other.path("job")).unwrap();
    through_parts(&other, "a.xyz --frames :2 --tiles 2x1 --size 40x30 --samples 3", "-o o%d.png");
    std::fs::copy(part(&other, 3), part(&folder, 3)).unwrap();
    folder.refuses("job merge job -o m%d.png", 1, "of another job 3; ");
    assert_eq!(missing(&folder), [3]);
    folder.run("job part job 3 -q").succeeded();
    folder.run("job merge job -o m%d.png -q").succeeded();
    assert!(folder.read("m1.png") == folder.read("good1.png"));
}
