//! Readers of binary formats: files of every layout, and invalid ones. `fuzz` damages others.

use data_encoding::HEXLOWER;
use fastrand::Rng;
use pinhole::SphereArray;
use pinhole_data::load::{ColumnValues, Dataset, Format, LoadError, Options, Trajectory};
use tempfile::TempDir;

use crate::binary_files::dcd::{self, Layout, Order};
use crate::binary_files::gsd::{self, Chunk, Data, chunk, chunks};
use crate::binary_files::{gromacs, topology as topology_file};

/// Reads a file in memory.
fn read(format: &str, bytes: &[u8], options: &Options) -> Result<Dataset, LoadError> {
    Format::of_name(format).unwrap().read(bytes, options)
}

/// The spheres in f64.
fn spheres(loaded: &Dataset) -> Vec<[f64; 4]> {
    match &loaded.spheres {
        SphereArray::F32(all) => all.iter().map(|sphere| sphere.map(f64::from)).collect(),
        SphereArray::F64(all) => all.clone(),
    }
}

/// A topology with this number of oxygen atoms, and options that name it.
fn topology(atoms: usize) -> (TempDir, Options) {
    let folder = TempDir::new().unwrap();
    let options = Options::default().with_topology(topology_file(folder.path(), atoms));
    (folder, options)
}

/// The message of an error, which has one line.
fn refused(loaded: Result<Dataset, LoadError>) -> String {
    let message = loaded.unwrap_err().to_string();
    assert!(!message.contains('\n'), "{message}");
    message
}

