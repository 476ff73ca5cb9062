//! `pinhole certify`: answers of the CPU reference, unchanged and spoilt.

use npyz::NpyFile;

use crate::npy_files::{npy, zip};
use crate::support::Folder;

const SCENE: &str = "[film]\nwidth = 40\nheight = 30\n\
                     [camera.pinhole]\neye = [0.3, 0.2, 4]\nlook_at = [0, 0, 0]\n\
                     [[spheres]]\ncenter = [0, 0, 0]\nradius = 0.6\n\
                     [[spheres]]\ncenter = [0.5, 0, -0.5]\nradius = 0.5\n";

const ANSWERS: &str = "--id id.npy --depth depth.npy --normal normal.npy";

/// A folder with a picture of the reference and its layers.
fn folder() -> Folder {
    let folder = Folder::with(&[("scene.toml", SCENE)]);
    let layers = "--layer id=id.npy --layer depth=depth.npy --layer normal=normal.npy";
    folder.run(&format!("render scene.toml -o a.png --backend cpu {layers}")).succeeded();
    folder
}

fn depths(folder: &Folder) -> Vec<f32> {
    NpyFile::new(&folder.read("depth.npy")[..]).unwrap().into_vec().unwrap()
}

fn ids(folder: &Folder) -> Vec<u32> {
    NpyFile::new(&folder.read("id.npy")[..]).unwrap().into_vec().unwrap()
}

fn write(folder: &Folder, name: &str, dtype: &str, bytes: &[u8]) {
    std::fs::write(folder.path(name), npy(dtype, false, "(30, 40)", bytes)).unwrap();
}

#[test]
fn the_reference_is_proved() {
    let folder = folder();
    let run = folder.run(&format!("certify scene.toml {ANSWERS} --json a.json")).succeeded();
    assert_eq!(run.stderr, "");
    let text = String::from_utf8(run.stdout).unwrap();
    for words in [
        "scene: 2 spheres, 32 bytes, sha256 ",
        "\npicture: 40x30, pinhole camera\nchecked: id, depth as t, normal\nproved ",
        "\nviolated                   0    0.0000 %\nk up to 1/16 ",
        "  of 48\n",
    ] {
        assert!(text.contains(words), "{text}");
    }
    assert!(text.ends_with("\nproved\n"), "{text}");
    let json: serde_json::Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
    assert_eq!(json["outcome"], "proved");
    assert_eq!(json["picture"]["camera"], "pinhole");
    assert_eq!(json["checked"], serde_json::json!(["id", "depth as t", "normal"]));
    assert_eq!((&json["counts"]["violated"], &json["at_most"]), (&0.into(), &48.0.into()));
    let counted: u64 = json["histogram"].as_array().unwrap().iter().map(|b| b["count"].as_u64().unwrap()).sum();
    assert_eq!(counted, 1200);
}

/// The same answers in several types, byte orders and orders of axes.
#[test]
fn arrays_may_be_of_several_types() {
    let folder = folder();
    let (ids, depths) = (ids(&folder), depths(&folder));
    let signed = |id: &u32| if *id == u32::MAX { -1 } else { i64::from(*id) };
    let bytes_i8: Vec<u8> = ids.iter().flat_map(|id| signed(id).to_be_bytes()).collect();
    let bytes_i4: Vec<u8> = ids.iter().flat_map(|id| (signed(id) as i32).to_le_bytes()).collect();
    let largest = |id: &u32| if *id == u32::MAX { u64::MAX } else { u64::from(*id) };
    let bytes_u8: Vec<u8> = ids.iter().flat_map(|id| largest(id).to_le_bytes()).collect();
    let bytes_f8: Vec<u8> = depths.iter().flat_map(|depth| f64::from(*depth).to_be_bytes()).collect();
    write(&folder, "depth8.npy", ">f8", &bytes_f8);
    for (dtype, bytes) in [(">i8", bytes_i8), ("<i4", bytes_i4), ("<u8", bytes_u8)] {
        write(&folder, "other.npy", dtype, &bytes);
        folder.run("certify scene.toml --id other.npy --depth depth8.npy").succeeded();
    }
    let by_column = (0..40).flat_map(|x| (0..30).map(move |y| 40 * y + x));
    let bytes: Vec<u8> = by_column.flat_map(|i: usize| ids[i].to_le_bytes()).collect();
    std::fs::write(folder.path("other.npy"), npy("<u4", true, "(30, 40)", &bytes)).unwrap();
    folder.run("certify scene.toml --id other.npy --depth depth.npy").succeeded();
}

