//! Tests of jobs whose units are groups of bricks: what is merged is what one machine writes, to the byte.

use std::fs;

use crate::bricks::{f32_array, spheres};
use crate::job::{missing, part};
use crate::support::Folder;

const LAYERS: [&str; 4] = ["depth", "normal", "position", "id"];

const FLAGS: &str = "--style fast --size 61x47";

/// A folder with data, the same in 13 bricks, and its picture.
fn folder() -> Folder {
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
fn split(folder: &Folder, groups: u32) {
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
    let folder = folder();
    for groups in [1, 2, 13] {
        split(&folder, groups);
        folder.run(&format!("job part job 0-{} -q", groups - 1)).succeeded();
        assert_eq!(missing(&folder), [0_usize; 0]);
        assert_merged(&folder);
        fs::remove_dir_all(folder.path("job")).unwrap();
    }
    // Tiles of bricks have all bricks in each unit.
    let run = format!("job split a.bricks --tiles 3x2 -o job -q {FLAGS} --backend cpu");
    folder.run(&run).succeeded();
    folder.run("job part job 0-5 -q").succeeded();
    folder.run("job merge job -o tiles.png -q").succeeded();
    assert_eq!(folder.read("tiles.png"), folder.read("whole.png"));
}

#[test]
fn missing_damaged_and_foreign_groups_are_named() {
    let folder = folder();
    split(&folder, 4);
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
    // A part of the same groups of another file.
    let other = Folder::new();
    fs::write(other.path("a.npy"), f32_array(&spheres(4000, [-0.25; 3]))).unwrap();
    other.run("sort a.npy -o a.bricks -q --bricks 13").succeeded();
    split(&other, 4);
    other.run("job part job 0 -q").succeeded();
    fs::copy(part(&other, 0), part(&folder, 0)).unwrap();
    merge().refused(1, "of another job 0");
    fs::copy(other.path("a.bricks"), folder.path("a.bricks")).unwrap();
    folder.refuses("job part job 0", 1, "this file has changed since the job was split");
}

#[test]
fn what_groups_cannot_be_is_refused_with_a_reason() {
    let folder = folder();
    let cases = [
        ("a.npy --by-depth 2 --style fast", "make one with `pinhole sort`"),
        ("a.bricks --by-depth 14", "the file has 13 bricks"),
        ("a.bricks --by-depth 2 --style studio", "what one group adds depends on the others"),
        ("a.bricks --by-depth 2 --samples 4", "--samples applies only to"),
        ("a.bricks --turntable 4", "a series of pictures needs all spheres"),
        ("a.bricks --by-depth 0", "0 is not in 1.."),
        ("a.bricks --by-depth 2 --tiles 2x2", "cannot be used with"),
    ];
    for (flags, says) in cases {
        folder.refuses(&format!("job split {flags} -o no --backend cpu"), 2, says);
    }
}