#[test]
fn files_with_other_bytes_in_one_place() {
    let [(_folder, of_dcd), (_other, of_gromacs)] = [dcd::ATOMS, gromacs::ATOMS].map(topology);
    let good = [
        ("dcd", dcd::file(dcd::PLAIN), of_dcd.with_frame(1)),
        ("trr", gromacs::trr(false), of_gromacs.clone()),
        ("xtc", gromacs::xtc(2, gromacs::ATOMS, molly::Magic::Xtc1995), of_gromacs),
        ("gsd", gsd::file(2, &chunks()), Options::default()),
    ];
    for line in include_str!("binary.txt").lines().filter(|line| !line.starts_with('#')) {
        let [format, at, bytes, words] = line.splitn(4, ' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let (_, good, options) = good.iter().find(|(name, ..)| *name == format).unwrap();
        let (at, bytes) = (at.parse::<usize>().unwrap(), HEXLOWER.decode(bytes.as_bytes()).unwrap());
        let mut file = good.clone();
        file[at..at + bytes.len()].copy_from_slice(&bytes);
        let message = refused(read(format, &file, options));
        let is_said = match words.strip_prefix('…') {
            Some(words) => message.contains(words),
            None => message.starts_with(words),
        };
        assert!(is_said, "{line}: {message}");
    }
}

fn read_dcd(bytes: &[u8], frame: usize) -> Result<Dataset, LoadError> {
    let (_folder, options) = topology(dcd::ATOMS);
    read("dcd", bytes, &options.with_frame(frame))
}

#[test]
fn every_layout_of_dcd() {
    let cell = [10.0, 90.0, 20.0, 90.0, 90.0, 30.0];
    for bits in 0..16 {
        let [is_big, is_wide, has_fourth, has_fixed] = [1, 2, 4, 8].map(|bit| bits & bit != 0);
        let order = if is_big { Order::Big } else { Order::Little };
        let marker_bytes = if is_wide { 8 } else { 4 };
        let cell = Some(cell).filter(|_| has_fourth != has_fixed);
        let layout = Layout { order, marker_bytes, cell, has_fourth, has_fixed };
        let bytes = dcd::file(layout);
        assert_eq!(Format::of_content(&bytes).unwrap().name, "dcd");
        for frame in [2, 0, 1] {
            let loaded = read_dcd(&bytes, frame).unwrap();
            assert_eq!(loaded.frames, Some(dcd::FRAMES_WRITTEN));
            let edges = [[10.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 30.0]];
            assert_eq!(loaded.cell, cell.map(|_| edges));
            assert_eq!(loaded.notes.len(), usize::from(has_fourth));
            for (atom, [x, y, z, radius]) in spheres(&loaded).into_iter().enumerate() {
                let is_fixed = has_fixed && (1..3).contains(&atom);
                let from = if is_fixed { 0 } else { frame };
                let expected = [0, 1, 2].map(|axis| dcd::coordinate(from, atom, axis).into());
                assert_eq!(([x, y, z], radius), (expected, 1.5), "{bits} {frame} {atom}");
            }
        }
    }
}

#[test]
fn cells_of_dcd_in_three_variants() {
    let edges = |cell| {
        let edges = read_dcd(&dcd::file(Layout { cell: Some(cell), ..dcd::PLAIN }), 0).unwrap().cell;
        edges.map(|edges| edges.as_flattened().iter().map(|v| (v * 1e6).round() / 1e6).collect())
    };
    // The cells are given by degrees, cosines and a matrix; one file has none.
    let slanted: Option<Vec<f64>> = Some(vec![10.0, 0.0, 0.0, 10.0, 17.320508, 0.0, 0.0, 0.0, 30.0]);
    assert_eq!(edges([10.0, 60.0, 20.0, 90.0, 90.0, 30.0]), slanted);
    assert_eq!(edges([10.0, 0.5, 20.0, 0.0, 0.0, 30.0]), slanted);
    let matrix = edges([10.0, -2.0, 20.0, -3.0, 4.0, 30.0]);
    assert_eq!(matrix, Some(vec![10.0, -2.0, -3.0, -2.0, 20.0, 4.0, -3.0, 4.0, 30.0]));
    assert_eq!(edges([0.0; 6]), None);
    for cell in [[f64::NAN; 6], [-1.0, 90.0, 1.0, 90.0, 90.0, 1.0]] {
        let message = refused(read_dcd(&dcd::file(Layout { cell: Some(cell), ..dcd::PLAIN }), 0));
        assert!(message.starts_with("byte 276: frame 0: the unit cell ["), "{message}");
    }
}

#[test]
fn bad_dcd_files() {
    let good = dcd::file(dcd::PLAIN);
    let start = good.len() - dcd::FRAMES_WRITTEN * 72;
    assert_eq!(
        refused(read_dcd(b"12\n\nO 0 0 0\n", 0)),
        "this is not a dcd file: it does not start with a record of 84 bytes for CORD"
    );
    for length in 0..start + 72 {
        refused(read_dcd(&good[..length], 0));
    }
    // A fault after complete frames is a note, and the frames can be read.
    let cut = read_dcd(&good[..good.len() - 5], 1).unwrap();
    let left = format!("byte {}: frame 2 takes 72 bytes, but the file ends after 67", start + 144);
    assert!(cut.notes[0].starts_with(&left), "{:?}", cut.notes);
    let message = refused(read_dcd(&good[..good.len() - 5], 2));
    assert!(message.starts_with(&left), "{message}");
}

#[test]
fn a_topology_must_be_there_and_fit() {
    let missing = refused(read("dcd", &dcd::file(dcd::PLAIN), &Options::default()));
    assert!(missing.starts_with("a dcd file has positions alone; give a topology"), "{missing}");
    let (_folder, options) = topology(3);
    let message = refused(read("dcd", &dcd::file(dcd::PLAIN), &options));
    assert!(message.starts_with("frame 0 has 4 atoms, but the topology "), "{message}");
    assert!(message.contains("3.xyz has 3; use a file of the same system"), "{message}");
    let nowhere = refused(read("dcd", &dcd::file(dcd::PLAIN), &Options::default().with_topology("no.pdb")));
    assert!(nowhere.starts_with("the topology no.pdb: the file cannot be read: "), "{nowhere}");
}

/// A cut trajectory has the complete frames when it is read from a file.
#[test]
fn a_trajectory_seeks() {
    let (folder, options) = topology(dcd::ATOMS);
    let path = folder.path().join("a.dcd");
    let good = dcd::file(dcd::PLAIN);
    std::fs::write(&path, &good[..good.len() - 1]).unwrap();
    let mut trajectory = Trajectory::open(&path, &options).unwrap();
    assert_eq!((trajectory.len(), trajectory.frame_bytes(1)), (2, Some(72)));
    assert!(trajectory.problem().unwrap().to_string().contains("frame 2 takes 72 bytes"));
    let loaded = trajectory.frame(1).unwrap();
    assert_eq!(spheres(&loaded)[0][0], 100.25);
    assert_eq!(loaded.labels("species").unwrap().names, ["O"]);
    // A single frame has the same note as one read from memory.
    let alone = pinhole_data::load::open(&path, &options.with_frame(1)).unwrap();
    assert!(alone.notes[0].contains("frame 2 takes 72 bytes"), "{:?}", alone.notes);
}

fn check_gromacs(loaded: &Dataset, frame: usize, atoms: usize) {
    let found = spheres(loaded);
    assert_eq!(found.len(), atoms);
    for (atom, sphere) in found.into_iter().enumerate() {
        let [x, y, z] = [0, 1, 2].map(|axis| 10.0 * gromacs::coordinate(frame, 3 * atom + axis));
        for (found, expected) in sphere.into_iter().zip([x, y, z, 1.5]) {
            assert!((found - expected).abs() < 1e-4, "{frame} {atom}: {sphere:?} {x} {y} {z}");
        }
    }
}

const CELL: [[f64; 3]; 3] = [[20.0, 0.0, 0.0], [5.0, 30.0, 0.0], [0.0, 2.5, 40.0]];

#[test]
fn trr_files() {
    let (_folder, options) = topology(gromacs::ATOMS);
    for is_double in [false, true] {
        let file = gromacs::trr(is_double);
        assert_eq!(Format::of_content(&file).unwrap().name, "trr");
        let first = read("trr", &file, &options).unwrap();
        check_gromacs(&first, 0, gromacs::ATOMS);
        assert_eq!((first.frames, first.cell), (Some(2), Some(CELL)));
        let names: Vec<_> = first.columns.iter().map(|column| column.name.as_str()).collect();
        let expected = ["species", "velocity.x", "velocity.y", "velocity.z", "force.x", "force.y", "force.z"];
        assert_eq!(names, expected);
        for (name, factor) in [("velocity.y", 10.0), ("force.y", 0.1)] {
            let Some(ColumnValues::Numbers(found)) = first.column(name) else { panic!("{name}") };
            assert!((found[1] - factor * gromacs::coordinate(0, 4)).abs() < 1e-6, "{name} {found:?}");
        }
        assert_eq!(first.notes, ["1 frames without positions are left out"]);
        let last = read("trr", &file, &options.clone().with_frame(1)).unwrap();
        check_gromacs(&last, 2, gromacs::ATOMS);
        assert_eq!((last.columns.len(), last.cell), (1, None));
    }
}

#[test]
fn xtc_files() {
    for atoms in [1, 9, 10, 300] {
        for magic in [molly::Magic::Xtc1995, molly::Magic::Xtc2023] {
            let (_folder, options) = topology(atoms);
            let file = gromacs::xtc(3, atoms, magic);
            assert_eq!(Format::of_content(&file).unwrap().name, "xtc");
            for frame in [2, 0] {
                let loaded = read("xtc", &file, &options.clone().with_frame(frame)).unwrap();
                check_gromacs(&loaded, frame, atoms);
                assert_eq!((loaded.frames, loaded.cell), (Some(3), Some(CELL)));
            }
        }
    }
}

#[test]
fn coordinates_of_gromacs_are_a_topology() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.gro");
    let atom = |index: usize| format!("{index:5}SOL     OW{index:5}   0.000   0.000   0.000  1.0000  1.0000  1.0000\n");
    std::fs::write(&path, format!("title\n9\n{}1 1 1\n", (1..=9).map(atom).collect::<String>())).unwrap();
    let options = Options::default().with_topology(&path).with_frame(1);
    let file = gromacs::xtc(2, 9, molly::Magic::Xtc1995);
    let loaded = read("xtc", &file, &options).unwrap();
    check_gromacs(&loaded, 1, 9);
    assert_eq!((loaded.cell, loaded.labels("residue").unwrap().names.len()), (Some(CELL), 1));
    // Velocities of another frame would be wrong.
    assert_eq!(loaded.column("velocity.x"), None);
}