#[test]
fn what_is_wrong_gives_exit_code_3() {
    let folder = folder();
    let middle = 15 * 40 + 19;
    let mut wrong = ids(&folder);
    assert_eq!(wrong[middle], 0);
    wrong[middle] = 1;
    let bytes: Vec<u8> = wrong.iter().flat_map(|id| id.to_le_bytes()).collect();
    write(&folder, "wrong.npy", "<u4", &bytes);
    let run = folder.run("certify scene.toml --id wrong.npy --depth depth.npy --json a.json");
    let words = "1 of 1200 pixels need k above 40; the worst is pixel (19, 15): sphere 1 at ";
    run.refused(3, words).refused(3, "the exact ray hits sphere 0 at 3.");
    assert!(run.stdout.ends_with(b"\nviolated\n"));
    let json: serde_json::Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
    assert_eq!(json["worst"][0]["pixel"], serde_json::json!([19, 15]));
    assert_eq!((&json["worst"][0]["id"], &json["worst"][0]["exact_id"]), (&1.into(), &0.into()));
    assert!(json["worst"][0]["k"].as_f64().unwrap() > 1e3);

    // The depth is that of a z-buffer.
    folder.refuses("certify scene.toml --id id.npy --depth depth.npy --depth-is z", 3, "");
}

#[test]
fn what_is_undecided_gives_exit_code_4() {
    let folder = folder();
    let run = folder.run("certify scene.toml --id id.npy --at-most 1000000");
    assert_eq!(run.code, 4, "{}", run.stderr);
    let words = "pixels are undecided, more than 1 %; a smaller --at-most or a larger picture decides more\n";
    assert!(run.stderr.ends_with(words), "{}", run.stderr);
    assert!(run.stdout.ends_with(b"\nundecided\n"));
}

#[test]
fn rays_may_be_given() {
    let folder = folder();
    // The rays are parallel, towards -z. The middle one meets the first sphere.
    let direction = [0_f32, 0.0, -1.0].map(f32::to_le_bytes).concat();
    let directions = npy("<f4", false, "(30, 40, 3)", &direction.repeat(1200));
    let origins: Vec<u8> = (0..1200_u32)
        .flat_map(|i| [(i % 40) as f32 - 20.0, (i / 40) as f32 - 15.0, 5.0])
        .flat_map(f32::to_le_bytes)
        .collect();
    let origins = npy("<f4", false, "(30, 40, 3)", &origins);
    let archive = zip(&[("directions.npy", &directions), ("origins.npy", &origins)], true);
    std::fs::write(folder.path("rays.npz"), archive).unwrap();
    let hit = |i: usize| i == 15 * 40 + 20;
    let ids: Vec<u8> = (0..1200).flat_map(|i| if hit(i) { 0_i32 } else { -1 }.to_le_bytes()).collect();
    write(&folder, "few.npy", "<i4", &ids);
    let depths: Vec<u8> = (0..1200).flat_map(|i| if hit(i) { 4.4_f32 } else { 0.0 }.to_le_bytes()).collect();
    write(&folder, "few-depth.npy", "<f4", &depths);
    let run = folder.run("certify scene.toml --id few.npy --depth few-depth.npy --rays rays.npz").succeeded();
    let text = String::from_utf8(run.stdout).unwrap();
    let words =
        "\npicture: 40x30, given rays, taken as they are, off those of the pinhole camera by up to 2.86e1 degrees and ";
    assert!(text.contains(words) && text.contains(" of 24\n"), "{text}");
    let run = folder.run("certify scene.toml --id few.npy --rays rays.npz --size 20x15").succeeded();
    assert!(run.stderr.contains("has another size than the rays"), "{run:?}");
}

#[test]
fn the_size_of_data_files_is_that_of_the_ids() {
    let folder = folder();
    let sphere = [0_f32, 0.0, 0.0, 1.0].map(f32::to_le_bytes).concat();
    std::fs::write(folder.path("one.npy"), npy("<f4", false, "(1, 4)", &sphere)).unwrap();
    folder.run("render one.npy --size 12x9 -o a.png --backend cpu --layer id=one-id.npy").succeeded();
    folder.run("certify one.npy --id one-id.npy").succeeded();
}
