//! Tests of results that depend on the data: its description, selections, bonds, colours, and annotations.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Value, json};

use crate::support::{Folder, SCENE, WATER, decode};

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
    let folder = Folder::with(&[("two.xyz", &[WATER, second].concat()), ("cut.xyz", &[WATER, cut].concat())]);
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
    assert_eq!((&plain["min"], &plain["max"]), (&json!([-1.0, -2.0, -2.0]), &json!([6.0, 2.0, 2.0])));
    let charge = json!({ "name": "charge", "kind": "numbers", "min": -0.5, "max": 0.25, "nan": 0 });
    assert_eq!(plain["columns"][1], charge);
    let species = json!({ "name": "species", "kind": "text", "different": 2, "first": ["O", "Xx"] });
    assert_eq!(plain["columns"][0], species);
    assert_eq!(plain["notes"].as_array().unwrap().len(), 1);
    let cut = json_of(&folder, "info cut.xyz --json");
    assert_eq!((&cut["frames"], &cut["spheres"]), (&json!(1), &json!(3)));
    let problem = "line 6: frame 1 declares 3 atoms, but the file ends after 1";
    assert_eq!(cut["problem"], problem);
    assert!(text(&folder, "info cut.xyz").ends_with(&format!("problem: {problem}\n")));
}

/// Names in files can neither write to the terminal nor fill it.
#[test]
fn names_in_files_are_only_shown() {
    let long = "(".repeat(100_000);
    let header = format!("x,y,z,a\u{9b}2J,b\u{202e}c\u{1b}[2J,{long}\n1,2,3,4,5,6\n2,3,4,5,6,7\n");
    let folder = Folder::with(&[("a.csv", &header)]);
    let select = folder.command("render a.csv -o a.png --backend cpu --select").arg(&long).output().unwrap();
    let column = folder.command("render a.csv -o a.png --backend cpu --color-by").arg(&long[1..]).output().unwrap();
    for said in [text(&folder, "info a.csv"), text(&folder, "info a.csv --json")]
        .into_iter()
        .chain([select, column].map(|output| String::from_utf8(output.stderr).unwrap()))
    {
        let is_shown = |line: &str| line.chars().count() < 900 && !line.contains(['\u{1b}', '\u{9b}', '\u{202e}']);
        assert!(said.lines().all(is_shown), "{said}");
    }
}

#[test]
fn points_without_frames_and_spheres_that_cannot_be_rendered() {
    let folder = Folder::with(&[(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float \
         q\nelement face 1\nproperty list uchar int i\nend_header\n0 0 0 1\n2 0 0 nan\n1 0\n",
    )]);
    let report = json_of(&folder, "info a.ply --json");
    assert_eq!((&report["kind"], &report["format"], &report["frames"]), (&json!("data"), &json!("ply"), &Value::Null));
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
    let scene = format!("data = 'water.xyz'\nintegrator = 'path'\n[sampling]\nsamples = 8\n{SCENE}");
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
    assert!(text.contains("\n  picture    40x30\n  camera     pinhole\n  integrator path\n"), "{text}");
}

/// Four atoms in a row, each with a number, in a cell.
const ATOMS: &str = "4\nLattice=\"8 0 0 0 2 0 0 0 2\" Origin=\"-1 -1 -1\" Properties=species:S:1:pos:R:3:q:R:1\n\
                   O 0 0 0 -1\nH 0.9 0 0 0\nC 4 0 0 0.5\nC 5.5 0 0 3\n";

const FLAGS: &str = "--backend cpu --style fast --size 80x20 -o out.png";

fn folder() -> Folder {
    let plain = "2\n\nAr 0 0 0\nAr 3 0 0\n";
    Folder::with(&[("row.xyz", ATOMS), ("plain.xyz", plain), ("scene.toml", "data = 'row.xyz'\n")])
}

