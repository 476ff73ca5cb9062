//! Files of cylinders and cones.

use pinhole::LinearRgb;
use pinhole::scene::cone::Cone;
use pinhole_data::load::{ConeKind, ConeSet};

use crate::arrays::{npy, zip};

const KINDS: [ConeKind; 2] = [ConeKind::Cylinder, ConeKind::Cone];

/// Two cones: start, end, two radii.
const ROWS: [[f64; 8]; 2] = [[0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.5, 0.5], [1.0, 2.0, 3.0, 4.0, -5.0, 6.5, 0.25, 0.25]];

/// An array of some columns of the rows.
fn array(columns: std::ops::Range<usize>) -> Vec<u8> {
    let bytes: Vec<u8> = ROWS.iter().flat_map(|row| &row[columns.clone()]).flat_map(|x| x.to_le_bytes()).collect();
    let shape = if columns.len() == 1 { "(2,)".to_owned() } else { format!("(2, {})", columns.len()) };
    npy("<f8", false, &shape, &bytes)
}

/// An archive with both ends, and others.
fn archive(others: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let (start, end) = (array(0..3), array(3..6));
    let mut arrays = vec![("start", start.as_slice()), ("end", end.as_slice())];
    arrays.extend(others.iter().map(|(name, data)| (*name, data.as_slice())));
    let named: Vec<_> = arrays.iter().map(|(name, data)| (format!("{name}.npy"), *data)).collect();
    zip(&named.iter().map(|(name, data)| (name.as_str(), *data)).collect::<Vec<_>>(), true)
}

fn read(bytes: &[u8], name: &str, kind: ConeKind) -> Result<ConeSet, String> {
    ConeSet::from_bytes(bytes, name, kind, None).map_err(|error| error.to_string())
}

fn expected() -> Vec<Cone> {
    ROWS.map(|[a, b, c, d, e, f, first, second]| Cone::new([a, b, c], [d, e, f], [first, second])).to_vec()
}

#[test]
fn archives_arrays_and_tables_of_text_say_the_same() {
    let line = |row: &[f64]| row.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let text = |header: &str, columns: usize| {
        let rows: Vec<_> = ROWS.iter().map(|row| line(&row[..columns])).collect();
        [&["# rods".to_owned(), header.to_owned()], &rows[..]].concat().join("\n").into_bytes()
    };
    for (kind, radii, columns, header) in [
        (KINDS[0], ("radius", 6..7), 7, "start_x,start_y,start_z,end_x,end_y,end_z,radius"),
        (KINDS[1], ("radii", 6..8), 8, "start.x,start.y,start.z,end.x,end.y,end.z,radius_start,radius_end"),
    ] {
        let of_both = archive(&[(radii.0, array(radii.1))]);
        for (bytes, name) in
            [(of_both, "rods.npz"), (array(0..columns), "rods.npy"), (text(header, columns), "rods.csv")]
        {
            let found = read(&bytes, name, kind).unwrap();
            assert_eq!((found.cones, found.colors, found.notes), (expected(), None, vec![]), "{name}");
        }
        for (bytes, name) in [(archive(&[]), "rods.npz"), (array(0..6), "rods.npy")] {
            let found = ConeSet::from_bytes(&bytes, name, kind, Some([3.0, 4.0])).unwrap();
            assert!(found.cones.iter().all(|cone| cone.radii == [3.0, 4.0]), "{name}");
            let lacks = read(&bytes, name, kind).unwrap_err();
            assert!(lacks.contains(&format!("or give the key `{}`; it has no other columns", kind.radii())), "{lacks}");
        }
    }
}

#[test]
fn colors_are_those_of_files_of_spheres_and_other_arrays_are_named() {
    let bytes = npy("|u1", false, "(2, 3)", &[255, 0, 0, 0, 0, 128]);
    let (mass, short) = (array(2..3), npy("<f8", false, "(1,)", &[0; 8]));
    let file = archive(&[("radius", array(6..7)), ("color", bytes), ("mass", mass), ("short", short)]);
    let found = read(&file, "a.npz", KINDS[0]).unwrap();
    assert_eq!(found.colors.unwrap(), [[255, 0, 0], [0, 0, 128]].map(LinearRgb::from_srgb8));
    assert_eq!(
        found.notes,
        [
            "these arrays are not used, because they do not have a row for each of the 2 rows of `start`, or are not \
             numbers: `short` has the shape (1,)",
            "these columns are not used, because cylinders have both ends, radii and colors: mass",
        ]
    );
    let table = b"start_x start_y start_z end_x end_y end_z radius r g b\n0 0 0 0 0 1 1 0 0.5 1\n";
    assert_eq!(read(table, "a.csv", KINDS[0]).unwrap().colors.unwrap(), [LinearRgb::from_srgb8([0, 128, 255])]);
}

