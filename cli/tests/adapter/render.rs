//! Tests that the program writes what the library renders, on an adapter.

use std::io::Cursor;

use libtest_mimic::Trial;
use pinhole::gpu::{Headless, Wait};
use pinhole::image::color;
use pinhole::{Encoding, LayerSet};
use pinhole_figure::scene_file::SceneFile;
use pinhole_figure::write;
use pinhole_figure::write::exr::Remarks;

use crate::trial;
use crate::view::View;
use crate::{command, command_on, succeed};

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("profile::the_table_holds_the_passes_of_the_device", table_of_a_profile),
        trial("render::the_demo_renders_on_the_adapter", demo),
        trial("render::an_exr_holds_what_the_adapter_rendered", exr),
        trial("render::info_lists_the_adapter", info),
        trial("render::self_test_of_the_adapter", self_test),
    ]
}

fn demo(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    succeed(&mut command(&folder, "demo --backend gpu"));
    let file = SceneFile::parse(include_str!("../../../examples/demo.toml")).unwrap();
    let scene = file.scene().unwrap();
    let camera = file.camera(&file.film, &scene).unwrap();
    let kind = file.integrator().unwrap();
    let settings = file.settings(kind, &scene, camera.as_ref(), None).unwrap();
    let view = pinhole::View::new(camera.as_ref(), file.film);
    let expected = headless.render(&scene, &view, &settings, LayerSet::COLOR).wait().unwrap();
    let expected: Vec<u8> = expected.color().iter().flat_map(|c| color::to_srgb8(*c)).collect();
    let picture = image::open(folder.path().join("demo.png")).unwrap().to_rgb8();
    assert!(picture.into_raw() == expected, "the demo's picture is not the library's");
}

fn exr(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    let scene = include_str!("../../../examples/three-spheres.toml");
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let adapter = &headless.adapter_info().name;
    let mut command = command_on(headless, &folder, "render scene.toml -o out.exr");
    for layer in LayerSet::ALL.iter() {
        command.args(["--layer", layer.name()]);
    }
    succeed(&mut command);

    let view = View::three_spheres();
    let image = headless.render(&view.scene, &view.seen(), &view.settings, LayerSet::ALL).wait().unwrap();
    let mut expected = Cursor::new(Vec::new());
    let encoding = Encoding::default();
    let remarks = Remarks { adapter: Some(adapter), ..Remarks::default() };
    write::exr::write(&image, LayerSet::ALL, &encoding, remarks, &mut expected).unwrap();
    let found = std::fs::read(folder.path().join("out.exr")).unwrap();
    assert!(found == expected.into_inner(), "the file is not the library's");
}

fn self_test(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    let name = &headless.adapter_info().name;
    let output = succeed(&mut command_on(headless, &folder, "info --self-test --json"));
    let info: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(!info["adapters"].as_array().unwrap().is_empty());
    let tested = &info["self_test"];
    assert_eq!((&tested["adapter"]["name"], &tested["passed"]), (&name.as_str().into(), &true.into()));
    let properties = tested["properties"].as_array().unwrap();
    assert_eq!(properties.len(), 11);
    let output = succeed(&mut command(&folder, "info --self-test"));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains(name), "{text}");
    for property in properties {
        assert_eq!(property["passed"], true);
        assert!(property["figures"]["tested"].as_f64().unwrap() > 0.0, "{property}");
        let [outcome, name, words] = ["outcome", "name", "words"].map(|key| property[key].as_str().unwrap());
        assert!(outcome == "ok" || outcome == "note", "{outcome}");
        assert!(text.contains(&format!("  {outcome:<6}  {name}: {words}\n")), "{text}");
    }
}

fn info(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    let output = succeed(&mut command(&folder, "info --json"));
    let info: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let adapters = info["adapters"].as_array().unwrap();
    let chosen: Vec<_> = adapters.iter().filter(|a| a["chosen"] == true).collect();
    assert_eq!(chosen.len(), 1);
    let expected = headless.adapter_info();
    assert_eq!(chosen[0]["name"], expected.name);
    assert_eq!(chosen[0]["driver"], expected.driver);
    assert_eq!(chosen[0]["driver_info"], expected.driver_info);
    let limit = &chosen[0]["limits"]["max_storage_buffer_binding_size"];
    let device_limit = headless.device().limits().max_storage_buffer_binding_size;
    assert_eq!(limit.as_u64(), Some(device_limit));
    let output = succeed(&mut command(&folder, "info"));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains(&expected.name) && text.contains("used by `render`"), "{text}");
}

/// `--profile` changes no picture, and its table has the passes of the device.
fn table_of_a_profile(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), include_str!("../../../examples/studio.toml")).unwrap();
    let picture = |arguments: &str| {
        let arguments = format!("render scene.toml -o out.png --samples 2 --size 90x60{arguments}");
        let run = succeed(&mut command_on(headless, &folder, &arguments));
        let picture = std::fs::read(folder.path().join("out.png")).unwrap();
        (picture, String::from_utf8(run.stderr).unwrap())
    };
    let (without, _) = picture("");
    let (with, text) = picture(" --profile");
    assert!(with == without, "the picture depends on the profile");
    let (host, device) = text.split_once("\n  device").unwrap();
    assert!(device.lines().count() > 1, "{text}");
    for name in ["open device", "self-test", "plan", "build", "upload", "submit", "wait"] {
        assert!(host.contains(&format!("\n    {name} ")), "{name}: {text}");
    }
}