/// Random positions from dense to far apart. For numbers that take more than 64 bits together, molly writes other
/// values than it reads; a test beside the reader has such numbers.
#[test]
fn compressed_positions_are_those_that_molly_reads() {
    let mut random = Rng::with_seed(3);
    for round in 0..40 {
        let atoms = random.usize(10..400);
        let scale = 10_f32.powi(random.i32(-1..4));
        let mut at = [0.0_f32; 3];
        let positions = (0..atoms).flat_map(|atom| {
            if atom % 3 == 0 || round % 4 == 0 {
                at = [(); 3].map(|()| (random.f32() - 0.5) * scale);
            }
            at.map(|value| value + random.f32() * 0.1)
        });
        let frame = molly::Frame { positions: positions.collect(), ..molly::Frame::default() };
        let mut file = Vec::new();
        molly::XTCWriter::new(&mut file).write_frame(&frame).unwrap();
        let mut expected = molly::Frame::default();
        molly::XTCReader::new(file.as_slice()).read_frame(&mut expected).unwrap();
        let (_folder, options) = topology(atoms);
        let found = spheres(&read("xtc", &file, &options).unwrap());
        for (found, expected) in found.iter().zip(expected.coords()) {
            let expected = expected.map(|value| f64::from(value) * 10.0);
            assert_eq!(found[..3], expected, "round {round}, {atoms} atoms, scale {scale}");
        }
    }
}

