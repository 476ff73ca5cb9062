//! Tests of `render --profile` on an adapter.

use libtest_mimic::Trial;
use pinhole::gpu::Headless;

use crate::program::{command_on, succeed};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![trial("profile::the_table_holds_the_passes_of_the_device", table)]
}

fn table(headless: &'static Headless) {
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
    let (with, text) = picture(" --profile");
    assert!(with == without, "the picture depends on the profile");
    let (host, device) = text.split_once("\n  device").unwrap();
    assert!(device.lines().count() > 1, "{text}");
    for name in ["open device", "self-test", "plan", "build", "upload", "submit", "wait"] {
        assert!(host.contains(&format!("\n    {name} ")), "{name}: {text}");
    }
}
