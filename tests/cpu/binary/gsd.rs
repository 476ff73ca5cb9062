//! GSD files of both versions, bad files and noise.

use pinhole::load::{ColumnValues, Format, Loaded, Options};

use super::{Rng, mutations, read, refused, spheres};
use crate::binary_files::gsd::{Chunk, Data, chunk, chunks, file};

fn frame(bytes: &[u8], frame: usize) -> Loaded {
    read("gsd", bytes, &Options::default().with_frame(frame)).unwrap()
}

fn names(loaded: &Loaded) -> Vec<&str> {
    loaded.columns.iter().map(|column| column.name.as_str()).collect()
}

#[test]
fn frames_inherit_from_the_first() {
    for version in [1, 2] {
        let bytes = file(version, &chunks());
        assert_eq!(Format::of_content(&bytes).unwrap().name, "gsd");
        let first = frame(&bytes, 0);
        assert_eq!(
            spheres(&first),
            [[0.0, 1.0, 2.0, 1.0], [3.0, 4.0, 5.0, 1.5], [6.0, 7.0, 8.0, 2.0]]
        );
        assert_eq!(names(&first), ["species", "image.x", "image.y", "image.z", "energy"]);
        let cell = [[10.0, 0.0, 0.0], [10.0, 20.0, 0.0], [7.5, 3.75, 30.0]];
        assert_eq!((first.frames, first.cell, &first.colors), (Some(3), Some(cell), &None));
        let unused =
            "these parts of the file are not used: bonds, log/temperature, particles/orientation";
        assert_eq!(first.notes, [unused]);
        let species = first.labels("species").unwrap();
        assert_eq!(
            (species.names.as_slice(), &*species.indices),
            (&["A".into(), "poly".into()][..], &[1, 0, 1][..])
        );
        assert_eq!(first.column("image.y"), Some(&ColumnValues::Numbers(vec![-3.0, 0.0, 3.0])));
        let second = frame(&bytes, 1);
        assert_eq!(spheres(&second)[2], [106.0, 107.0, 108.0, 2.0]);
        assert_eq!(first.cell_origin, [-13.75, -11.875, -15.0]);
        assert_eq!((second.cell, second.column("energy")), (Some(cell), first.column("energy")));
        // With another number of particles there are the defaults.
        let third = frame(&bytes, 2);
        assert_eq!(spheres(&third), [[200.0, 201.0, 202.0, 0.5], [203.0, 204.0, 205.0, 0.5]]);
        assert_eq!(
            (names(&third), &*third.labels("species").unwrap().indices),
            (vec!["species"], &[0, 0][..])
        );
    }
}

#[test]
fn types_that_are_elements_have_radii_and_colors() {
    let atoms = |types: &[u8], columns| {
        file(
            2,
            &[
                chunk(0, "particles/N", 1, Data::U32(vec![2])),
                chunk(0, "particles/position", 3, Data::F32(vec![0.0, 0.0, 0.0, 5.0, 0.0, 0.0])),
                chunk(0, "particles/types", columns, Data::U8(types.to_vec())),
                chunk(0, "particles/typeid", 1, Data::U32(vec![0, 1])),
            ],
        )
    };
    let water = frame(&atoms(b"O\0H\0", 2), 0);
    assert_eq!(spheres(&water).iter().map(|s| s[3]).collect::<Vec<_>>(), [1.5, 1.2]);
    assert_eq!(water.colors.unwrap()[0].to_srgb8(), [255, 13, 13]);
    assert!(water.notes[0].starts_with("there are no diameters; the types are chemical elements"));
    // B alone would be boron.
    let beads = frame(&atoms(b"A\0B\0", 2), 0);
    assert_eq!(spheres(&beads).iter().map(|s| s[3]).collect::<Vec<_>>(), [0.5, 0.5]);
    assert_eq!((beads.colors, beads.notes), (None, vec![]));
    let options = Options::default().with_radius(2.0);
    let large = read("gsd", &atoms(b"O\0H\0", 2), &options).unwrap();
    assert_eq!(spheres(&large).iter().map(|s| s[3]).collect::<Vec<_>>(), [2.0, 2.0]);
    let message = refused(read("gsd", &file(2, &chunks()), &options));
    assert!(message.starts_with("the column diameter has radii; remove the radius"), "{message}");
}

