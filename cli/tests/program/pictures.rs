//! Tests of the picture files that the program writes.
#![allow(clippy::float_cmp, reason = "what is compared is exact")]

use std::io::Cursor;
use std::process::Command;

use exr::prelude::{FlatSamples, ReadChannels, ReadLayers};

use crate::support::{Folder, Run, SCENE};

const THREE_SPHERES: &str = include_str!("../../../examples/three-spheres.toml");

fn folder() -> Folder {
    Folder::with(&[("three.toml", THREE_SPHERES), ("scene.toml", SCENE)])
}

#[track_caller]
fn render(folder: &Folder, arguments: &str) -> Run {
    let run = folder.run(&format!("render {arguments} --backend cpu --size 80x60")).succeeded();
    assert_eq!(run.stderr, "", "{arguments}");
    run
}

/// The channels of an EXR by name.
fn channels(file: Vec<u8>) -> Vec<(String, FlatSamples)> {
    let read = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels();
    let image = read.first_valid_layer().all_attributes().from_buffered(Cursor::new(file)).unwrap();
    assert_eq!(image.layer_data.size, exr::math::Vec2(80, 60));
    let channels = image.layer_data.channel_data.list.into_iter();
    channels.map(|channel| (channel.name.to_string(), channel.sample_data)).collect()
}

fn names(channels: &[(String, FlatSamples)]) -> Vec<&str> {
    channels.iter().map(|(name, _)| name.as_str()).collect()
}

fn rgba(png: &[u8]) -> image::DynamicImage {
    image::load_from_memory_with_format(png, image::ImageFormat::Png).unwrap()
}

