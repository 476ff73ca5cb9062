//! TRR and XTC files, bad files and noise.

use pinhole::load::{ColumnValues, Format, Loaded, Options};

use super::{Rng, mutations, read, refused, spheres, topology};
use crate::binary_files::gromacs::{ATOMS, coordinate, trr, xtc};

fn check(loaded: &Loaded, frame: usize, atoms: usize) {
    let found = spheres(loaded);
    assert_eq!(found.len(), atoms);
    for (atom, sphere) in found.into_iter().enumerate() {
        let [x, y, z] = [0, 1, 2].map(|axis| 10.0 * coordinate(frame, 3 * atom + axis));
        for (found, expected) in sphere.into_iter().zip([x, y, z, 1.5]) {
            assert!((found - expected).abs() < 1e-4, "{frame} {atom}: {sphere:?} {x} {y} {z}");
        }
    }
}

const CELL: [[f64; 3]; 3] = [[20.0, 0.0, 0.0], [5.0, 30.0, 0.0], [0.0, 2.5, 40.0]];

#[test]
fn full_precision() {
    let (_folder, options) = topology(ATOMS);
    for is_double in [false, true] {
        let file = trr(is_double);
        assert_eq!(Format::of_content(&file).unwrap().name, "trr");
        let first = read("trr", &file, &options).unwrap();
        check(&first, 0, ATOMS);
        assert_eq!((first.frames, first.cell), (Some(2), Some(CELL)));
        let names: Vec<_> = first.columns.iter().map(|column| column.name.as_str()).collect();
        let expected =
            ["species", "velocity.x", "velocity.y", "velocity.z", "force.x", "force.y", "force.z"];
        assert_eq!(names, expected);
        for (name, factor) in [("velocity.y", 10.0), ("force.y", 0.1)] {
            let Some(ColumnValues::Numbers(found)) = first.column(name) else { panic!("{name}") };
            assert!((found[1] - factor * coordinate(0, 4)).abs() < 1e-6, "{name} {found:?}");
        }
        assert_eq!(first.notes, ["1 frames without positions are left out"]);
        let last = read("trr", &file, &options.clone().with_frame(1)).unwrap();
        check(&last, 2, ATOMS);
        assert_eq!((last.columns.len(), last.cell), (1, None));
    }
}

#[test]
fn compressed() {
    for atoms in [1, 9, 10, 300] {
        for magic in [molly::Magic::Xtc1995, molly::Magic::Xtc2023] {
            let (_folder, options) = topology(atoms);
            let file = xtc(3, atoms, magic);
            assert_eq!(Format::of_content(&file).unwrap().name, "xtc");
            for frame in [2, 0] {
                let loaded = read("xtc", &file, &options.clone().with_frame(frame)).unwrap();
                check(&loaded, frame, atoms);
                assert_eq!((loaded.frames, loaded.cell), (Some(3), Some(CELL)));
            }
        }
    }
}

/// Random positions from dense to far apart. Of numbers that take more than 64 bits together, molly writes others than it
/// reads; a test beside the reader has such.
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
fn bad_files() {
    let (_folder, options) = topology(ATOMS);
    let trr = trr(false);
    let xtc = xtc(2, ATOMS, molly::Magic::Xtc1995);
    let bad = |format: &str, good: &[u8], at: usize, bytes: &[u8], options: &Options| {
        let mut file = good.to_vec();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        refused(read(format, &file, options))
    };
    for (at, bytes, expected) in [
        (0, 5_i32.to_be_bytes(), "this is not a trr file: a frame must start with 1993"),
        (4, [b'x'; 4], "this is not a trr file: "),
        (52, (-8_i32).to_be_bytes(), "byte 52: frame 0: the positions takes -8 bytes"),
        (
            64,
            7_i32.to_be_bytes(),
            "byte 64: frame 0: box, positions, velocities and forces of 7 atoms",
        ),
        (64, (-7_i32).to_be_bytes(), "byte 64: frame 0: it declares -7 atoms"),
        (
            84 + 72 + 4,
            f32::NAN.to_be_bytes(),
            "byte 160: frame 0: the y coordinate of atom 0 is NaN",
        ),
        (
            84,
            f32::INFINITY.to_be_bytes(),
            "byte 84: frame 0: the cell has a number that is not finite",
        ),
    ] {
        let message = bad("trr", &trr, at, &bytes, &options);
        assert!(message.starts_with(expected), "{message}");
    }
    for (at, bytes, expected) in [
        (0, 5_i32.to_be_bytes(), "this is not a xtc file: a frame must start with 1995 or 2023"),
        (4, 13_i32.to_be_bytes(), "byte 4: frame 0: it declares 13 and then 12 atoms"),
        (56, 0_f32.to_be_bytes(), "byte 56: frame 0: the precision is 0"),
        (56, f32::NAN.to_be_bytes(), "byte 56: frame 0: the precision is NaN"),
        (84, 99_i32.to_be_bytes(), "byte 56: frame 0: the size of differences has the index 99"),
        (60, i32::MAX.to_be_bytes(), "byte 56: frame 0: positions go from [2147483647, "),
        (88, 0_i32.to_be_bytes(), "byte 88: frame 0: 0 bytes are too few for 12 atoms"),
        (88, (-1_i32).to_be_bytes(), "byte 92: frame 0 takes 4294967296 bytes, but the file ends"),
        (88, 2_i32.to_be_bytes(), "byte 9"),
    ] {
        let message = bad("xtc", &xtc, at, &bytes, &options);
        assert!(message.starts_with(expected), "{message}");
    }
    // Of a few hundred million atoms in a small file, nothing is kept.
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

#[test]
fn noise_never_panics() {
    let mut random = Rng::with_seed(8);
    for (format, atoms, file) in [
        ("trr", ATOMS, trr(false)),
        ("trr", ATOMS, trr(true)),
        ("xtc", ATOMS, xtc(2, ATOMS, molly::Magic::Xtc1995)),
        ("xtc", 60, xtc(2, 60, molly::Magic::Xtc2023)),
        ("xtc", 5, xtc(2, 5, molly::Magic::Xtc1995)),
    ] {
        let (_folder, options) = topology(atoms);
        mutations(&mut random, &file, 1500, |bytes, random| {
            let frame = random.usize(..2);
            let _ = read(format, bytes, &options.clone().with_frame(frame));
        });
    }
}
