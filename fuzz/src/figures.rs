//! The files that figures read: scene files, camera paths, selections and images of skies.

use std::io::Cursor;
use std::path::Path;

use pinhole::glam::DVec3;
use pinhole::image::encoding::Encoding;
use pinhole::{Image, LayerSet};
use pinhole_data::load::{self, Dataset, Options};
use pinhole_data::select::Selection;
use pinhole_figure::read::environment;
use pinhole_figure::scene_file::{IntegratorKind, SceneFile, Settled, parse_camera_path};
use pinhole_figure::write::exr::{self, Remarks};
use tempfile::TempDir;

use crate::{Target, checked};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn text(path: &str) -> String {
    std::fs::read_to_string(Path::new(ROOT).join(path)).unwrap()
}

/// A target that reads text. Bytes that are not text are refused before.
fn of_text(
    folder: TempDir,
    seeds: impl IntoIterator<Item = String>,
    read: impl Fn(&str) -> Result<(), String> + Send + Sync + 'static,
) -> Target {
    let seeds = seeds.into_iter().map(String::into_bytes).collect();
    Target::new(folder, seeds, move |bytes| str::from_utf8(bytes).map_or(Ok(()), &read))
}

/// Atoms with columns of numbers and of labels.
pub(crate) const DATA: &str = "x,y,z,radius,species,charge\n0,0,0,1,O,0.5\n1.5,0,0,0.7,H,-1\n0,1.2,0.5,0.4,H,\n";

fn data() -> Dataset {
    load::from_bytes(DATA.as_bytes(), "data.csv", &Options::default()).unwrap()
}

/// The examples, and the scene files that the tests refuse.
pub(crate) fn scene(folder: TempDir) -> Target {
    let examples = std::fs::read_dir(Path::new(ROOT).join("examples")).unwrap().map(|entry| entry.unwrap().path());
    let mut examples: Vec<_> = examples.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    examples.sort();
    let mut seeds: Vec<String> = examples.iter().map(|path| std::fs::read_to_string(path).unwrap()).collect();
    for file in ["scene_files.txt", "scene_files_light.txt"] {
        let cases = text(&format!("crates/figure/tests/files/refused/{file}"));
        let files = cases.split("$ cat ").skip(1).filter_map(|case| case.split_once('\n')?.1.split("\n$ ").next());
        seeds.extend(files.map(str::to_owned));
    }
    let data = data();
    // Each is read several times, and written.
    Target { tries: 40_000, ..of_text(folder, seeds, move |text| read_scene(text, &data)) }
}

fn read_scene(text: &str, data: &Dataset) -> Result<(), String> {
    let Some(file) = checked(SceneFile::parse(text))? else { return Ok(()) };
    if let Some(path) = file.camera_path() {
        checked(path.motion(DVec3::Y))?;
    }
    if let Some(reference) = file.data() {
        checked(reference.scene(data.clone(), file.shapes()))?;
    }
    let Some(scene) = checked(file.scene())? else { return Ok(()) };
    checked(file.stereo_pair(&file.film, &scene))?;
    let Some(camera) = checked(file.camera(&file.film, &scene))? else { return Ok(()) };
    for kind in [IntegratorKind::Primary, IntegratorKind::Studio, IntegratorKind::Path] {
        let Some(settings) = checked(file.settings(kind, &scene, &*camera, None))? else { continue };
        let (camera, data) = (file.camera_parameters(), file.data().cloned());
        let settled =
            file.settled(Settled { camera, settings: &settings, sky_image: None, data, cone_files: Vec::new() });
        SceneFile::parse(&settled).map_err(|error| format!("{error}, in the settled scene file\n{settled}"))?;
    }
    Ok(())
}

pub(crate) fn camera_path(folder: TempDir) -> Target {
    let seeds = [
        "ease = false\nkeys = [{ frame = 0, eye = [1, 2, 9], look_at = [0, 0, 0], up = [0, 1, 0], vertical_fov = 40 },\n\
         { frame = 10, eye = [9, 2, 1], look_at = [0, 0.5, 0] }, { frame = 20, eye = [9, -2, 1], look_at = [0, 0, 0] }]\n",
        "[[keys]]\ntime = 0.5\nview = \"iso\"\nzoom = 2\n[[keys]]\ntime = 2\nview = \"10,80\"\nturn = 720\n",
    ];
    of_text(folder, seeds.map(str::to_owned), |text| {
        let Some(path) = checked(parse_camera_path(text))? else { return Ok(()) };
        let Some(motion) = checked(path.motion(DVec3::Y))? else { return Ok(()) };
        let times = [f64::NEG_INFINITY, 0.0, 0.3 * path.end(), path.end(), f64::INFINITY];
        times.into_iter().for_each(|time| _ = std::hint::black_box(motion.at(time)));
        Ok(())
    })
}

/// The expressions of the tests that select something, those that are refused, and their words in other orders.
pub(crate) fn selection(folder: TempDir) -> Target {
    let expression = |line: &str| {
        let before = line.split(" => ").next()?;
        let before = ["pdb ", "xyz ", "types "].iter().find_map(|name| before.strip_prefix(name)).unwrap_or(before);
        Some(before.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start().to_owned())
    };
    let folders = ["crates/figure/tests/figures/", "crates/figure/tests/figures/not_", "crates/data/src/select/tests/"];
    let mut files: Vec<String> = folders.iter().map(|start| text(&format!("{start}selected.txt"))).collect();
    files.push(text("crates/data/src/select/tests/refused.txt"));
    let mut seeds: Vec<String> = files.iter().flat_map(|file| file.lines()).filter_map(expression).collect();
    let words: Vec<String> = seeds.iter().flat_map(|seed| seed.split(' ')).map(str::to_owned).collect();
    seeds.extend((0..300_usize).map(|start| {
        let word = |step: usize| words[(37 * start + 11 * step * step) % words.len()].as_str();
        (0..8).map(word).collect::<Vec<_>>().join(" ")
    }));
    let molecule = text("crates/data/src/select/tests/molecule.pdb");
    let molecule = load::from_bytes(molecule.as_bytes(), "a.pdb", &Options::default()).unwrap();
    let data = [data(), molecule];
    of_text(folder, seeds, move |text| {
        let Some(selection) = checked(text.parse::<Selection>())? else { return Ok(()) };
        data.iter().try_for_each(|data| {
            checked(selection.apply(&mut data.clone()))?.map_or(Ok(()), |kept| crate::check_message(kept.notes))
        })
    })
}

/// Images of skies in both formats.
pub(crate) fn sky(folder: TempDir) -> Target {
    let mut file = Cursor::new(Vec::new());
    let picture = Image::new(4, 2, LayerSet::COLOR).unwrap();
    exr::write(&picture, LayerSet::COLOR, &Encoding::default(), Remarks::default(), &mut file).unwrap();
    let hdr = std::fs::read(Path::new(ROOT).join("examples/sky.hdr")).unwrap();
    let flat = [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n", &[7; 32][..]].concat();
    Target::new(folder, vec![hdr, flat, file.into_inner()], |bytes| checked(environment::read(bytes)).map(drop))
}
