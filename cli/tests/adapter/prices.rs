//! Tests of measured prices: measuring and keeping them, and files that are of no use.

use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::Trial;
use pinhole::gpu::Headless;
use tempfile::TempDir;

use crate::program::{command_on, succeed};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("prices::they_are_measured_and_used", measured),
        trial("prices::they_decide_on_the_structure", decide),
        trial("prices::a_file_of_no_use_is_ignored_with_a_note", ignored),
        trial("prices::a_folder_that_cannot_be_written_is_a_note", unwritable),
    ]
}

/// The program with the cache folder `cache` of the folder.
fn program(headless: &Headless, folder: &TempDir, arguments: &str) -> Command {
    let mut command = command_on(headless, folder, arguments);
    command.env("XDG_CACHE_HOME", folder.path().join("cache"));
    command
}

fn file(folder: &TempDir) -> PathBuf {
    folder.path().join("cache").join("pinhole").join("prices.json")
}

fn stdout(command: &mut Command) -> String {
    String::from_utf8(succeed(command).stdout).unwrap()
}

/// A folder with 3000 spheres, and a command that plans 10,000 rays.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let generate = ["generate", "random", "-n", "3000", "-o", "a.npy"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_pinhole"));
    succeed(command.current_dir(folder.path()).args(generate));
    folder
}

const PLAN: &str = "plan a.npy --size 100x100 --style fast --json";

fn plan(headless: &Headless, folder: &TempDir) -> serde_json::Value {
    serde_json::from_str(&stdout(&mut program(headless, folder, PLAN))).unwrap()
}

fn measured(headless: &'static Headless) {
    let folder = folder();
    let before = plan(headless, &folder);
    assert!(before["prices"].as_str().unwrap().starts_with("built-in, for "), "{before}");
    let text = stdout(&mut program(headless, &folder, "bench --calibrate --json"));
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(report["adapter"]["name"], headless.adapter_info().name);
    assert_eq!(report["file"].as_str().map(Path::new), Some(&*file(&folder)));
    let structures = report["structures"].as_array().unwrap();
    assert_eq!(structures.len(), 3);
    for structure in structures {
        assert!(structure["tracing"].as_f64().unwrap() > 0.0, "{text}");
        assert!(structure["building"].as_f64().unwrap() > 0.0, "{text}");
    }
    let after = plan(headless, &folder);
    let words = format!("measured on {}", report["measured_on"].as_str().unwrap());
    assert_eq!(after["prices"], words);
    let text = stdout(&mut program(headless, &folder, "plan a.npy --style fast"));
    assert!(text.contains(&format!("prices: {words}\n")), "{text}");
    let text =
        stdout(&mut program(headless, &folder, "bench a.npy --size 32x24 --reps 1 --counts"));
    assert!(text.contains(&words) && text.contains("for each ray"), "{text}");
    let mut info = Command::new(env!("CARGO_BIN_EXE_pinhole"));
    info.arg("info").env("XDG_CACHE_HOME", folder.path().join("cache"));
    let text = stdout(&mut info);
    assert!(text.contains(&format!("  prices: {words}\n")), "{text}");
}

/// The text of a file that gives the adapter other prices.
fn priced(headless: &Headless, change: impl Fn(&mut serde_json::Value)) -> String {
    let info = headless.adapter_info();
    let structure =
        || serde_json::json!({ "ray": 1, "step": 1, "element": 1, "sphere": 1, "build": 1 });
    let mut kept = serde_json::json!({
        "version": 1,
        "adapters": [{
            "name": info.name,
            "backend": format!("{:?}", info.backend),
            "driver": info.driver,
            "driver_info": info.driver_info,
            "measured_on": "2026-11-22",
            "prices": {
                "references": structure(), "balls": structure(), "tree": structure(), "upload_byte": 0,
            },
        }],
    });
    change(&mut kept);
    kept.to_string()
}

fn write(folder: &TempDir, text: &str) {
    std::fs::create_dir_all(file(folder).parent().unwrap()).unwrap();
    std::fs::write(file(folder), text).unwrap();
}

fn decide(headless: &'static Headless) {
    let folder = folder();
    for (cheap, name) in [
        ("references", "grid, cells refer to spheres"),
        ("balls", "grid, cells have balls"),
        ("tree", "8-wide tree"),
    ] {
        let text = priced(headless, |kept| {
            for structure in ["references", "balls", "tree"] {
                let price = if structure == cheap { 1 } else { 1_000_000 };
                kept["adapters"][0]["prices"][structure]["ray"] = price.into();
            }
        });
        write(&folder, &text);
        let plan = plan(headless, &folder);
        assert_eq!(plan["structure"]["name"], name, "{plan}");
        assert_eq!(plan["prices"], "measured on 2026-11-22");
    }
}

fn ignored(headless: &'static Headless) {
    let folder = folder();
    let built_in = plan(headless, &folder);
    let stale = priced(headless, |kept| kept["adapters"][0]["driver_info"] = "old".into());
    let version = priced(headless, |kept| kept["version"] = 99.into());
    for (text, why) in [
        ("{", "damaged: "),
        (&stale, "measured for "),
        (&version, "written by another version of pinhole (99, not 1)"),
    ] {
        write(&folder, text);
        let output = succeed(&mut program(headless, &folder, PLAN));
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
        for words in ["note: ", "prices.json: ", why, "`pinhole bench --calibrate`"] {
            assert!(stderr.contains(words), "{stderr} lacks {words}");
        }
        let plan: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(plan["structure"], built_in["structure"]);
        assert_eq!(plan["prices"], built_in["prices"]);
        let render = "render a.npy -o a.png --size 20x10 --style fast";
        let output = succeed(&mut program(headless, &folder, render));
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(stderr.matches("prices.json: ").count(), 1, "{stderr}");
        let output = succeed(&mut program(headless, &folder, &format!("{render} --quiet")));
        assert!(output.stderr.is_empty(), "{output:?}");
    }
}

fn unwritable(headless: &'static Headless) {
    let folder = folder();
    // A file where the folder should be.
    std::fs::write(folder.path().join("cache"), "").unwrap();
    let output = succeed(&mut program(headless, &folder, "bench --calibrate"));
    let stderr = String::from_utf8(output.stderr).unwrap();
    for words in ["note: ", "prices.json: cannot be written", "XDG_CACHE_HOME"] {
        assert!(stderr.contains(words), "{stderr} lacks {words}");
    }
    assert!(String::from_utf8(output.stdout).unwrap().ends_with("; not kept\n"));
}
