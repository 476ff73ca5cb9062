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
        trial("verify::saved_light_is_legal_again", saved_light),
        trial("verify::another_part_of_large_pictures", another_part),
        trial("verify::planted_faults_are_shown", planted),
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

/// A replay reports the same about light as the recording, with the same page.
fn saved_light(_: &'static Headless) {
    let folder = folder();
    let studio = PATHS.replace("'path'", "'studio'") + "opacity = 0.5\n[studio.occlusion]\n";
    std::fs::write(folder.path().join("studio.toml"), studio).unwrap();
    let denoised = PATHS.replace("[film]", "[sampling]\nsamples = 4\ndenoise = true\n[film]");
    std::fs::write(folder.path().join("paths.toml"), denoised).unwrap();
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    for (scene, words) in
        [("studio", "\n2400 samples, "), ("paths", "\n2400 paths, "), ("paths", "\ndenoiser: 1200 pixels: ")]
    {
        let found = table(&folder, &format!("verify {scene}.toml --paths 2 --save run --json a.json --report page"));
        assert!(found.contains(words), "{found}");
        let again = replayed(&folder, "verify --replay run --json b.json --report again", 0);
        assert_eq!(String::from_utf8(again.stdout).unwrap(), found);
        assert!(read("a.json") == read("b.json"), "the documents differ");
        assert!(read("page/report.html") == read("again/report.html"), "the pages differ");
        assert!(page_of(&folder, "page")["pictures"]["light"].is_string());
        // A byte of a state is changed, and the file is cut off.
        let mut bytes = read("run");
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        std::fs::write(folder.path().join("altered"), &bytes).unwrap();
        std::fs::write(folder.path().join("cut"), &bytes[..middle]).unwrap();
        for (file, words) in [("altered", "was altered after"), ("cut", "is cut off")] {
            let output = replayed(&folder, &format!("verify --replay {file} --json c.json"), 1);
            let stderr = String::from_utf8(output.stderr).unwrap();
            assert!(stderr.contains(words) && stderr.lines().count() == 1, "{stderr}");
        }
        assert!(!folder.path().join("c.json").exists());
    }
    // No temporary file is left behind.
    let names = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(names.into_iter().all(|name| !name.to_string_lossy().starts_with(".pinhole")));
    let refused = command(&folder, "verify paths.toml --paths 3000 --save run").output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
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
    let (first, note) = run("--save run --report page");
    assert!(first.starts_with("[[38,0,224,8],["), "{first}");
    let seed = note.trim().rsplit(' ').next().unwrap();
    assert!(note.contains(" to check the same again, add --tile-seed "), "{note}");
    assert_eq!(run(&format!("--tile-seed {seed}")).0, first);
    let others: std::collections::BTreeSet<_> = (0..4).map(|seed| run(&format!("--tile-seed {seed}")).0).collect();
    assert!(others.len() > 1, "{others:?}");
    replayed(&folder, "verify --replay run --report again", 0);
    let page = page_of(&folder, "page");
    assert_eq!(page, page_of(&folder, "again"));
    assert_eq!(page["report"]["paths"]["rectangles"].to_string(), first);
    let refused = command(&folder, "verify scene.toml --tile-seed 2").output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
}

/// A state that does not follow from the one before is shown with the pixels around it.
fn planted(_: &'static Headless) {
    let folder = folder();
    std::fs::write(folder.path().join("paths.toml"), PATHS).unwrap();
    table(&folder, "verify paths.toml --save run");
    let path = folder.path().join("run");
    let mut bytes = std::fs::read(&path).unwrap();
    let length = u64::from_le_bytes(*bytes.first_chunk().unwrap()) as usize;
    let header: serde_json::Value = serde_json::from_slice(&bytes[8..8 + length]).unwrap();
    let offset = header["sample_0_states"]["data_offsets"][0].as_u64().unwrap();
    // The radiance of the pixel at (20, 15), the red of its fifth slot, is changed.
    let at = 8 + length + offset as usize;
    let at = at + (15 * 40 + 20) * 9 * 16 + 4 * 16;
    let mut number = [0; 4];
    number.copy_from_slice(&bytes[at..at + 4]);
    let brighter = f32::from_le_bytes(number) + 0.5;
    bytes[at..at + 4].copy_from_slice(&brighter.to_le_bytes());
    std::fs::write(&path, signed(bytes)).unwrap();
    let output = replayed(&folder, "verify --replay run --report page", 3);
    let stderr = String::from_utf8(output.stderr).unwrap();
    let words = "error: the paths are not legal: ";
    assert!(stderr.starts_with(words) && stderr.lines().count() == 1, "{stderr}");
    assert!(stderr.contains("the first is pixel (20, 15), sample 15, surface 0, "), "{stderr}");
    let violation = &page_of(&folder, "page")["report"]["paths"]["violations"][0];
    assert_eq!(violation["pixel"], serde_json::json!([20, 15]));
    assert_eq!((&violation["sample"], &violation["surface"]), (&15.into(), &0.into()));
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
        let arguments = "verify open.toml --json a.json --report page --save run";
        let output = command(&folder, arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        let table = String::from_utf8(output.stdout).unwrap();
        assert!(table.contains("\nopen: pixel ("), "{table}");
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
        let json: serde_json::Value = serde_json::from_str(&read("a.json")).unwrap();
        let light = if kind == "path" { &json["paths"] } else { &json["studio"] };
        let mut all = light["open"].as_array().unwrap().iter();
        let is_named = |open: &serde_json::Value| {
            let legal = open["legal"].as_array().unwrap();
            let has = |words| legal.iter().any(|one| one.as_str().unwrap().starts_with(words));
            open["stage"] == stage && legal.len() <= 4 && words.into_iter().all(has)
        };
        assert!(all.any(is_named), "{kind} {stage}: {light}");
        let again = replayed(&folder, "verify --replay run --json b.json --report again", code);
        assert_eq!(String::from_utf8(again.stdout).unwrap(), table);
        assert!(read("a.json") == read("b.json"), "the documents differ");
        assert!(read("page/report.html") == read("again/report.html"), "the pages differ");
    }
}

/// Adds the digest that a run file needs.
fn signed(mut bytes: Vec<u8>) -> Vec<u8> {
    let before = b"\"sha256\":\"";
    let place = bytes.windows(before.len()).position(|window| window == before).unwrap();
    let digits = place + before.len()..place + before.len() + 64;
    bytes[digits.clone()].fill(b'0');
    let digest = data_encoding::HEXLOWER
        .encode(&sha2::Digest::finalize(<sha2::Sha256 as sha2::Digest>::new_with_prefix(&bytes)));
    bytes[digits].copy_from_slice(digest.as_bytes());
    bytes
}