#[test]
fn bad_trr_and_xtc_files() {
    let (_folder, options) = topology(gromacs::ATOMS);
    let trr = gromacs::trr(false);
    let xtc = gromacs::xtc(2, gromacs::ATOMS, molly::Magic::Xtc1995);
    // A small file that declares a few hundred million atoms allocates nothing for them.
    let mut huge = xtc.clone();
    huge[4..8].copy_from_slice(&290_000_000_i32.to_be_bytes());
    huge[52..56].copy_from_slice(&290_000_000_i32.to_be_bytes());
    let message = refused(read("xtc", &huge, &options));
    assert!(message.contains("bytes are too few for 290000000 atoms"), "{message}");
    for (format, file, frame) in [("trr", &trr, 0), ("xtc", &xtc, 0)] {
        let end = file.len();
        let cut = read(format, &file[..end - 3], &options.clone().with_frame(frame)).unwrap();
        assert!(
            cut.notes[0].contains("it is cut off or still being written") || cut.notes.len() > 1,
            "{:?}",
            cut.notes
        );
        let message = refused(read(format, &file[..end - 3], &options.clone().with_frame(1)));
        assert!(message.contains("it is cut off or still being written"), "{message}");
        for length in 0..90 {
            refused(read(format, &file[..length], &options));
        }
    }
    let (_folder, three) = topology(3);
    for (format, file) in [("trr", &trr), ("xtc", &xtc)] {
        let message = refused(read(format, file, &three));
        assert!(message.starts_with("frame 0 has 12 atoms, but the topology "), "{message}");
    }
}

fn gsd_frame(bytes: &[u8], frame: usize) -> Dataset {
    read("gsd", bytes, &Options::default().with_frame(frame)).unwrap()
}

fn names(loaded: &Dataset) -> Vec<&str> {
    loaded.columns.iter().map(|column| column.name.as_str()).collect()
}

