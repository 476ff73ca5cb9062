//! Files of spheres and their contents, and files that are refused.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use pinhole::scene::sphere_array::SphereArray;
use pinhole::{LinearRgb, Sphere};
use pinhole_data::load::{self, ColumnValues, Dataset, FORMATS, Labels, Options};
use tempfile::TempDir;

use crate::cases::{Case, compare};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name)
}

#[test]
fn refused_files() {
    compare(&folder("refused"), answer);
}

#[test]
fn accepted_files() {
    compare(&folder("accepted"), contents);
}

/// The program's answer to a file that cannot be read.
fn answer(Case { files, arguments }: &Case<'_>) -> String {
    let [(name, bytes)] = &files[..] else { panic!("{arguments}: not one file") };
    let options = options(arguments);
    let error = load::from_bytes(bytes, name, &options).unwrap_err();
    // The error is the same if the file is opened, frame by frame if it has frames.
    let folder = TempDir::new().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    assert_eq!(load::open(&path, &options).unwrap_err().to_string(), error.to_string(), "{name}");
    // A radius that contradicts the file is a usage error.
    let code = if options.radius.is_some() { 2 } else { 1 };
    format!("exit code {code}\nerror: {name}: {error}\n")
}

fn options(arguments: &str) -> Options {
    let words = arguments.split(' ');
    let flag = |name| words.clone().skip_while(|word| *word != name).nth(1);
    let mut options = Options::default();
    options.frame = flag("--frame").map(|frame| frame.parse().unwrap());
    options.radius = flag("--radius").map(|radius| radius.parse().unwrap());
    options.columns = flag("--columns").map_or_else(Vec::new, |names| names.split(',').map(str::to_owned).collect());
    options
}

/// The contents of a file. Several files of one case are different ways to write the same.
fn contents(Case { files, arguments }: &Case<'_>) -> String {
    let read = |(name, bytes): &(&str, Vec<u8>)| {
        load::from_bytes(bytes, name, &options(arguments)).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    let loaded = read(&files[0]);
    for (number, file) in files.iter().enumerate() {
        // The contents are compared as text, because a missing number is not equal to itself.
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
    for (index, Sphere { center: [x, y, z], radius, .. }) in loaded.spheres.with_color(white).enumerate() {
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
            };
        }
        lines.push(line);
    }
    if !loaded.bonds.is_empty() {
        lines.push(format!("bonds {:?}{}", loaded.bonds, if loaded.has_all_bonds { ", which are all" } else { "" }));
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

/// Zeros that are compressed are refused by the first of them, and what is no regular file before it is opened.
/// A name from a file may hold any character.
#[test]
fn notes_escape_names() {
    let atom = "HETATM 4430 CA   HE\u{1b} A 142       8.128   7.371 -15.022  1.00 16.74\n";
    let loaded = load::from_bytes(atom.as_bytes(), "a.pdb", &Options::default()).unwrap();
    let note = "1 atoms CA of the residues HE\\u{1b} have no element and are taken as calcium, because the place of the \
                name says so";
    assert_eq!(loaded.notes, [note]);
}

#[test]
fn bombs_and_special_files_are_refused_at_once() {
    let folder = TempDir::new().unwrap();
    let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
    gzip.write_all(&[0; 1 << 22]).unwrap();
    let bomb = gzip.finish().unwrap();
    for format in FORMATS.iter().filter(|format| !format.extensions.is_empty()) {
        let path = folder.path().join(format!("a.{}.gz", format.extensions[0]));
        std::fs::write(&path, &bomb).unwrap();
        let errors = [load::open(&path, &Options::default()), load::from_bytes(&bomb, &path, &Options::default())];
        for error in errors.map(|read| read.unwrap_err().to_string()) {
            assert_eq!(error, format!("what is compressed here does not start as the format {} does", format.name));
        }
        let special = if cfg!(unix) { Path::new("/dev/zero") } else { folder.path() };
        let error = load::open(special, &Options::default().with_format(format)).unwrap_err().to_string();
        assert!(error.ends_with(": cannot be read: this is not a regular file; copy it to a file"), "{error}");
    }
}
