//! Layers of settings: which one wins, and what errors name.

use pinhole::camera::{CameraKind, PinholeCamera};
use pinhole::render::{Integrator, Outline, RenderSettings, Studio};
use pinhole::{LinearRgb, Scene, Sphere};
use pinhole_figure::scene_file::{IntegratorKind, SceneFile, SceneFileError};
use pinhole_figure::settings::flags::{FLAGS, Flag, Value};
use pinhole_figure::settings::{Layer, Sources};
use pinhole_figure::style::Style;

fn flags(words: &[&str]) -> Vec<Layer> {
    let layer = |word: &&str| {
        let (name, value) = word.split_once('=').unwrap_or((word, ""));
        let flag = Flag::of_name(name).unwrap();
        flag.layer(if value.is_empty() { flag.alone.unwrap() } else { value }, "pinhole").unwrap()
    };
    words.iter().map(layer).collect()
}

fn read(file: &str, words: &[&str]) -> Result<SceneFile, SceneFileError> {
    SceneFile::read(&Sources { file, flags: &flags(words), style: None })
}

fn scene() -> Scene {
    let sphere = |x: f64| Sphere::new([x, 0.0, 0.0], 1.0, LinearRgb::from_srgb8([90; 3]));
    Scene::new(&[sphere(0.0), sphere(3.0)]).unwrap()
}

fn settings(file: &str, words: &[&str]) -> Result<RenderSettings, SceneFileError> {
    let file = read(file, words)?;
    let scene = scene();
    let camera = PinholeCamera::framing_from_the_front(scene.subject(), 1.5).unwrap();
    file.settings(file.kind(), &scene, &camera, None)
}

#[track_caller]
fn studio(file: &str, words: &[&str]) -> Studio {
    match settings(file, words).unwrap().integrator {
        Integrator::Studio(studio) => studio,
        other => panic!("{other:?}"),
    }
}

const SCENE: &str = "style = \"studio\"\n[studio.outline]\nwidth = 3\n[sampling]\nseed = 4\n";

#[test]
fn a_flag_beats_a_file_and_a_file_beats_a_style() {
    let plain = studio("style = \"studio\"", &[]).outline.unwrap();
    let of_file = studio(SCENE, &[]).outline.unwrap();
    let of_flag = studio(SCENE, &["outline=5"]).outline.unwrap();
    assert_eq!([plain.width, of_file.width, of_flag.width], [1.0, 3.0, 5.0]);
    assert_eq!([of_file.color, of_flag.color], [plain.color; 2], "the rest is the style's");
    let bare = studio("[studio]", &["outline=2"]).outline.unwrap();
    assert_eq!(bare, Outline { width: 2.0, ..Outline::thin() }, "no layer below has an outline");
    let settings = settings(SCENE, &["samples=7"]).unwrap();
    assert_eq!((settings.sampling.samples, settings.sampling.seed), (7, 4));
    assert_eq!(studio(SCENE, &["outline=5", "set=studio.outline.width=6"]).outline.unwrap().width, 6.0);
}

#[test]
fn a_style_that_a_flag_names_changes_a_scene_or_says_why_not() {
    let file = read(SCENE, &["style=flat"]).unwrap();
    assert_eq!(file.style(), Some(Style::Flat));
    assert_eq!(file.kept_from_style(), ["studio.outline.width"]);
    let outline = studio(SCENE, &["style=flat"]).outline.unwrap();
    assert_eq!((outline.width, outline.color), (3.0, LinearRgb::BLACK));
    assert!(read(SCENE, &[]).unwrap().kept_from_style().is_empty());
    assert!(read("data = \"a.xyz\"", &["style=flat"]).unwrap().kept_from_style().is_empty());
}

#[test]
fn any_key_can_be_set() {
    let studio = studio("[studio]\nambient = \"red\"", &["set=studio.ambient=blue", "set=studio.occlusion.radius=5"]);
    assert_eq!(studio.ambient, LinearRgb::from_srgb8([0, 0, 255]));
    assert_eq!(studio.occlusion.unwrap().radius, Some(5.0));
    let lens = "[camera.pinhole]\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\nzoom = 2";
    let file = read(lens, &["set=camera.pinhole.zoom=3"]).unwrap();
    let camera = format!("{:?}", file.camera_parameters());
    assert!(camera.contains("zoom: Some(3.0)") && camera.contains("eye: Some"), "{camera}");
}