#[test]
fn gsd_frames_inherit_from_the_first() {
    for version in [1, 2] {
        let bytes = gsd::file(version, &chunks());
        assert_eq!(Format::of_content(&bytes).unwrap().name, "gsd");
        let first = gsd_frame(&bytes, 0);
        assert_eq!(spheres(&first), [[0.0, 1.0, 2.0, 1.0], [3.0, 4.0, 5.0, 1.5], [6.0, 7.0, 8.0, 2.0]]);
        assert_eq!(names(&first), ["species", "image.x", "image.y", "image.z", "energy"]);
        let cell = [[10.0, 0.0, 0.0], [10.0, 20.0, 0.0], [7.5, 3.75, 30.0]];
        assert_eq!((first.frames, first.cell, &first.colors), (Some(3), Some(cell), &None));
        let unused = "these parts of the file are not used: log/temperature, particles/orientation";
        assert_eq!(first.notes, [unused]);
        let species = first.labels("species").unwrap();
        assert_eq!((species.names.as_slice(), &*species.indices), (&["A".into(), "poly".into()][..], &[1, 0, 1][..]));
        assert_eq!(first.column("image.y"), Some(&ColumnValues::Numbers(vec![-3.0, 0.0, 3.0])));
        let second = gsd_frame(&bytes, 1);
        assert_eq!(spheres(&second)[2], [106.0, 107.0, 108.0, 2.0]);
        assert_eq!(first.cell_origin, [-13.75, -11.875, -15.0]);
        assert_eq!([&first, &second].map(|frame| (&*frame.bonds, frame.has_all_bonds)), [(&[[0, 1]][..], true); 2]);
        assert_eq!((second.cell, second.column("energy")), (Some(cell), first.column("energy")));
        // A frame with another number of particles has the defaults.
        let third = gsd_frame(&bytes, 2);
        assert_eq!(spheres(&third), [[200.0, 201.0, 202.0, 0.5], [203.0, 204.0, 205.0, 0.5]]);
        assert!(third.bonds.is_empty());
        assert_eq!((names(&third), &*third.labels("species").unwrap().indices), (vec!["species"], &[0, 0][..]));
    }
}

#[test]
fn bonds_of_gsd() {
    let frame = |columns, ends: Vec<u32>| {
        let mut all = chunks();
        all.retain(|chunk| chunk.name != "bonds/group");
        let second = all.iter().position(|chunk| chunk.frame == 1).unwrap();
        all.insert(second, chunk(1, "bonds/N", 1, Data::U32(vec![0])));
        all.insert(second, chunk(0, "bonds/group", columns, Data::U32(ends)));
        gsd::file(2, &all)
    };
    let good = frame(2, vec![2, 1, 0, 2, 1, 2]);
    assert_eq!(gsd_frame(&good, 0).bonds, [[0, 2], [1, 2]]);
    assert!(gsd_frame(&good, 1).bonds.is_empty());
    for (columns, ends, said) in [
        (2, vec![0, 1, 1, 3], "has the particle 3 in bond 1, but there are 3 particles"),
        (3, vec![0, 1, 2], "has 3 numbers for each bond, but must have those of two particles"),
    ] {
        let message = refused(read("gsd", &frame(columns, ends), &Options::default()));
        assert!(message.ends_with(&format!("frame 0: the chunk bonds/group {said}")), "{message}");
    }
}

#[test]
fn gsd_types_that_are_elements_have_radii_and_colors() {
    let atoms = |types: &[u8], columns| {
        gsd::file(
            2,
            &[
                chunk(0, "particles/N", 1, Data::U32(vec![2])),
                chunk(0, "particles/position", 3, Data::F32(vec![0.0, 0.0, 0.0, 5.0, 0.0, 0.0])),
                chunk(0, "particles/types", columns, Data::U8(types.to_vec())),
                chunk(0, "particles/typeid", 1, Data::U32(vec![0, 1])),
            ],
        )
    };
    let water = gsd_frame(&atoms(b"O\0H\0", 2), 0);
    assert_eq!(spheres(&water).iter().map(|s| s[3]).collect::<Vec<_>>(), [1.5, 1.2]);
    assert_eq!(water.colors.unwrap()[0].to_srgb8(), [241, 59, 59]);
    assert!(water.notes[0].starts_with("there are no diameters; the types are chemical elements"));
    // B is the symbol of boron, but A is not an element.
    let beads = gsd_frame(&atoms(b"A\0B\0", 2), 0);
    assert_eq!(spheres(&beads).iter().map(|s| s[3]).collect::<Vec<_>>(), [0.5, 0.5]);
    assert_eq!((beads.colors, beads.notes), (None, vec![]));
    let options = Options::default().with_radius(2.0);
    let large = read("gsd", &atoms(b"O\0H\0", 2), &options).unwrap();
    assert_eq!(spheres(&large).iter().map(|s| s[3]).collect::<Vec<_>>(), [2.0, 2.0]);
    let message = refused(read("gsd", &gsd::file(2, &chunks()), &options));
    assert!(message.starts_with("the column diameter has radii; remove the radius"), "{message}");
}

