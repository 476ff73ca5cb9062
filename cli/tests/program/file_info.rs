//! `pinhole info FILE`: what is in data files and scene files.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Value, json};

use crate::support::{Folder, SCENE, WATER};

fn text(folder: &Folder, arguments: &str) -> String {
    let run = folder.run_without_drivers(arguments).succeeded();
    assert_eq!(run.stderr, "");
    String::from_utf8(run.stdout).unwrap()
}

fn json_of(folder: &Folder, arguments: &str) -> Value {
    serde_json::from_str(&text(folder, arguments)).unwrap()
}

#[test]
fn a_trajectory_is_described_by_one_of_its_frames() {
    let second = "2\nLattice=\"9 0 0 0 8 0 0 0 7\" Properties=species:S:1:pos:R:3:radius:R:1:charge:R:1\n\
                  O 0 0 0 1 -0.5\nXx 4 0 0 2 .25\n";
    let cut = "3\ncut off\nO 0 0 0\n";
    let folder = Folder::with(&[
        ("two.xyz", &[WATER, second].concat()),
        ("cut.xyz", &[WATER, cut].concat()),
    ]);
    assert_eq!(
        text(&folder, "info two.xyz --frame 0"),
        "two.xyz\n  format     xyz (Text with one atom on each line (XYZ))\n  size       160 bytes\n  frames     2\n  \
         frame      0, which the following describes\n  spheres    3\n  box        -1.96 -1.5 -1.7 to 1.96 1.5 1.6\n  \
         radii      1.2 to 1.5\n  colors     yes\n  opacities  no\ncolumns\n  species  text     2 different: O, H\n"
    );
    let mut gz = GzEncoder::new(Vec::new(), Compression::fast());
    gz.write_all(&std::fs::read(folder.path("two.xyz")).unwrap()).unwrap();
    std::fs::write(folder.path("two.xyz.gz"), gz.finish().unwrap()).unwrap();
    let plain = json_of(&folder, "info two.xyz --frame 1 --json");
    let mut compressed = json_of(&folder, "info two.xyz.gz --frame 1 --json");
    assert_eq!((&plain["compressed"], &compressed["compressed"]), (&json!(false), &json!(true)));
    for key in ["compressed", "bytes", "file"] {
        compressed[key] = plain[key].clone();
    }
    assert_eq!(compressed, plain);
    assert_eq!(plain["cell"], json!([[9.0, 0.0, 0.0], [0.0, 8.0, 0.0], [0.0, 0.0, 7.0]]));
    assert_eq!(
        (&plain["min"], &plain["max"]),
        (&json!([-1.0, -2.0, -2.0]), &json!([6.0, 2.0, 2.0]))
    );
    let charge = json!({ "name": "charge", "kind": "numbers", "min": -0.5, "max": 0.25, "nan": 0 });
    assert_eq!(plain["columns"][1], charge);
    let species =
        json!({ "name": "species", "kind": "text", "different": 2, "first": ["O", "Xx"] });
    assert_eq!(plain["columns"][0], species);
    assert_eq!(plain["notes"].as_array().unwrap().len(), 1);
    let cut = json_of(&folder, "info cut.xyz --json");
    assert_eq!((&cut["frames"], &cut["spheres"]), (&json!(1), &json!(3)));
    let problem = "line 6: frame 1 declares 3 atoms, but the file ends after 1";
    assert_eq!(cut["problem"], problem);
    assert!(text(&folder, "info cut.xyz").ends_with(&format!("problem: {problem}\n")));
}

#[test]
fn points_without_frames_and_spheres_that_cannot_be_rendered() {
    let folder = Folder::with(&[(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float \
         q\nelement face 1\nproperty list uchar int i\nend_header\n0 0 0 1\n2 0 0 nan\n1 0\n",
    )]);
    let report = json_of(&folder, "info a.ply --json");
    assert_eq!(
        (&report["kind"], &report["format"], &report["frames"]),
        (&json!("data"), &json!("ply"), &Value::Null)
    );
    assert_eq!((&report["radius_min"], &report["radius_max"]), (&json!(1.0), &json!(1.0)));
    assert_eq!(report["notes"].as_array().unwrap().len(), 2, "{report}");
    let q = json!([{ "name": "q", "kind": "numbers", "min": 1.0, "max": 1.0, "nan": 1 }]);
    assert_eq!(report["columns"], q);
    let numbers = [0.0_f32, 0.0, 0.0, 1.0, f32::NAN, 0.0, 0.0, 1.0];
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(folder.path("a.bin"), bytes).unwrap();
    let report = json_of(&folder, "info a.bin --format raw-f32x4 --json");
    assert_eq!((&report["spheres"], &report["max"]), (&json!(2), &json!([1.0, 1.0, 1.0])));
    let note = report["notes"][0].as_str().unwrap();
    assert!(note.starts_with("1 of the spheres cannot be rendered; sphere 1: "), "{note}");
}

#[test]
fn a_scene_file_is_described_with_its_data() {
    let scene =
        format!("data = 'water.xyz'\nintegrator = 'path'\n[sampling]\nsamples = 8\n{SCENE}");
    let folder = Folder::with(&[("scene.toml", &scene), ("water.xyz", WATER)]);
    let report = json_of(&folder, "info scene.toml --json");
    for (key, expected) in [
        ("kind", json!("scene")),
        ("spheres", json!(4)),
        ("width", json!(40)),
        ("height", json!(30)),
        ("camera", json!("pinhole")),
        ("stereo", json!(false)),
        ("integrator", json!("path")),
        ("samples", json!(8)),
        ("files", json!(["water.xyz"])),
    ] {
        assert_eq!(report[key], expected, "{key}");
    }
    let text = text(&folder, "info scene.toml");
    assert!(
        text.contains("\n  picture    40x30\n  camera     pinhole\n  integrator path\n"),
        "{text}"
    );
}
