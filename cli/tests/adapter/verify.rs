//! Tests of `pinhole verify` on an adapter, and of replays of its recordings without one.

use std::process::Output;

use libtest_mimic::Trial;
use pinhole::gpu::Headless;
use pinhole::verify::run_file;
use tempfile::TempDir;

use crate::command;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("verify::a_recording_of_a_scene_is_legal_again", proved),
        trial("verify::no_sphere_and_one_pixel", small),
        trial("verify::paths_are_proved", paths),
        trial("verify::studios_are_proved", studio),
        trial("verify::run_files_have_no_light", runs_without_light),
        trial("verify::another_part_of_large_pictures", another_part),
        trial("verify::open_searches_say_what_is_legal", open_searches),
    ]
}

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let scene = include_str!("../../../examples/three-spheres.toml");
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    std::fs::write(folder.path().join("none.toml"), "").unwrap();
    folder
}

/// Runs a replay as on a machine without drivers.
#[track_caller]
fn replayed(folder: &TempDir, arguments: &str, code: i32) -> Output {
    let mut command = command(folder, arguments);
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env(variable, folder.path().join("no-driver.json"));
    }
    let output = command.output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments}: {stderr}");
    output
}

#[track_caller]
fn table(folder: &TempDir, arguments: &str) -> String {
    let output = command(folder, arguments).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), &*stderr), (Some(0), ""), "{arguments}");
    String::from_utf8(output.stdout).unwrap()
}