#[test]
fn bad_gsd_files() {
    let bad = |changed: Chunk| {
        let mut all = chunks();
        let place = all.iter().position(|chunk| chunk.name == changed.name).unwrap();
        all[place] = changed;
        refused(read("gsd", &gsd::file(2, &all), &Options::default()))
    };
    assert_eq!(
        refused(read("gsd", b"1\n\nO 0 0 0\n", &Options::default())),
        "this is not a gsd file: it is shorter than the header of 256 bytes"
    );
    let nan = bad(chunk(0, "particles/position", 3, Data::F64([[0.0; 8], [f64::NAN; 8]].concat()[..9].to_vec())));
    assert!(nan.contains("frame 0: the z coordinate of atom 2 is NaN; a position must be finite"), "{nan}");
    for (changed, expected) in [
        (chunk(0, "particles/position", 3, Data::F32(vec![0.0; 6])), "has 2 × 3 numbers, but must have 3 × 3"),
        (chunk(0, "particles/typeid", 1, Data::U32(vec![0, 1, 2])), "particle 2 has the type 2, but there are 2 types"),
        (chunk(0, "particles/diameter", 1, Data::F32(vec![1.0, 0.0, 1.0])), "row 1: diameter is 0; a radius must be"),
        (chunk(0, "configuration/box", 1, Data::F32(vec![1.0; 5])), "the box is not six finite numbers"),
        (chunk(0, "particles/N", 1, Data::U32(vec![u32::MAX])), "but must have 4294967295 × 3"),
    ] {
        let message = bad(changed);
        assert!(message.contains(expected), "{message}");
    }
    let alone = gsd::file(2, &[chunk(0, "particles/N", 1, Data::U32(vec![u32::MAX]))]);
    let message = refused(read("gsd", &alone, &Options::default()));
    assert!(message.contains("declares 4294967295 particles, but has no particles/position"), "{message}");
    let none = refused(read("gsd", &gsd::file(2, &[]), &Options::default()));
    assert_eq!(none, "this is not a gsd file: the file has no frames");
}

/// Chunks in the same place are not read repeatedly.
#[test]
fn gsd_chunks_over_each_other() {
    let mut all = chunks();
    const NAMES: [&str; 4] = ["log/particles/a", "log/particles/b", "log/particles/c", "log/particles/d"];
    all.truncate(11);
    all.extend(NAMES.map(|name| chunk(0, name, 60, Data::F64(vec![0.0; 180]))));
    let mut bytes = gsd::file(2, &all);
    let index = u64::from_le_bytes(*bytes[8..].first_chunk().unwrap()) as usize;
    let place = bytes[index + 11 * 32 + 16..][..8].to_vec();
    for entry in 12..15 {
        bytes[index + entry * 32 + 16..][..8].copy_from_slice(&place);
    }
    bytes.truncate(bytes.len() - 3 * 1440);
    let message = refused(read("gsd", &bytes, &Options::default()));
    assert!(message.contains("frame 0: its chunks take more bytes than the file has"), "{message}");
}

#[test]
fn a_cut_gsd_file_has_the_frames_before() {
    let good = gsd::file(2, &chunks());
    let cut = gsd_frame(&good[..good.len() - 1], 1);
    assert!(cut.notes[1].contains("frame 2: the chunk particles/position has 2 × 3 numbers"), "{:?}", cut.notes);
    let options = Options::default().with_frame(2);
    let message = refused(read("gsd", &good[..good.len() - 1], &options));
    assert!(message.contains("it is cut off or still being written"), "{message}");
    for length in 0..good.len() - 24 * 4 {
        refused(read("gsd", &good[..length], &options));
    }
}