/// These files, which NumPy wrote, are what the fuzzer damages.
#[test]
fn good_files_are_read() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files/cones");
    for (name, kind, has_colors) in [
        ("cylinders.npz", KINDS[0], true),
        ("cylinders.npy", KINDS[0], false),
        ("cones.npz", KINDS[1], false),
        ("cones.csv", KINDS[1], true),
    ] {
        let found = read(&std::fs::read(folder.join(name)).unwrap(), name, kind).unwrap();
        assert_eq!((found.cones.len(), found.colors.is_some(), found.notes), (2, has_colors, vec![]), "{name}");
        assert_eq!(found.cones[0].start, [0.0; 3]);
    }
}

#[test]
fn files_that_are_no_cylinders_or_cones_are_refused() {
    let short = npy("<f8", false, "(1, 3)", &[0; 24]);
    let only_start = zip(&[("start.npy", &array(0..3)), ("end.npy", &short)], false);
    let no_start = zip(&[("a.npy", &array(0..3)), ("end.npy", &short)], false);
    let header = "start_x,start_y,start_z,end_x,end_y,end_z,radius\n";
    let table = |row: &str| format!("{header}0,0,0,0,0,1,1\n{row}\n").into_bytes();
    for (bytes, name, kind, words) in [
        (
            only_start,
            "a.npz",
            KINDS[0],
            "it lacks columns `end_x`, `end_y` and `end_z`, or array `end` of shape (n, 3); it has no other columns; these \
             arrays are not used, because they do not have a row for each of the 2 rows of `start`, or are not numbers: \
             `end` has the shape (1, 3)",
        ),
        (no_start, "a.npz", KINDS[0], "the archive has no array `start`, but `a`, `end`; name the arrays"),
        (archive(&[("radius", array(6..7))]), "a.npz", KINDS[1], "cones have two radii, and the column radius has one"),
        (archive(&[("radii", array(6..8))]), "a.npz", KINDS[0], "cylinders have one radius, and there are radii.x and"),
        (array(0..5), "a.npy", KINDS[0], "the array has the shape (2, 5), but it must be (n, 7) for start.x, start.y,"),
        (array(0..7), "a.npy", KINDS[1], "the array has the shape (2, 7), but it must be (n, 8) for start.x, start.y,"),
        (b"1\n\nO 0 0 0\n".to_vec(), "a.xyz", KINDS[1], "cones are read from .npy, .npz, .csv, .tsv; save them as one"),
        (table("0,0,x,0,0,1,1"), "a.csv", KINDS[0], "line 3, column 3: start_z is `x`, which is not a number"),
        (table("0,0,,0,0,1,1"), "a.csv", KINDS[0], "row 1: its start is [0.0, 0.0, NaN]"),
        (table("0,0,1,0,0,1,1"), "a.csv", KINDS[0], "row 1: it has no length"),
        (table("0,0,0,0,0,1,-1"), "a.csv", KINDS[0], "row 1: radius is -1; a radius must be finite and greater than 0"),
        (table("0,0,0,0,0,1,1e-5"), "a.csv", KINDS[0], "row 1: its length, 1.0, is more than 10000 times its radius"),
        (b"0,0,0,0,0,1,1\n".to_vec(), "a.csv", KINDS[0], "line 1: the table has no header; add one, such as start_x,"),
    ] {
        let error = read(&bytes, name, kind).unwrap_err();
        assert!(error.starts_with(words), "{error}");
    }
    for (kind, columns) in [(KINDS[0], 7), (KINDS[1], 8)] {
        let both = ConeSet::from_bytes(&array(0..columns), "a.npy", kind, Some([1.0; 2])).unwrap_err().to_string();
        assert!(
            both.ends_with(&format!("remove it, or the key `{}`, which is for all shapes", kind.radii())),
            "{both}"
        );
    }
}
