//! Arrays of spheres from .npy, .npz and raw files. Refused files are in `tests/files/refused`.

use pinhole::SphereArray;
use pinhole_data::load::npy as reader;
use pinhole_data::load::{ColumnValues, Dataset, LoadError, npz, raw};
use pinhole_data::write;

use crate::arrays::{npy, zip};

/// Two spheres: x, y, z, radius.
const ROWS: [[f32; 4]; 2] = [[1.0, 2.0, 3.0, 0.5], [4.0, -5.0, 6.5, 0.25]];

fn read_spheres(file: &[u8], radius: Option<f64>) -> Result<SphereArray, LoadError> {
    reader::read(file, radius).map(|loaded| loaded.spheres)
}

fn read_archive(file: &[u8], radius: Option<f64>) -> Result<SphereArray, LoadError> {
    npz::read(file, radius).map(|loaded| loaded.spheres)
}

fn bytes<const N: usize>(numbers: &[f32], encode: impl Fn(f32) -> [u8; N]) -> Vec<u8> {
    numbers.iter().flat_map(|x| encode(*x)).collect()
}

fn file() -> Vec<u8> {
    npy("<f4", false, "(2, 4)", &bytes(ROWS.as_flattened(), f32::to_le_bytes))
}

#[test]
fn both_precisions_both_byte_orders_both_layouts() {
    let by_column: Vec<f32> = (0..4).flat_map(|column| ROWS.iter().map(move |row| row[column])).collect();
    let wide = SphereArray::F64(ROWS.map(|row| row.map(f64::from)).to_vec());
    let narrow = SphereArray::F32(ROWS.to_vec());
    for (by_columns, numbers) in [(false, ROWS.as_flattened()), (true, &by_column)] {
        for (dtype, data, expected) in [
            ("<f4", bytes(numbers, f32::to_le_bytes), &narrow),
            (">f4", bytes(numbers, f32::to_be_bytes), &narrow),
            ("<f8", bytes(numbers, |x| f64::from(x).to_le_bytes()), &wide),
            (">f8", bytes(numbers, |x| f64::from(x).to_be_bytes()), &wide),
        ] {
            let spheres = read_spheres(&npy(dtype, by_columns, "(2, 4)", &data), None);
            assert_eq!(spheres.as_ref(), Ok(expected), "{dtype} {by_columns}");
        }
        // The array has only the first three columns, with one radius for both spheres.
        let part: Vec<f32> = match by_columns {
            false => ROWS.iter().flat_map(|row| row[..3].to_vec()).collect(),
            true => by_column[..6].to_vec(),
        };
        let data = bytes(&part, f32::to_le_bytes);
        let spheres = read_spheres(&npy("<f4", by_columns, "(2, 3)", &data), Some(0.75)).unwrap();
        let expected = ROWS.map(|[x, y, z, _]| [x, y, z, 0.75]);
        assert_eq!(spheres, SphereArray::F32(expected.to_vec()));
    }
}

#[test]
fn an_array_without_rows_gives_no_spheres() {
    assert!(read_spheres(&npy("<f4", false, "(0, 4)", b""), None).unwrap().is_empty());
    assert!(read_spheres(&npy(">f8", true, "(0, 3)", b""), Some(1.0)).unwrap().is_empty());
    assert!(raw::read_spheres(b"").unwrap().is_empty());
}

#[test]
fn arrays_survive_writing_and_reading() {
    for spheres in [&ROWS[..], &[]] {
        let mut file = Vec::new();
        write::npy(spheres, &mut file).unwrap();
        assert_eq!(read_spheres(&file, None), Ok(SphereArray::F32(spheres.to_vec())));
        assert_eq!(npyz::NpyFile::new(&file[..]).unwrap().shape(), [spheres.len() as u64, 4]);
        let mut file = Vec::new();
        write::raw(spheres, &mut file).unwrap();
        assert_eq!(file.len(), spheres.len() * 16);
        assert_eq!(raw::read_spheres(&file), Ok(SphereArray::F32(spheres.to_vec())));
    }
}

/// This array is long enough for several threads and several chunks.
#[test]
fn long_arrays() {
    let spheres: Vec<[f32; 4]> = (0..200_001).map(|i| [0.0, 1.0, 2.0, i as f32]).collect();
    let mut file = Vec::new();
    write::npy(&spheres, &mut file).unwrap();
    assert_eq!(read_spheres(&file, None), Ok(SphereArray::F32(spheres)));
}

/// Other refused files are in `tests/files/refused/npy.txt`.
#[test]
fn a_header_that_is_cut_off_says_so() {
    let file = file();
    for length in 6..100 {
        let error = read_spheres(&file[..length], None).unwrap_err().to_string();
        assert!(error.starts_with("the .npy header is cut off; "), "{length}: {error}");
    }
}