#[track_caller]
fn said(folder: &Folder, arguments: &str) -> (String, String) {
    let mut command = folder.command(&format!("render {FLAGS}"));
    command.args(arguments.split(';').map(str::trim));
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments}: {text}");
    let (notes, line) = text.trim_end().rsplit_once('\n').unwrap_or(("", text.trim_end()));
    (notes.to_owned(), line.to_owned())
}

#[test]
fn a_selection_decides_what_is_seen_and_counted() {
    let folder = folder();
    let (notes, line) = said(&folder, "row.xyz; --kind; plain; --select; q >= 0 and species == C; --color-by; q");
    assert_eq!(notes, "note: colors show `q` from 0.5 to 3");
    assert!(line.starts_with("row.xyz: kept 2 of 4 atoms; --kind plain --style fast"), "{line}");
    // The camera frames the kept spheres, so this is the picture of a file with no others.
    let kept = decode(&folder.read("out.png"));
    let alone = Folder::with(&[("row.xyz", "2\nProperties=species:S:1:pos:R:3:q:R:1\nC 4 0 0 0.5\nC 5.5 0 0 3\n")]);
    said(&alone, "row.xyz; --kind; plain; --color-by; q");
    assert!(kept == decode(&alone.read("out.png")));
    let (notes, line) = said(&folder, "scene.toml; --select; index != 0 and not species == Q");
    assert_eq!(notes, "note: no sphere has the species Q; there are O, H, C");
    assert!(line.starts_with("scene.toml: kept 3 of 4 atoms"), "{line}");
}

#[test]
fn bonds_and_boxes_come_after_the_spheres_of_the_file() {
    let folder = folder();
    let (notes, line) = said(&folder, "row.xyz; --bonds; --box; --layer; id=id.npy");
    assert_eq!(notes, "");
    assert!(line.starts_with("row.xyz: 4 atoms, 2 bonds; --style fast"), "{line}");
    let bytes = folder.read("id.npy");
    let ids = bytes[bytes.len() - 4 * 80 * 20..].chunks_exact(4);
    let ids: Vec<u32> = ids.map(|id| u32::from_le_bytes(id.try_into().unwrap())).collect();
    for atom in 0..4 {
        assert!(ids.contains(&atom), "{atom}");
    }
    assert!(ids.iter().any(|id| (4..u32::MAX).contains(id)));
    let (_, line) = said(&folder, "row.xyz; --bond-length; 1.9; --select; species == C or index == 1");
    assert!(line.starts_with("row.xyz: kept 3 of 4 atoms, 1 bond;"), "{line}");
}

#[test]
fn printed_scenes_select_and_add_the_same() {
    let folder = folder();
    let mut command = folder.command("render row.xyz --print-scene --style fast --size 80x20 --box --bonds=1.1");
    let output = command.args(["--select", "q >= 0 and species != \"O\""]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("select = 'q >= 0 and species != \"O\"'\n"), "{text}");
    assert!(text.contains("box = true\nbonds = 1.1\n"), "{text}");
    std::fs::write(folder.path("printed.toml"), &text).unwrap();
    said(&folder, "printed.toml");
    let printed = decode(&folder.read("out.png"));
    said(&folder, "row.xyz; --box; --bonds=1.1; --select; q >= 0 and species != O");
    assert!(printed == decode(&folder.read("out.png")));
}

#[test]
fn frames_are_selected_one_by_one() {
    let frames: String =
        (0..3).map(|frame| format!("2\nLattice=\"9 0 0 0 2 0 0 0 2\"\nO {} 0 0\nO 8 0 0\n", 2 * frame)).collect();
    let folder = Folder::with(&[("a.xyz", &frames)]);
    let flags = "--backend cpu --style fast --size 40x20 --view z";
    let run = folder.run(&format!("render a.xyz -o f%d.png --frames : --select x<7 --box {flags}")).succeeded();
    assert_eq!(run.said.unwrap().split(';').next(), Some("a.xyz: 3 pictures of kept 1 of 2 atoms"));
    let pictures: Vec<_> = (0..3).map(|i| decode(&folder.read(&format!("f{i}.png")))).collect();
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
    // The cell keeps its place, because the camera does.
    let run = folder.run(&format!("render a.xyz -o f%d.png --frames : --select x<3 {flags}"));
    assert!(run.stderr.contains("frame 2: a.xyz: --select: `x<3` selects none of the 2 spheres"), "{}", run.stderr);
    assert_eq!(run.code, 1);
}

