//! Files of spheres and what they hold, those and scene files that are refused, and damaged files of every format.

use std::path::Path;

use fastrand::Rng;
use pinhole::load::{self, ColumnValues, Dataset, FORMATS, Labels, Options};
use pinhole::scene::sphere_array::SphereArray;
use pinhole::scene_file::{IntegratorKind, SceneFile, SceneFileError};
use pinhole::{LinearRgb, Sphere};
use tempfile::TempDir;

use crate::cases::{Case, answered};
use crate::damage::{SLOW, damaged, read_all, read_bytes};
use crate::seeds;
use crate::support::effort::tries;

#[test]
fn refused_files() {
    compare("refused", answer);
}

#[test]
fn accepted_files() {
    compare("accepted", contents);
}

/// Compares a folder of cases with what is found, or writes it.
fn compare(folder: &str, answer: fn(&Case<'_>) -> String) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(folder);
    let files: Vec<_> = std::fs::read_dir(folder).unwrap().collect();
    assert!(files.len() >= 8, "only {} files of cases", files.len());
    for entry in files {
        let file = entry.unwrap().path();
        let text = std::fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
        assert!(text.contains("$ pinhole "), "{} has no cases", file.display());
        let found = answered(&text, answer);
        if std::env::var_os("PINHOLE_UPDATE_SNAPSHOTS").is_some_and(|value| value == "1") {
            std::fs::write(&file, &found).unwrap();
            continue;
        }
        for (found, expected) in found.lines().zip(text.lines()) {
            assert_eq!(found, expected, "{}", file.display());
        }
        assert_eq!(found.len(), text.len(), "{}", file.display());
    }
}

/// The first error, whether it appears in parsing, in the scene, in its camera or in the settings.
fn scene_file_error(text: &str) -> Option<SceneFileError> {
    let settings = || {
        let file = SceneFile::parse(text)?;
        let scene = file.scene(&[])?;
        let camera = file.camera(&file.film, &scene)?;
        let kind = file.integrator().unwrap_or(IntegratorKind::Studio);
        file.settings(kind, &scene, camera.as_ref(), None)
    };
    settings().err()
}

/// What the program says to a file that cannot be read.
fn answer(Case { files, arguments }: &Case<'_>) -> String {
    let [(name, bytes)] = &files[..] else { panic!("{arguments}: not one file") };
    if name.ends_with(".toml") {
        let error = scene_file_error(str::from_utf8(bytes).unwrap()).unwrap();
        return format!("exit code 1\nerror: {name}: {error}\n");
    }
    let options = options(arguments);
    let error = load::from_bytes(bytes, name, &options).unwrap_err();
    // Of a file that is opened, frame by frame if it has any, the same is said.
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    assert_eq!(load::open(&path, &options).unwrap_err().to_string(), error.to_string(), "{name}");
    // A radius that contradicts the file is wrong usage.
    let code = if options.radius.is_some() { 2 } else { 1 };
    format!("exit code {code}\nerror: {name}: {error}\n")
}

fn options(arguments: &str) -> Options {
    let words = arguments.split(' ');
    let flag = |name| words.clone().skip_while(|word| *word != name).nth(1);
    let mut options = Options::default();
    options.frame = flag("--frame").map(|frame| frame.parse().unwrap());
    options.radius = flag("--radius").map(|radius| radius.parse().unwrap());
    options.columns = flag("--columns")
        .map_or_else(Vec::new, |names| names.split(',').map(str::to_owned).collect());
    options
}

/// What a file holds. Several files of one case are different ways to write the same.
fn contents(Case { files, arguments }: &Case<'_>) -> String {
    let read = |(name, bytes): &(&str, Vec<u8>)| {
        load::from_bytes(bytes, name, &options(arguments)).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    let loaded = read(&files[0]);
    for (number, file) in files.iter().enumerate() {
        // As text, because a missing number is not equal to itself.
        assert_eq!(written(&read(file)), written(&loaded), "file {number} of {arguments}");
        if file.0.ends_with(".pdb") {
            let frame = options(arguments).frame.unwrap_or(0);
            let direct = load::pdb::read(&file.1, frame).unwrap();
            assert_eq!(written(&direct), written(&loaded), "{arguments}");
        }
    }
    written(&loaded)
}

fn written(loaded: &Dataset) -> String {
    let width = if matches!(loaded.spheres, SphereArray::F32(_)) { 32 } else { 64 };
    let columns = loaded.columns.iter().map(|column| match &column.values {
        ColumnValues::Labels(labels) => format!(" {} {:?}", column.name, labels.names),
        _ => format!(" {}", column.name),
    });
    let columns: String = columns.collect();
    let mut lines = vec![format!("{} spheres of f{width};{columns}", loaded.spheres.len())];
    let white = LinearRgb::WHITE;
    for (index, Sphere { center: [x, y, z], radius, .. }) in
        loaded.spheres.with_color(white).enumerate()
    {
        let mut line = format!("{x} {y} {z} radius {radius}");
        if let Some(colors) = &loaded.colors {
            let srgb = colors[index].to_srgb8();
            line += &match LinearRgb::from_srgb8(srgb) == colors[index] {
                true => format!(" color {srgb:?}"),
                false => format!(" color {:?}", colors[index]),
            };
        }
        if let Some(opacities) = &loaded.opacities {
            line += &format!(" opacity {}", opacities[index]);
        }
        for column in &loaded.columns {
            line += &match &column.values {
                ColumnValues::Labels(Labels { names, indices }) => {
                    format!(" {:?}", names[indices[index] as usize])
                }
                ColumnValues::Numbers(numbers) => format!(" {}", numbers[index]),
                other => format!(" {other:?}"),
            };
        }
        lines.push(line);
    }
    if let Some(cell) = loaded.cell {
        // Cosines may differ in the last digit from one system to another.
        let cell = cell.map(|edge| edge.map(|x| (x * 1e9).round() / 1e9 + 0.0));
        lines.push(format!("cell {cell:?} from {:?}", loaded.cell_origin));
    }
    lines.extend(loaded.frames.map(|frames| format!("frames: {frames}")));
    lines.extend(loaded.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n") + "\n"
}

#[test]
fn every_format_has_good_files() {
    let folder = TempDir::new().unwrap();
    for format in FORMATS {
        let seeds = seeds::of(format, folder.path());
        assert!(!seeds.is_empty(), "{}: give it a file in tests/files/good", format.name);
        for (index, seed) in seeds.into_iter().enumerate() {
            let options = seed.options.with_format(format);
            let loaded = load::from_bytes(&seed.bytes, "", &options);
            let loaded = loaded.unwrap_or_else(|e| panic!("{} {index}: {e}", format.name));
            assert!(!loaded.spheres.is_empty(), "{} {index}", format.name);
        }
    }
}

#[test]
fn damaged_files_end_with_spheres_or_one_line() {
    let folder = TempDir::new().unwrap();
    for format in FORMATS {
        let seeds = seeds::of(format, folder.path());
        for seed in &seeds {
            for end in (0..seed.bytes.len()).filter(|end| *end < 2048 || end % 7 == 0) {
                let mut random = Rng::with_seed(end as u64);
                read_bytes(format, &seed.bytes[..end], &seed.options, &mut random)
                    .unwrap_or_else(|e| panic!("{}, cut at {end}: {e}", format.name));
            }
        }
        let each = tries(if format.has_frames() { 64_000 } else { 240_000 });
        for number in 0..u64::from(each) {
            let mut random = Rng::with_seed(number);
            let seed = &seeds[number as usize % seeds.len()];
            let other = &seeds[random.usize(0..seeds.len())].bytes;
            let bytes = damaged(&seed.bytes, other, &mut random);
            // Frames are read from files in many ways, which takes ten times as long.
            let taken = if random.u8(0..20) == 0 {
                let file = folder.path().join("file");
                read_all(format, &bytes, &seed.options, &file, &mut random)
            } else {
                read_bytes(format, &bytes, &seed.options, &mut random)
            };
            let taken = taken.unwrap_or_else(|e| panic!("{}, input {number}: {e}", format.name));
            // A busy machine may be slow, but what hangs is slower. The long run in `benches` measures.
            assert!(taken < 60 * SLOW, "{}, input {number}: {taken:?}", format.name);
        }
    }
}