#[test]
fn archives() {
    let file = file();
    for deflated in [false, true] {
        for names in [&["arr_0.npy"][..], &["spheres.npy", "b.npy"], &["a.txt", "positions.npy"]] {
            let entries: Vec<_> = names.iter().map(|name| (*name, &file[..])).collect();
            let spheres = read_archive(&zip(&entries, deflated), None);
            assert_eq!(spheres, Ok(SphereArray::F32(ROWS.to_vec())), "{names:?} {deflated}");
        }
    }
    let error = |archive: &[u8]| read_archive(archive, None).unwrap_err().to_string();
    assert_eq!(
        error(&zip(&[("a.npy", &file), ("b.npy", &file)], true)),
        "the archive has the arrays `a`, `b`; name the one with the centers `positions`, or `spheres` if it has radii \
         as well"
    );
    assert_eq!(error(&zip(&[("a.txt", &file)], true)), "the archive has no array; save the spheres with numpy.savez");
    assert_eq!(error(&zip(&[], true)), "the archive has no array; save the spheres with numpy.savez");
    let flat = npy("<f4", false, "(8,)", &[0; 32]);
    assert!(error(&zip(&[("a.npy", &flat)], true)).starts_with("array `a`: the array has the shape (8,)"));
    assert!(error(b"not a zip").starts_with("this is not a complete .npz file: "));
    assert!(error(&file).starts_with("this is not a complete .npz file: "));
    let whole = zip(&[("a.npy", &file)], false);
    assert!(error(&whole[..whole.len() - 1]).starts_with("this is not a complete .npz file: "));
}

pub(crate) fn numbers(loaded: &Dataset, name: &str) -> Vec<f64> {
    match loaded.column(name) {
        Some(ColumnValues::Numbers(numbers)) => numbers.clone(),
        other => panic!("{name}: {other:?}"),
    }
}

fn colors(loaded: &Dataset) -> Vec<[u8; 3]> {
    loaded.colors.as_ref().unwrap().iter().map(|color| color.to_srgb8()).collect()
}

/// Every type of numbers gives the same spheres, in both layouts.
#[test]
fn every_type_of_numbers() {
    const WHOLE: [[u8; 4]; 2] = [[1, 2, 3, 4], [5, 6, 7, 8]];
    let by_column: Vec<u8> = (0..4).flat_map(|column| WHOLE.iter().map(move |row| row[column])).collect();
    let expected = SphereArray::F64(WHOLE.map(|row| row.map(f64::from)).to_vec());
    for (is_by_column, numbers) in [(false, WHOLE.as_flattened()), (true, &by_column)] {
        let all = |encode: &dyn Fn(u8) -> Vec<u8>| numbers.iter().flat_map(|x| encode(*x)).collect();
        let half = |x: u8| {
            let exponent = x.ilog2() as u16;
            (exponent + 15) << 10 | (u16::from(x) << (10 - exponent)) & 0x3ff
        };
        let files: [(&str, Vec<u8>); 10] = [
            ("|u1", all(&|x| vec![x])),
            ("|i1", all(&|x| vec![x])),
            ("<u2", all(&|x| u16::from(x).to_le_bytes().to_vec())),
            (">i2", all(&|x| i16::from(x).to_be_bytes().to_vec())),
            ("<i4", all(&|x| i32::from(x).to_le_bytes().to_vec())),
            (">u4", all(&|x| u32::from(x).to_be_bytes().to_vec())),
            ("<i8", all(&|x| i64::from(x).to_le_bytes().to_vec())),
            (">u8", all(&|x| u64::from(x).to_be_bytes().to_vec())),
            ("<f2", all(&|x| half(x).to_le_bytes().to_vec())),
            (">f2", all(&|x| half(x).to_be_bytes().to_vec())),
        ];
        for (dtype, data) in files {
            let spheres = read_spheres(&npy(dtype, is_by_column, "(2, 4)", &data), None);
            assert_eq!(spheres.as_ref(), Ok(&expected), "{dtype} {is_by_column}");
        }
    }
}

#[test]
fn more_columns_are_a_value_or_colors() {
    let of = |shape: &str, numbers: &[f32]| {
        reader::read(&npy("<f4", false, shape, &bytes(numbers, f32::to_le_bytes)), None).unwrap()
    };
    let five = of("(2, 5)", &[0., 0., 0., 1., 7., 9., 0., 0., 2., 8.]);
    assert_eq!(five.spheres, SphereArray::F64(vec![[0., 0., 0., 1.], [9., 0., 0., 2.]]));
    assert_eq!(numbers(&five, "value"), [7.0, 8.0]);
    let six = of("(2, 6)", &[0., 0., 0., 1., 0.5, 0., 4., 0., 0., 0., 0., 1.]);
    assert_eq!(six.spheres, SphereArray::F64(vec![[0., 0., 0., 2.], [4., 0., 0., 2.]]));
    assert_eq!(colors(&six), [[255, 128, 0], [0, 0, 255]]);
    assert!(six.notes[0].contains("the radius 2, with which neighbors about touch"), "{:?}", six.notes);
    let seven = of("(1, 7)", &[1., 2., 3., 4., 255., 0., 17.]);
    assert_eq!((seven.spheres.len(), colors(&seven)), (1, vec![[255, 0, 17]]));
    let three = of("(2, 3)", &[0., 0., 0., 0., 3., 0.]);
    assert_eq!(three.spheres, SphereArray::F32(vec![[0., 0., 0., 1.5], [0., 3., 0., 1.5]]));
    assert!(three.notes[0].contains("--radius sets it"), "{:?}", three.notes);
}

