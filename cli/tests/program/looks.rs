//! Tests of styles, views, printed scenes, and of the line about a picture.

use crate::support::{Folder, SCENE, WATER, decode};

const DATA: [(&str, &str); 2] = [("water.xyz", WATER), ("scene.toml", SCENE)];

/// The picture that a command renders.
#[track_caller]
fn picture(folder: &Folder, arguments: &str) -> Vec<u8> {
    folder.run(&format!("render {arguments} -o out.png --backend cpu --quiet")).succeeded();
    folder.read("out.png")
}

#[test]
fn a_printed_scene_gives_the_same_bytes() {
    let folder = Folder::with(&DATA);
    for arguments in [
        "water.xyz --size 40x30",
        "water.xyz --size 30x40 --view iso --turn 12 --zoom 1.5 --margin 10% --samples 3",
        "water.xyz --size 24x24 --style studio --ao=2 --outline 2.5 --background tomato --tone agx",
        "water.xyz --size 24x24 --style path --samples 2 --denoise=false --exposure 0.3",
        "water.xyz --size 24x24 --style flat --camera orthographic --bits 16",
        "water.xyz --size 24x24 --style fast --camera panorama",
        "scene.toml --style illustration --seed 7",
        "scene.toml --samples 4",
        "scene.toml --camera thin-lens --aperture-radius 0.1 --samples 2",
    ] {
        let run = folder.run(&format!("render {arguments} --print-scene --quiet")).succeeded();
        assert_eq!(run.stderr, "", "{arguments}");
        std::fs::write(folder.path("printed.toml"), &run.stdout).unwrap();
        let text = String::from_utf8(run.stdout).unwrap();
        assert!(
            picture(&folder, arguments) == picture(&folder, "printed.toml"),
            "{arguments}\n{text}"
        );
        // What is printed of a printed scene is the same again, but for its name.
        let again = folder.run("render printed.toml --print-scene --quiet").succeeded();
        let again = String::from_utf8(again.stdout).unwrap();
        let body = |text: &str| text.split_once("\n\n").unwrap().1.to_owned();
        assert_eq!(body(&again), body(&text), "{arguments}");
    }
}

#[test]
fn the_line_about_a_picture_has_flags_to_use_again() {
    let folder = Folder::with(&DATA);
    let small = "-o out.png --backend cpu --size 20x15 --samples 1";
    let said =
        |arguments: &str| folder.run(&format!("render {arguments} {small}")).succeeded().said;
    let start = |text: &str| said(text).unwrap().rsplit_once("; ").unwrap().0.to_owned();
    assert_eq!(start("water.xyz"), "water.xyz: 3 atoms; --style default --view y");
    assert_eq!(
        start("water.xyz --style flat --view 30,20 --turn 5"),
        "water.xyz: 3 atoms; --style flat --view 30,20 --turn 5"
    );
    assert_eq!(start("scene.toml"), "scene.toml: 1 sphere");
    assert_eq!(said("water.xyz --quiet"), None);
}

/// A grey background keeps its bytes, whatever the exposure and the tone curve do to the spheres before it.
#[test]
fn the_background_survives_every_tone_curve() {
    let folder = Folder::with(&DATA);
    for style in ["default", "fast", "flat", "studio", "illustration", "path"] {
        let small =
            format!("water.xyz --size 24x18 --style {style} --background #808080 --zoom 0.5");
        let small = if style == "fast" { small } else { format!("{small} --samples 1") };
        // The ground of paths hides the background.
        let small = format!("{small} --view z");
        let plain = decode(&picture(&folder, &small)).2;
        for flags in ["--tone filmic", "--tone agx", "--exposure 2", "--exposure -1 --tone agx"] {
            let changed = decode(&picture(&folder, &format!("{small} {flags}"))).2;
            let grey = |pixels: &[u8]| pixels.chunks(3).filter(|p| *p == [0x80; 3]).count();
            assert!(changed.starts_with(&[0x80; 3]), "{style} {flags}: {:?}", &changed[..3]);
            assert!(grey(&changed) >= 300 && plain != changed, "{style} {flags}");
        }
    }
}

/// More samples smooth the picture, and change neither its light nor its background.
#[test]
fn samples_do_not_change_the_light() {
    let folder = Folder::with(&DATA);
    let mean = |arguments: &str| {
        let (.., pixels) = decode(&picture(&folder, arguments));
        // The mean of light, not of bytes, which follow a curve.
        let light = |byte: &u8| (f64::from(*byte) / 255.0).powf(2.2);
        pixels.iter().map(light).sum::<f64>() / pixels.len() as f64
    };
    for input in ["scene.toml", "water.xyz --size 40x30"] {
        let (plain, smooth) = (mean(input), mean(&format!("{input} --samples 24")));
        assert!((plain - smooth).abs() < 0.015, "{input}: {plain}, {smooth}");
    }
}

#[test]
fn views_that_contradict_are_refused() {
    let folder = Folder::with(&DATA);
    for (flags, word) in [
        ("--view x --eye 0,0,9 --look-at 0,0,0", "--view"),
        ("--view up", "iso"),
        ("--margin 0.6", "margin"),
        ("--margin 1%x", "10%"),
        ("--zoom 0", "zoom"),
        ("--eye 0,0,9 --look-at 0,0,0 --margin 0.1", "margin"),
        ("--camera fisheye --zoom 2", "fisheye"),
        ("--style nice", "illustration"),
        ("--background nocolor", "--background"),
        ("--style fast --samples 4", "--style"),
    ] {
        let run = folder.run(&format!("render water.xyz -o out.png --backend cpu {flags}"));
        assert_eq!(run.code, 2, "{flags}: {}", run.stderr);
        assert!(run.stderr.contains(word), "{flags}: {}", run.stderr);
    }
    // Every named view works, whatever is up.
    for view in ["x", "-x", "y", "-y", "z", "-z", "iso", "10,-90"] {
        for up in ["", "--up 0,0,1", "--up 1,0,0"] {
            picture(&folder, &format!("water.xyz --size 12x9 --samples 1 --view {view} {up}"));
        }
    }
}