#[test]
fn info_tells_where_the_cell_starts() {
    let run = folder().run("info row.xyz").succeeded();
    let text = String::from_utf8(run.stdout).unwrap();
    assert!(text.contains("  cell       (8 0 0) (0 2 0) (0 0 2) from (-1 -1 -1)\n"), "{text}");
    let run = folder().run("info row.xyz --json").succeeded();
    let json: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!(json["cell_origin"], serde_json::json!([-1.0, -1.0, -1.0]));
}

/// Four spheres in a row, each with a number and a text.
const ROW: &str = "4\nProperties=species:S:1:pos:R:3:radius:R:1:charge:R:1:site:S:1:v:R:3\n\
                   C 0 0 0 1 -1 a 3 4 0\nC 2 0 0 1 0 b 0 0 1\nC 4 0 0 1 0.5 a 0 0 2\nC 6 0 0 1 3 c 0 0 0\n";

const ROW_SCENE: &str = "data = 'row.xyz'\nshading = 'flat'\ncolor_by = 'site'\n\
                     [film]\nwidth = 80\nheight = 20\n\
                     [camera.orthographic]\neye = [3, 0, 9]\nlook_at = [3, 0, 0]\nhalf_extent = [4, 1]\n\
                     [legend]\ntitle = 'Site'\n";

/// The colours in the middles of the four spheres, and the program's messages.
#[track_caller]
fn colors_of(arguments: &str) -> (Vec<[u8; 3]>, String) {
    let folder = Folder::with(&[("row.xyz", ROW), ("scene.toml", ROW_SCENE)]);
    let flags = "--backend cpu -o out.png --legend=0,0 --text-scale 0.2";
    let run = folder.run(&format!("render scene.toml {flags} {arguments}")).succeeded();
    let (width, height, rgb) = decode(&folder.read("out.png"));
    assert_eq!((width, height), (80, 20));
    let pixel = |x: usize| 3 * (18 * 80 + x);
    let middles = [10, 30, 50, 70].map(|x| {
        let start = pixel(x) - 3 * 80 * 8;
        [rgb[start], rgb[start + 1], rgb[start + 2]]
    });
    (middles.to_vec(), run.stderr)
}

#[test]
fn columns_color_the_spheres() {
    let (colors, says) = colors_of("--color-by charge --cmap gray --range -1,1");
    assert_eq!(colors[1..], [[128; 3], [191; 3], [255; 3]]);
    assert_eq!(says, "note: `charge` of 1 sphere lies outside the range -1 to 1 and has the color of its end\n");
    let (colors, says) = colors_of("--color-by |v| --cmap gray_r");
    assert_eq!(colors[1..], [[204; 3], [153; 3], [255; 3]]);
    assert_eq!(says, "note: colors show `|v|` from 0 to 5\n");
    let (colors, says) = colors_of("");
    assert_eq!(colors[1..], [[0x56, 0xb4, 0xe9], [0xe6, 0x9f, 0x00], [0x00, 0x9e, 0x73]]);
    assert_eq!(says, "");
}

#[test]
fn an_exr_has_no_annotations() {
    let folder = Folder::with(&[("row.xyz", ROW), ("scene.toml", ROW_SCENE)]);
    let run = folder.run("render scene.toml --backend cpu -o out.exr").succeeded();
    assert!(run.stderr.contains("annotations are not drawn; write a .png"), "{}", run.stderr);
}