fn page_of(folder: &TempDir, page: &str) -> serde_json::Value {
    let page = std::fs::read_to_string(folder.path().join(page).join("report.html")).unwrap();
    let (_, data) = page.split_once("type=\"application/json\">").unwrap();
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

fn proved(headless: &'static Headless) {
    let folder = folder();
    let found = table(&folder, "verify scene.toml --save run --json a.json --report page");
    let adapter = &headless.adapter_info().name;
    assert!(found.starts_with(&format!("adapter: {adapter} (")), "{found}");
    assert!(found.contains("\nscene: 3 spheres, 48 bytes, sha256 "), "{found}");
    assert!(found.contains("\npicture: 800x600, pinhole camera"), "{found}");
    assert!(found.ends_with("\nlegal: every pixel is as a conforming device may have made it\n"));

    assert!(found.contains("\nrendered               0  pixels differ from the recorded ones\n"));

    let again = replayed(&folder, "verify --replay run --json b.json --report again", 0);
    assert_eq!(String::from_utf8(again.stdout).unwrap(), found);
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(read("a.json") == read("b.json"), "the documents differ");
    assert!(read("page/report.html") == read("again/report.html"), "the pages differ");
    let json: serde_json::Value = serde_json::from_slice(&read("a.json")).unwrap();
    assert_eq!(json["rendered_otherwise"], 0);
    assert_eq!(page_of(&folder, "page")["report"], json);
    // The recording is the same with every structure, and the run names the structure.
    table(&folder, "verify scene.toml --save tree --accel tree");
    let (first, second) = (read("run"), read("tree"));
    let [first, second] = [&first, &second].map(|bytes| run_file::read(bytes).unwrap());
    assert_eq!(second.provenance.structure, "8-wide tree");
    assert!(first.recording == second.recording, "the recordings differ");
}

fn small(_: &'static Headless) {
    let folder = folder();
    for arguments in [
        "verify none.toml --size 40x30 --save run --report page",
        "verify scene.toml --size 1x1 --save run --report page",
        "verify none.toml --size 1x1 --save run --report page",
    ] {
        let found = table(&folder, arguments);
        let again = replayed(&folder, "verify --replay run", 0);
        assert_eq!(String::from_utf8(again.stdout).unwrap(), found, "{arguments}");
    }
}

const PATHS: &str = "integrator = 'path'\n[film]\nwidth = 40\nheight = 30\n[camera.pinhole]\neye = [0, 1, 6]\n\
                     look_at = [0, 0, 0]\n[ground]\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'tomato'\n";

fn paths(_: &'static Headless) {
    let folder = folder();
    std::fs::write(folder.path().join("paths.toml"), PATHS).unwrap();
    let found = table(&folder, "verify paths.toml --paths 3 --json a.json --report page");
    assert!(found.contains("\n3600 paths, ") && found.contains(", 0 violations\n"), "{found}");
    let json = std::fs::read_to_string(folder.path().join("a.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["paths"]["paths"], 3600);
    let page = page_of(&folder, "page");
    assert_eq!((&page["report"], &page["shown_samples"]), (&json, &16.into()));
    assert!(page["pictures"]["light"].is_string(), "{page}");
    assert_eq!(json["paths"]["stages"]["start"]["checked"], 3600);
    let share = "18.75 % of the samples of its light (3 of 16 in 1200 of 1200 pixels), are as";
    assert!(found.contains(&format!("\nlegal: every pixel by one ray, and {share}")), "{found}");
    let judged = &json["paths"]["judged"];
    assert_eq!((&judged["samples"], &judged["fraction"]), (&3.into(), &0.1875.into()));
    assert_eq!((&json["paths"]["legal"], &json["legal"]), (&true.into(), &true.into()));
    // Without path tracing, the document has no key about paths.
    table(&folder, "verify scene.toml --size 8x6 --json b.json");
    let json = std::fs::read_to_string(folder.path().join("b.json")).unwrap();
    assert!(!json.contains("paths"), "{json}");
    let refused = command(&folder, "verify scene.toml --paths 2").output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
}

fn studio(_: &'static Headless) {
    let folder = folder();
    std::fs::write(folder.path().join("studio.toml"), PATHS.replace("'path'", "'studio'")).unwrap();
    let found = table(&folder, "verify studio.toml --paths 2 --json a.json --report page");
    assert!(found.contains("\n2400 samples, ") && found.contains(", 0 violations\n"), "{found}");
    let json = std::fs::read_to_string(folder.path().join("a.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!((&json["studio"]["samples"], &json["paths"]), (&2400.into(), &().into()));
    assert_eq!(json["studio"]["stages"]["accumulate"]["checked"], 2400);
    assert_eq!((&json["studio"]["legal"], &json["legal"]), (&true.into(), &true.into()));
    assert_eq!(page_of(&folder, "page")["report"], json);
}

/// A run file has no light, so that a replay is about the picture by one ray for each pixel.
fn runs_without_light(_: &'static Headless) {
    let folder = folder();
    let denoised = PATHS.replace("[film]", "[sampling]\nsamples = 4\ndenoise = true\n[film]");
    std::fs::write(folder.path().join("paths.toml"), denoised).unwrap();
    let output = command(&folder, "verify paths.toml --save run --report page").output().unwrap();
    let (found, note) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(0), "{note}");
    assert!(note.starts_with("note: run files do not keep light: ") && note.lines().count() == 1, "{note}");
    for words in ["\n1200 paths, ", "\ndenoiser: 1200 pixels: ", "\npicture of render, 4 of 4 samples: "] {
        assert!(found.contains(words), "{found} lacks {words}");
    }
    assert!(page_of(&folder, "page")["pictures"]["light"].is_string());
    let again = replayed(&folder, "verify --replay run --json b.json --report again", 0);
    let again = String::from_utf8(again.stdout).unwrap();
    assert!(again.ends_with("\nlegal: every pixel is as a conforming device may have made it\n"), "{again}");
    let page = page_of(&folder, "again");
    assert_eq!((&page["pictures"]["light"], &page["report"]["paths"]), (&().into(), &().into()));
    assert_eq!(page["report"]["counts"], page_of(&folder, "page")["report"]["counts"]);
}

/// Light in a large picture is checked in the middle and in another part, and the page says which part was not checked.
fn another_part(_: &'static Headless) {
    let folder = folder();
    let large = PATHS.replace("width = 40\nheight = 30", "width = 300\nheight = 8");
    std::fs::write(folder.path().join("large.toml"), large).unwrap();
    let run = |arguments: &str| {
        let arguments = format!("verify large.toml --json a.json {arguments}");
        let output = command(&folder, &arguments).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments}: {stderr}");
        let json = std::fs::read_to_string(folder.path().join("a.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(json["paths"]["paths"], 224 * 8 + 112 * 4);
        (json["paths"]["rectangles"].to_string(), stderr)
    };
    let (first, note) = run("--report page");
    assert!(first.starts_with("[[38,0,224,8],["), "{first}");
    let seed = note.trim().rsplit(' ').next().unwrap();
    assert!(note.contains(" to check the same again, add --tile-seed "), "{note}");
    assert_eq!(run(&format!("--tile-seed {seed}")).0, first);
    let others: std::collections::BTreeSet<_> = (0..4).map(|seed| run(&format!("--tile-seed {seed}")).0).collect();
    assert!(others.len() > 1, "{others:?}");
    assert_eq!(page_of(&folder, "page")["report"]["paths"]["rectangles"].to_string(), first);
    let refused = command(&folder, "verify scene.toml --tile-seed 2").output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
}

/// Two spheres have the same surface apart from rounding, and a lamp lies on the surface of another. The checker says
/// which of the spheres may be seen, and which may hide the lamp.
fn open_searches(_: &'static Headless) {
    let folder = folder();
    let ties = "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1.0000001\n";
    let lamp = "[[spheres]]\ncenter = [0, 3.5, 0]\nradius = 0.5\n[[lights]]\nkind = 'point'\n\
                position = [0, 3, 0]\nintensity = 9\n";
    let hidden = "hidden or not: sphere 1, which ends where the search does";
    for (kind, more, stage, words, code) in [
        // The picture with one ray per pixel has too many ties.
        ("path", ties, "extend", ["sphere 0 at ", "sphere 1 at "], 4),
        ("studio", ties, "extend", ["sphere 0 at ", "sphere 1 at "], 4),
        ("path", lamp, "occlude", [hidden; 2], 0),
        ("studio", lamp, "shadow", [hidden; 2], 0),
    ] {
        let scene = format!("{PATHS}{more}").replace("'path'", &format!("'{kind}'"));
        std::fs::write(folder.path().join("open.toml"), scene).unwrap();
        let arguments = "verify open.toml --json a.json --report page";
        let output = command(&folder, arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        let table = String::from_utf8(output.stdout).unwrap();
        assert!(table.contains("\nopen: pixel ("), "{table}");
        let json = std::fs::read_to_string(folder.path().join("a.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let light = if kind == "path" { &json["paths"] } else { &json["studio"] };
        let mut all = light["open"].as_array().unwrap().iter();
        let is_named = |open: &serde_json::Value| {
            let legal = open["legal"].as_array().unwrap();
            let has = |words| legal.iter().any(|one| one.as_str().unwrap().starts_with(words));
            open["stage"] == stage && legal.len() <= 4 && words.into_iter().all(has)
        };
        assert!(all.any(is_named), "{kind} {stage}: {light}");
        assert_eq!(page_of(&folder, "page")["report"], json);
    }
}