#[test]
fn an_exr_has_the_layers_that_are_named() {
    let folder = folder();
    render(&folder, "three.toml -o out.exr");
    let opaque = channels(folder.read("out.exr"));
    assert_eq!(names(&opaque), ["A", "B", "G", "R"]);
    assert_eq!(opaque[0].1, FlatSamples::F32(vec![1.0; 4800]));

    let layers = "--layer depth --layer id --layer normal=n.npy --layer samples --layer color";
    render(&folder, &format!("three.toml -o out.exr {layers} --transparent"));
    assert_eq!(folder.files(), ["n.npy", "out.exr", "scene.toml", "three.toml"]);
    let channels = channels(folder.read("out.exr"));
    assert_eq!(names(&channels), ["A", "B", "G", "R", "Z", "id", "samples"]);
    let at = 30 * 80 + 40;
    let number = |name: &str, at| match &channels.iter().find(|(n, _)| n == name).unwrap().1 {
        FlatSamples::F32(samples) => f64::from(samples[at]),
        FlatSamples::U32(samples) => f64::from(samples[at]),
        FlatSamples::F16(_) => panic!("half"),
    };
    // The corner shows the background, and the middle a blue sphere.
    assert_eq!(["A", "R", "G", "B"].map(|name| number(name, 0)), [0.0; 4]);
    assert_eq!(["A", "R", "G", "B"].map(|name| number(name, at)), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!((number("id", 0), number("id", at)), (4_294_967_295.0, 2.0));
    assert_eq!((number("samples", 0), number("samples", at)), (1.0, 1.0));
    assert_eq!(number("Z", 0), f64::INFINITY);
    assert!((number("Z", at) - 9.0).abs() < 1.0, "{}", number("Z", at));
}

#[test]
fn transparent_pictures_have_no_background() {
    let folder = folder();
    render(&folder, "three.toml -o out.png --transparent");
    let image = rgba(&folder.read("out.png"));
    assert_eq!(image.color(), image::ColorType::Rgba8);
    let image = image.to_rgba8();
    assert_eq!(image.get_pixel(0, 0).0, [0; 4]);
    assert_eq!(image.get_pixel(19, 30).0, [0xff, 0, 0, 0xff]);
    // Standard output and 16 bits can be transparent too.
    let run = render(&folder, "three.toml -o - --transparent --bits 16");
    let deep = rgba(&run.stdout);
    assert_eq!(deep.color(), image::ColorType::Rgba16);
    assert_eq!(deep.to_rgba16().get_pixel(61, 30).0, [0, 0x8080, 0, 0xffff]);
}

#[test]
fn scenes_say_how_they_are_written_and_flags_come_first() {
    let folder = folder();
    let output = "[output]\nexposure = -1\ntone = 'agx'\ntransparent = true\nbits = 16\n";
    // Keys at the top level must come before the first table.
    let (keys, tables) = THREE_SPHERES.split_once("[film]").unwrap();
    let scene = format!("{keys}{output}[film]{tables}");
    std::fs::write(folder.path("output.toml"), scene).unwrap();
    let picture = |arguments: &str| render(&folder, &format!("{arguments} -o -")).stdout;
    let by_scene = picture("output.toml");
    assert_eq!(rgba(&by_scene).color(), image::ColorType::Rgba16);
    let flags = "--exposure -1 --tone agx --transparent --bits 16";
    assert_eq!(picture(&format!("three.toml {flags}")), by_scene);
    for (flags, same) in [
        ("--exposure 0", "--tone agx --transparent --bits 16"),
        ("--tone none", "--exposure -1 --transparent --bits 16"),
        ("--transparent=false", "--exposure -1 --tone agx --bits 16"),
        ("--bits 8", "--exposure -1 --tone agx --transparent=true"),
        ("--bits 8 --exposure 0 --tone none --transparent=false", ""),
    ] {
        let expected = picture(&format!("three.toml {same}"));
        assert_ne!(expected, by_scene, "{flags}");
        assert_eq!(picture(&format!("output.toml {flags}")), expected, "{flags}");
    }
    // An EXR file stores the light, so the keys for PNG do not change it.
    render(&folder, "output.toml -o a.exr");
    render(&folder, "three.toml -o b.exr --transparent");
    assert_eq!(folder.read("a.exr"), folder.read("b.exr"));
}

/// Each stop doubles or halves the light in the middle of a sphere.
#[test]
fn exposure_is_in_stops() {
    let folder = Folder::with(&[("scene.toml", &SCENE.replace("'red'", "[1, 0.25, 4]"))]);
    let middle = |flags: &str| {
        let run = render(&folder, &format!("scene.toml -o - {flags}"));
        let image = rgba(&run.stdout).to_rgb8();
        image.get_pixel(40, 30).0
    };
    // In sRGB, 188 is half the light and 137 a quarter.
    let close = |found: [u8; 3], expected: [u8; 3]| {
        assert!(found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1), "{found:?}");
    };
    close(middle(""), [255, 137, 255]);
    close(middle("--exposure -1"), [188, 99, 255]);
    close(middle("--exposure=2"), [255, 255, 255]);
    close(middle("--exposure -32"), [0, 0, 0]);
    let [r, g, b] = middle("--tone filmic");
    assert!(r < 255 && g > 137 && b < 255, "{r} {g} {b}");
}

#[test]
#[cfg(unix)]
fn a_full_disk_leaves_one_line_and_no_file() {
    let folder = folder();
    for output in ["out.exr", "out.png"] {
        // The limit is 4 KiB, so that the empty file that is tried before the work can be created.
        let script = format!(
            "ulimit -f 8; exec {} render three.toml -o {output} --backend cpu",
            env!("CARGO_BIN_EXE_pinhole")
        );
        let mut command = Command::new("sh");
        command.args(["-c", &script]).current_dir(folder.path(""));
        let run = command.output().unwrap();
        let stderr = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(1), "{stderr}");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
        let expected = format!("error: {output}: cannot be written: File too large");
        assert!(stderr.starts_with(&expected), "{stderr}");
        assert_eq!(folder.files(), ["scene.toml", "three.toml"]);
    }
}