#[test]
fn bad_files() {
    let good = file(2, &chunks());
    let with = |at: usize, bytes: &[u8]| {
        let mut file = good.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        refused(read("gsd", &file, &Options::default()))
    };
    let bad = |changed: Chunk| {
        let mut all = chunks();
        let place = all.iter().position(|chunk| chunk.name == changed.name).unwrap();
        all[place] = changed;
        refused(read("gsd", &file(2, &all), &Options::default()))
    };
    assert_eq!(
        refused(read("gsd", b"1\n\nO 0 0 0\n", &Options::default())),
        "this is not a gsd file: it is shorter than the header of 256 bytes"
    );
    assert!(with(0, b"x").starts_with("this is not a gsd file: it does not start with"));
    assert!(with(46, &[7]).starts_with("byte 44: the file has the version 7.0; 1 and 2"));
    assert!(with(112, b"other").starts_with("byte 112: the file has the schema `other`"));
    let most = u64::MAX.to_le_bytes();
    assert!(with(8, &most).contains("the index takes"));
    assert!(with(16, &most).contains("the index takes"));
    assert!(with(24, &most).contains("the list of names takes"));
    assert!(with(32, &most).contains("the list of names takes"));
    let index = u64::from_le_bytes(*good[8..].first_chunk().unwrap()) as usize;
    for (at, bytes, expected) in [
        (8, &most[..], "frame 0: the chunk configuration/box has 18446744073709551615 × 1 numbers"),
        (16, &most, "frame 0: the chunk configuration/box has 6 × 1 numbers from byte 1844674"),
        (20 + 8, &[99], "this entry of the index has the name 99"),
        (30, &[12], "frame 0: the chunk configuration/box has the unknown type 12"),
        (0, &most, "this entry of the index belongs to frame 18446744073709551615"),
    ] {
        let message = with(index + at, bytes);
        assert!(message.starts_with(&format!("byte {index}: {expected}")), "{message}");
    }
    let nan = bad(chunk(
        0,
        "particles/position",
        3,
        Data::F64([[0.0; 8], [f64::NAN; 8]].concat()[..9].to_vec()),
    ));
    assert!(
        nan.contains("frame 0: the z coordinate of atom 2 is NaN; a position must be finite"),
        "{nan}"
    );
    for (changed, expected) in [
        (
            chunk(0, "particles/position", 3, Data::F32(vec![0.0; 6])),
            "has 2 × 3 numbers, but must have 3 × 3",
        ),
        (
            chunk(0, "particles/typeid", 1, Data::U32(vec![0, 1, 2])),
            "particle 2 has the type 2, but there are 2 types",
        ),
        (
            chunk(0, "particles/diameter", 1, Data::F32(vec![1.0, 0.0, 1.0])),
            "row 1: diameter is 0; a radius must be",
        ),
        (
            chunk(0, "configuration/box", 1, Data::F32(vec![1.0; 5])),
            "the box is not six finite numbers",
        ),
        (chunk(0, "particles/N", 1, Data::U32(vec![u32::MAX])), "but must have 4294967295 × 3"),
    ] {
        let message = bad(changed);
        assert!(message.contains(expected), "{message}");
    }
    let alone = file(2, &[chunk(0, "particles/N", 1, Data::U32(vec![u32::MAX]))]);
    let message = refused(read("gsd", &alone, &Options::default()));
    assert!(
        message.contains("declares 4294967295 particles, but has no particles/position"),
        "{message}"
    );
    let none = refused(read("gsd", &file(2, &[]), &Options::default()));
    assert_eq!(none, "this is not a gsd file: the file has no frames");
}

/// Chunks in the same place are not read again and again.
#[test]
fn chunks_over_each_other() {
    let mut all = chunks();
    const NAMES: [&str; 4] =
        ["log/particles/a", "log/particles/b", "log/particles/c", "log/particles/d"];
    all.truncate(11);
    all.extend(NAMES.map(|name| chunk(0, name, 60, Data::F64(vec![0.0; 180]))));
    let mut bytes = file(2, &all);
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
fn a_cut_file_has_the_frames_before() {
    let good = file(2, &chunks());
    let cut = frame(&good[..good.len() - 1], 1);
    assert!(
        cut.notes[1].contains("frame 2: the chunk particles/position has 2 × 3 numbers"),
        "{:?}",
        cut.notes
    );
    let options = Options::default().with_frame(2);
    let message = refused(read("gsd", &good[..good.len() - 1], &options));
    assert!(message.contains("it is cut off or still being written"), "{message}");
    for length in 0..good.len() - 24 * 4 {
        refused(read("gsd", &good[..length], &options));
    }
}

#[test]
fn noise_never_panics() {
    let mut random = Rng::with_seed(9);
    for version in [1, 2] {
        mutations(&mut random, &file(version, &chunks()), 4000, |bytes, random| {
            let _ = read("gsd", bytes, &Options::default().with_frame(random.usize(..3)));
        });
    }
}