/// A cube of 27 spheres, each with a number and a text.
fn cube() -> String {
    let head = "27\nProperties=species:S:1:pos:R:3:radius:R:1:v:R:1:kind:S:1\n".to_owned();
    (0..27).fold(head, |text, i| {
        let [x, y, z] = [i % 3, i / 3 % 3, i / 9];
        text + &format!("C {x} {y} {z} 0.6 {}.5 {}\n", i * i, ["water", "sodium", "chloride"][i % 3])
    })
}

/// Renders the cube; returns whether each pixel shows a sphere, and whether it shows the legend on the background.
fn pixels_of(folder: &Folder, size: &str, flags: &str) -> (usize, Vec<bool>, Vec<bool>) {
    let fixed = "--backend cpu --style fast -q --layer id=id.npy -o out.png";
    folder.run(&format!("render a.xyz --size {size} {fixed} {flags}")).succeeded();
    let (width, height, rgb) = decode(&folder.read("out.png"));
    let ids = folder.read("id.npy");
    let ids = &ids[ids.len() - 4 * (width * height) as usize..];
    let is_sphere: Vec<bool> = ids.chunks_exact(4).map(|id| id != [0xff; 4]).collect();
    // The corner between the two sides with legends is background.
    let corner = &rgb[3 * (width as usize * (height as usize - 1))..][..3];
    let pixels = rgb.chunks_exact(3).zip(&is_sphere);
    let is_legend = pixels.map(|(pixel, is_sphere)| !is_sphere && pixel != corner).collect();
    (width as usize, is_sphere, is_legend)
}

/// The first and the last row and column of the pixels.
fn extent(width: usize, pixels: &[bool]) -> [[usize; 2]; 2] {
    let found = || (0..pixels.len()).filter(|pixel| pixels[*pixel]);
    let ends = |place: &dyn Fn(usize) -> usize| [found().map(place).min().unwrap(), found().map(place).max().unwrap()];
    [ends(&|pixel| pixel % width), ends(&|pixel| pixel / width)]
}

#[test]
fn no_sphere_lies_under_the_legend() {
    let folder = Folder::with(&[("a.xyz", &cube())]);
    for size in ["400x300", "300x500", "900x240"] {
        for position in ["right", "left", "top", "bottom", "bottom-right", "0.9,0.4"] {
            for (column, camera) in [("v", "pinhole"), ("kind", "orthographic")] {
                let flags = format!("--color-by {column} --legend={position} --camera {camera}");
                let (width, is_sphere, is_legend) = pixels_of(&folder, size, &flags);
                let [columns, rows] = extent(width, &is_legend);
                let covered = is_sphere.iter().enumerate().any(|(pixel, is_sphere)| {
                    let (x, y) = (pixel % width, pixel / width);
                    let is_inside = |[low, high]: [usize; 2], at| low <= at && at <= high;
                    *is_sphere && is_inside(columns, x) && is_inside(rows, y)
                });
                assert!(!covered, "{size} {flags}: {columns:?} {rows:?}");
                assert!(is_sphere.iter().any(|is_sphere| *is_sphere), "{size} {flags}");
            }
        }
    }
}

/// The spheres are in the middle without a legend, and with a legend that takes too much of the picture.
#[test]
fn without_room_the_spheres_stay_in_the_middle() {
    let folder = Folder::with(&[("a.xyz", &cube())]);
    for flags in ["--color-by v", "--color-by v --legend=0.5,0.5 --text-scale 3"] {
        let (width, is_sphere, _) = pixels_of(&folder, "400x300", flags);
        let [columns, rows] = extent(width, &is_sphere);
        assert!((columns[0] + columns[1]).abs_diff(399) <= 2, "{flags}: {columns:?}");
        assert!((rows[0] + rows[1]).abs_diff(299) <= 2, "{flags}: {rows:?}");
    }
}