#[test]
fn errors_name_the_layer() {
    for (file, words, error) in [
        (SCENE, &["outline=100"][..], "--outline 100: it must be from 0.5 to 64 pixels"),
        ("[studio.outline]\n\nwidth = 100", &[], "line 3, column 9: `width` is 100; it must be from 0.5 to 64 pixels"),
        ("[sampling]\ndenoize = true", &[], "line 2, column 1: unknown key `denoize`; did you mean `denoise`?"),
        (SCENE, &["set=studio.outline.width=100"], "--set: `width` is 100; it must be from 0.5 to 64 pixels"),
        (SCENE, &["set=studio.outline.widht=1"], "--set: unknown key `widht`; did you mean `width`?"),
        (
            SCENE,
            &["style=studio", "background=gren"],
            "--background: `gren` is not a valid color; write a CSS name, \"#rrggbb\" or a linear triple [r, g, b]",
        ),
        (
            SCENE,
            &["integrator=path", "outline=2"],
            "--outline applies only to the integrator `studio`, but this picture is made by `path`; remove --outline or choose --integrator studio",
        ),
        (
            SCENE,
            &["integrator=primary", "samples=2"],
            "--samples applies only to the integrators `studio` and `path`, but this picture is made by `primary`; remove --samples or choose another --integrator or --style",
        ),
        (SCENE, &["angle=90"], "--angle does not apply to the pinhole camera; remove it"),
        ("", &["radius=2"], "--radius applies to the `data` of a scene, but this scene has no `data`; remove --radius"),
    ] {
        assert_eq!(settings(file, words).unwrap_err().to_string(), error);
    }
}

#[test]
fn a_view_is_a_key_as_it_is_a_flag() {
    let scene = scene();
    let camera = |file: &str, words: &[&str]| {
        let file = read(file, words).unwrap();
        file.camera(&file.film, &scene).unwrap().vectors()
    };
    let by_key = camera("[camera.pinhole]\nview = \"iso\"\nturn = 20", &[]);
    assert_eq!(by_key, camera("", &["view=iso", "turn=20"]));
    let file = read("[camera.pinhole]\nview = \"iso\"\neye = [1, 2, 3]", &[]).unwrap();
    let error = file.camera(&file.film, &scene).unwrap_err().to_string();
    assert!(error.ends_with("`view` excludes `eye`, `look_at` and `direction`; keep one"), "{error}");
}

/// A value that a flag takes.
fn example(flag: &Flag) -> &'static str {
    match (flag.name(), flag.value) {
        ("size", _) => "80x60",
        ("set", _) => "studio.shadows=false",
        ("columns", _) => "x,y,z",
        ("view", _) => "30,20",
        ("margin", _) => "10%",
        ("range", _) => "2%,5",
        ("radius-by", _) | ("emission-by", _) => "a*0.5",
        ("select" | "hide" | "ghost" | "focus", _) => "x > 1",
        ("show", _) => "x > 1 = sticks",
        ("define", _) => "mine=x > 1",
        ("legend" | "axes", _) => "right",
        ("bits", _) => "16",
        ("color" | "background" | "text-color" | "missing-color", _) => "teal",
        ("cmap", _) => "viridis",
        (_, Value::OneOf(names)) => names()[0].0,
        (_, Value::Numbers(2)) => "1,2",
        (_, Value::Numbers(_)) => "1,2,3",
        (_, Value::Switch) => "true",
        _ => "1",
    }
}

/// Every flag gives a key that is there.
#[test]
fn every_flag_reaches_a_setting() {
    let file = "data = \"a.xyz\"\ncolor_by = \"x\"\n[studio]\n";
    for flag in FLAGS {
        let value = example(flag);
        let reaches = |kind: &CameraKind| {
            let mut layers = vec![flag.layer(value, kind.name()).unwrap()];
            if flag.name() == "convergence" {
                layers.insert(0, flag_named("separation").layer("1", kind.name()).unwrap());
            }
            SceneFile::read(&Sources { file, flags: &layers, style: None })
        };
        let read: Vec<_> = CameraKind::ALL.iter().map(reaches).collect();
        let errors: Vec<String> = read.iter().filter_map(|read| Some(read.as_ref().err()?.to_string())).collect();
        let found = read.into_iter().find_map(Result::ok);
        let found = found.unwrap_or_else(|| panic!("{}: {errors:?}", flag.flag));
        assert_eq!(found.integrator(), Some(IntegratorKind::Studio), "{}", flag.flag);
    }
}

fn flag_named(name: &str) -> &'static Flag {
    Flag::of_name(name).unwrap()
}
