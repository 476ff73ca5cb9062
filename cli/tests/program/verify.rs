//! Tests of `pinhole verify` without an adapter: replays of handmade recordings, and errors.

use pinhole::camera::{Camera, OrthographicCamera, Pose};
use pinhole::verify::run_file::{self, Provenance, Run};
use pinhole::verify::{PlainRender, Recording, RequestedCamera, TracedPixel, UploadedView};
use pinhole::{Film, LayerSet, LinearRgb, RenderSettings, Scene, View, cpu};

use crate::support::{Folder, SCENE};

/// A recording of an empty scene, which has the same bits on every device.
fn nothing([width, height]: [u32; 2]) -> Run {
    let scene = Scene::from_f32(Vec::new(), LinearRgb::WHITE).unwrap();
    let pose = Pose::looking_along([0.0, 0.0, 4.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
    let camera = OrthographicCamera::new(pose, [1.0, 1.0]).unwrap();
    let film = Film::new(width, height).unwrap();
    let settings = RenderSettings::default();
    let vectors = camera.vectors();
    let narrow = |v: pinhole::glam::DVec3| v.as_vec3().to_array();
    let recording = Recording {
        camera: RequestedCamera { kind: camera.kind(), vectors },
        uploaded: UploadedView {
            origin: narrow(vectors.origin),
            advance: 0.0,
            right: narrow(vectors.right),
            up: narrow(vectors.up),
            forward: narrow(vectors.forward),
            numbers: vectors.numbers.map(|number| number as f32),
            // No ray meets this box.
            scene_min: [10.0; 3],
            scene_max: [11.0; 3],
        },
        film,
        primary: settings.primary().unwrap(),
        pixels: vec![TracedPixel { ray: None, t: 1e30, id: u32::MAX, shading_ray: None }; (width * height) as usize],
        image: cpu::render(&scene, &View::new(&camera, film), &settings, LayerSet::DATA).unwrap(),
        rendered: PlainRender::None,
    };
    let text = str::to_owned;
    let provenance = Provenance {
        version: text("0.1.0"),
        command: text("pinhole verify <b>.toml"),
        adapter: text("By </script><i>hand</i> & \u{1b}[31m"),
        structure: text("list"),
        ..Provenance::default()
    };
    Run { scene, recording, provenance }
}

fn bytes(Run { scene, recording, provenance }: &Run) -> Vec<u8> {
    let mut bytes = Vec::new();
    run_file::write(scene, recording, provenance, &mut bytes).unwrap();
    bytes
}

fn folder() -> Folder {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    std::fs::write(folder.path("run"), bytes(&nothing([3, 2]))).unwrap();
    std::fs::write(folder.path("one"), bytes(&nothing([1, 1]))).unwrap();
    // The picture is white, but the background of the view is black.
    let mut wrong = nothing([30, 20]);
    wrong.recording.primary.background = LinearRgb::BLACK;
    std::fs::write(folder.path("wrong"), bytes(&wrong)).unwrap();
    let mut other_view = nothing([3, 2]);
    other_view.recording.uploaded.right[0] *= 1.5;
    std::fs::write(folder.path("other-view"), bytes(&other_view)).unwrap();
    folder
}

#[test]
fn a_replay_needs_no_adapter() {
    let folder = folder();
    let run = folder.run_without_drivers("verify --replay run --json a.json --report a/");
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    let table = String::from_utf8(run.stdout).unwrap();
    for line in [
        "adapter: By </script><i>hand</i> & \\u{1b}[31m (, ), driver: (hearsay)",
        "scene: 0 spheres, 0 bytes, sha256 e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855",
        "picture: 3x2, orthographic camera",
        "structure: list",
        "decided                6  100.0000 %",
        "legal: every pixel is as a conforming device may have made it",
    ] {
        assert!(table.lines().any(|found| found.trim_end() == line), "{table} lacks {line}");
    }
    assert_eq!(table.lines().last(), table.lines().find(|line| line.starts_with("legal: ")));

    let json: serde_json::Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
    assert_eq!(json["version"], "0.1.0");
    assert_eq!(json["hearsay"][0], "adapter");
    assert_eq!(json["adapter"]["name"], "By </script><i>hand</i> & \u{1b}[31m");
    assert_eq!(json["scene"]["spheres"], 0);
    assert_eq!(json["picture"]["width"], 3);
    assert_eq!(json["counts"]["decided"], 6);
    assert_eq!(json["decided_fraction"], 1.0);
    assert_eq!((&json["legal"], &json["upload"]), (&true.into(), &serde_json::Value::Null));
    assert_eq!(json["violations"].as_array().unwrap().len(), 0);
    assert_eq!(json["command"], "pinhole verify <b>.toml");
    for key in ["worst_depth", "worst_normal"] {
        assert!(json[key].is_f64(), "{key}");
    }
}

fn data_of(page: &str) -> serde_json::Value {
    let (_, data) = page.split_once("type=\"application/json\">").unwrap();
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn the_page_needs_no_other_files_and_escapes_foreign_text() {
    let folder = folder();
    folder.run("verify --replay run --report a").succeeded();
    let page = String::from_utf8(folder.read("a/report.html")).unwrap();
    let data = data_of(&page);
    assert_eq!(data["verdict"], "legal: every pixel is as a conforming device may have made it");
    assert_eq!(data["report"]["adapter"]["name"], "By </script><i>hand</i> & \u{1b}[31m");
    assert_eq!(data["report"]["command"], "pinhole verify <b>.toml");
    assert_eq!(data["run_file"], "run");
    assert_eq!(page.matches("data:image/png;base64,").count(), 3);
    // The page has two scripts, the data and the code that shows it, and foreign text only in the data.
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(page.matches("</script").count(), 2);
    for outside in ["http:", "https:", "src=", "url(", "@import", "<link", "innerHTML", "<i>"] {
        assert!(!page.contains(outside), "{outside}");
    }
    // The folder and the page exist already.
    folder.run("verify --replay one --report a").succeeded();
    assert_eq!(folder.files(), ["a", "one", "other-view", "run", "scene.toml", "wrong"]);
}

#[test]
fn a_violation_gives_exit_code_3_and_all_files() {
    let folder = folder();
    let run = folder.run("verify --replay wrong --json a.json --report a");
    assert_eq!(run.code, 3, "{}", run.stderr);
    let line = "error: the picture is not legal: 600 of 600 pixels; the first is pixel (0, 0), color: \
                red is 1.0; legal is 0.0\n";
    assert_eq!(run.stderr, line);
    let table = String::from_utf8(run.stdout).unwrap();
    assert!(table.ends_with("NOT legal: 600 violations\n"), "{table}");
    let json: serde_json::Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
    assert_eq!((&json["legal"], &json["counts"]["violation"]), (&false.into(), &600.into()));
    let violations = json["violations"].as_array().unwrap();
    assert_eq!(violations.len(), 100);
    assert_eq!(violations[31]["pixel"], serde_json::json!([1, 1]));
    assert_eq!(violations[31]["stage"], "color");
    assert_eq!(violations[31]["message"], "red is 1.0; legal is 0.0");
    let page = String::from_utf8(folder.read("a/report.html")).unwrap();
    assert_eq!(data_of(&page)["report"], json);
    assert_eq!(data_of(&page)["verdict"], "NOT legal: 600 violations");

    let run = folder.run("verify --replay other-view --json b.json --report b");
    run.refused(3, "not legal: the camera's vector right is [1.5, 0.0, 0.0] on the device");
    let json: serde_json::Value = serde_json::from_slice(&folder.read("b.json")).unwrap();
    assert!(json["upload"].as_str().unwrap().contains("vector right"));
    let page = String::from_utf8(folder.read("b/report.html")).unwrap();
    let data = data_of(&page);
    assert_eq!((&data["report"], &data["pictures"]["verdicts"]), (&json, &().into()));
}

#[test]
fn runs_that_are_damaged() {
    let folder = folder();
    let whole = folder.read("run");
    let mut altered = whole.clone();
    *altered.last_mut().unwrap() ^= 1;
    let version = String::from_utf8_lossy(&whole).find("\"pinhole_run\":\"8\"").unwrap();
    // The number of the version is replaced by another of the same length.
    assert!(whole[version..].starts_with(b"\"pinhole_run\":\"8\""));
    let mut other = whole.clone();
    other[version + 15] = b'7';
    for (name, contents, words) in [
        ("cut", &whole[..whole.len() - 1], "cut: the run file is cut off: it has "),
        ("altered", &altered, "altered: the run file was altered after it was written"),
        (
            "other",
            &other,
            "other: run file of version 7; this program reads version 8; record it again with `verify --save`",
        ),
        ("none", b"PK\x03\x04 something else", "none: this is not a run file; `pinhole verify --save`"),
        ("empty", b"", "empty: this is not a run file"),
    ] {
        std::fs::write(folder.path(name), contents).unwrap();
        folder.refuses(&format!("verify --replay {name} --json a.json --report a"), 1, words);
    }
    folder.refuses("verify --replay no", 1, "no: cannot be read");
}