/// Two structures with positions, colours, opacities, text and unused fields.
#[test]
fn fields_have_names() {
    let loaded = reader::read(include_bytes!("../files/good/structured.npy"), None).unwrap();
    assert_eq!(loaded.spheres, SphereArray::F64(vec![[1., 10., 0., 0.5], [2., 20., 0., 1.0]]));
    assert_eq!(colors(&loaded), [[255, 0, 51]; 2]);
    assert_eq!(loaded.opacities, Some(vec![0.2, 0.4]));
    assert_eq!(loaded.labels("kind").unwrap().names, ["Ab", "z"]);
    assert_eq!(numbers(&loaded, "alive"), [0.0, 1.0]);
    assert_eq!(loaded.notes, ["these fields are not used, because they are neither numbers nor text: phase"]);
}

#[test]
fn archives_of_several_arrays() {
    let file = |dtype, shape, data: &[u8]| npy(dtype, false, shape, data);
    let floats = |shape, numbers: &[f32]| file("<f4", shape, &bytes(numbers, f32::to_le_bytes));
    let positions = floats("(2, 3)", &[0., 0., 0., 5., 0., 0.]);
    let radii = floats("(2,)", &[1.5, 2.5]);
    for deflated in [false, true] {
        let loaded = npz::read(
            &zip(
                &[
                    ("radii.npy", &radii),
                    ("positions.npy", &positions),
                    ("colors.npy", &file("|u1", "(2, 4)", &[255, 0, 0, 255, 0, 255, 0, 51])),
                    ("velocity.npy", &floats("(2, 3)", &[1., 2., 3., 4., 5., 6.])),
                    ("mask.npy", &file("|b1", "(2,)", &[0, 1])),
                    ("times.npy", &floats("(3,)", &[0.; 3])),
                    ("step.npy", &floats("()", &[0.])),
                    ("wave.npy", &file("<c8", "(2,)", &[0; 16])),
                ],
                deflated,
            ),
            None,
        )
        .unwrap();
        assert_eq!(loaded.spheres, SphereArray::F32(vec![[0., 0., 0., 1.5], [5., 0., 0., 2.5]]));
        assert_eq!(colors(&loaded), [[255, 0, 0], [0, 255, 0]]);
        assert_eq!(loaded.opacities, Some(vec![1.0, 0.2]));
        assert_eq!(numbers(&loaded, "velocity.y"), [2.0, 5.0]);
        assert_eq!(numbers(&loaded, "mask"), [0.0, 1.0]);
        assert_eq!(
            loaded.notes,
            [
                "these arrays are not used, because they do not have a row for each of the 2 spheres, or are not numbers: \
              `times` has the shape (3,), `step` has the shape (), `wave` has the type <c8"
            ]
        );
    }
    // Each array has one coordinate; the radius follows from the spacing, or is given.
    let axis = |values: [i16; 2]| file("<i2", "(2,)", &values.map(i16::to_le_bytes).concat());
    let (x, y, z) = (axis([0, 0]), axis([0, 7]), axis([1, 1]));
    let archive = zip(&[("x.npy", &x), ("y.npy", &y), ("z.npy", &z)], false);
    let expected = |r| Ok(SphereArray::F64(vec![[0., 0., 1., r], [0., 7., 1., r]]));
    assert_eq!(read_archive(&archive, None), expected(3.5));
    assert_eq!(read_archive(&archive, Some(2.0)), expected(2.0));
    let both = zip(&[("positions.npy", &positions), ("radii.npy", &radii)], false);
    let error = npz::read(&both, Some(1.0)).unwrap_err().to_string();
    assert!(error.contains("the column radii has radii; remove the radius"), "{error}");
    let zero = zip(&[("positions.npy", &positions), ("radius.npy", &floats("(2,)", &[1., 0.]))], false);
    let error = npz::read(&zero, None).unwrap_err().to_string();
    assert_eq!(error, "array `positions`: row 1: radius is 0; a radius must be finite and greater than 0");
}

/// The archive's checksum finds a flipped bit in the numbers.
#[test]
fn damaged_archives() {
    for deflated in [false, true] {
        let mut archive = zip(&[("a.npy", &file())], deflated);
        archive[if deflated { 60 } else { 170 }] ^= 1;
        let error = read_archive(&archive, None).unwrap_err().to_string();
        assert!(error.starts_with("array `a`: "), "{error}");
    }
}

#[test]
fn raw_numbers() {
    let error = raw::read_spheres(&[0; 39]).unwrap_err().to_string();
    assert_eq!(
        error,
        "the file has 39 bytes, which are 2 × 16 + 7, but each sphere takes 16 bytes \
         (x, y, z, radius in little-endian f32); the file is cut off or has another format"
    );
}
