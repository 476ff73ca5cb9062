//! Tests of `render --profile` on an adapter.

use libtest_mimic::Trial;
use pinhole::gpu::Headless;
use serde_json::Value;

use crate::program::{command_on, succeed};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![trial("profile::the_trace_holds_the_passes_of_the_device", trace)]
}

fn trace(headless: &'static Headless) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), include_str!("../../../examples/studio.toml"))
        .unwrap();
    let picture = |arguments: &str| {
        let arguments = format!("render scene.toml -o out.png --samples 2 --size 90x60{arguments}");
        let run = succeed(&mut command_on(headless, &folder, &arguments));
        let picture = std::fs::read(folder.path().join("out.png")).unwrap();
        (picture, String::from_utf8(run.stderr).unwrap())
    };
    let (without, _) = picture("");
    let (with, text) = picture(" --profile=a.json");
    assert!(with == without, "the picture depends on the profile");
    assert!(text.contains("passes by the "), "{text}");
    let trace = std::fs::read(folder.path().join("a.json")).unwrap();
    let trace: Vec<Value> = serde_json::from_slice(&trace).unwrap();
    let tracks: Vec<_> = trace.iter().filter(|event| event["ph"] == "M").collect();
    let of_device = tracks.iter().find(|track| track["args"]["name"] == "device").unwrap();
    let passes: Vec<_> = trace
        .iter()
        .filter(|event| event["ph"] == "X" && event["tid"] == of_device["tid"])
        .collect();
    assert!(!passes.is_empty() && passes.iter().all(|pass| pass["cat"] == "device"));
    for name in ["open device", "self-test", "plan", "build", "upload", "submit", "wait"] {
        assert!(trace.iter().any(|event| event["name"] == name), "{name}: {text}");
    }
}
