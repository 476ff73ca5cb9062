//! Tests of reading arrays of spheres from .npy, .npz and raw files: good files, bad files and noise.

use pinhole::SphereArray;
use pinhole::load::npy::{SpheresError, read_spheres};
use pinhole::load::{npz, raw};
use pinhole::write;
use pinhole::write::npy::write_spheres;

use crate::arrays::{npy, zip};

/// Two spheres: x, y, z, radius.
const ROWS: [[f32; 4]; 2] = [[1.0, 2.0, 3.0, 0.5], [4.0, -5.0, 6.5, 0.25]];

fn bytes<const N: usize>(numbers: &[f32], encode: impl Fn(f32) -> [u8; N]) -> Vec<u8> {
    numbers.iter().flat_map(|x| encode(*x)).collect()
}

fn file() -> Vec<u8> {
    npy("<f4", false, "(2, 4)", &bytes(ROWS.as_flattened(), f32::to_le_bytes))
}

fn message(file: &[u8], radius: Option<f64>) -> String {
    read_spheres(file, radius).unwrap_err().to_string()
}

#[test]
fn both_precisions_both_byte_orders_both_layouts() {
    let by_column: Vec<f32> =
        (0..4).flat_map(|column| ROWS.iter().map(move |row| row[column])).collect();
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
        // The first three columns alone, with one radius for both spheres.
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
        write_spheres(spheres, &mut file).unwrap();
        assert_eq!(read_spheres(&file, None), Ok(SphereArray::F32(spheres.to_vec())));
        assert_eq!(npyz::NpyFile::new(&file[..]).unwrap().shape(), [spheres.len() as u64, 4]);
        let mut file = Vec::new();
        write::raw::write_spheres(spheres, &mut file).unwrap();
        assert_eq!(file.len(), spheres.len() * 16);
        assert_eq!(raw::read_spheres(&file), Ok(SphereArray::F32(spheres.to_vec())));
    }
}

/// This array is long enough for several threads and several chunks.
#[test]
fn long_arrays() {
    let spheres: Vec<[f32; 4]> = (0..200_001).map(|i| [0.0, 1.0, 2.0, i as f32]).collect();
    let mut file = Vec::new();
    write_spheres(&spheres, &mut file).unwrap();
    assert_eq!(read_spheres(&file, None), Ok(SphereArray::F32(spheres)));
}

#[test]
fn arrays_that_are_not_lists_of_spheres() {
    let shape = "it must be (n, 4) for x, y, z, radius or (n, 3) for x, y, z";
    for (shape_of, found) in
        [("(8,)", "(8,)"), ("(2, 5)", "(2, 5)"), ("(1, 2, 4)", "(1, 2, 4)"), ("()", "()")]
    {
        let error = message(&npy("<f4", false, shape_of, &[0; 32]), None);
        assert_eq!(error, format!("the array has the shape {found}, but {shape}"));
    }
    for dtype in ["<f2", "<i4", "|u1", "<c8", "|O", "|b1", "<U3", "<f16"] {
        let error = message(&npy(dtype, false, "(2, 4)", &[0; 32]), None);
        let expected = format!(
            "the array has the type {dtype}, but it must be float32 or float64; save it as a.astype('float32')"
        );
        assert_eq!(error, expected);
    }
    let structure = file_with_header(
        "{'descr': [('x', '<f4'), ('y', '<f4')], 'fortran_order': False, 'shape': (2, 4)}",
    );
    assert!(message(&structure, None).contains("the type a structure of fields"));
    assert_eq!(
        message(&npy("<f4", false, "(2, 3)", &[0; 24]), None),
        "the array has the shape (2, 3) without radii; give one radius for all spheres"
    );
    assert_eq!(
        message(&file(), Some(1.0)),
        "the array has the shape (2, 4) with radii; remove the radius that is given for all spheres"
    );
}

fn file_with_header(text: &str) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((text.len() as u16).to_le_bytes());
    file.extend(text.as_bytes());
    file
}

#[test]
fn files_that_are_not_whole() {
    let file = file();
    let cut = message(&file[..file.len() - 1], None);
    assert_eq!(
        cut,
        "an array of shape (2, 4) and type <f4 takes 32 bytes, but 31 bytes follow the header; the file is cut off"
    );
    let longer = [&file[..], b"\n"].concat();
    assert_eq!(
        message(&longer, None),
        "an array of shape (2, 4) and type <f4 takes 32 bytes, but 33 bytes follow the header; \
         there are other data after the array"
    );
    // Absurd numbers of rows in a header are not trusted.
    for rows in ["1000000000000000000", "18446744073709551615", "4611686018427387904"] {
        for (dtype, order) in [("<f4", false), (">f8", true)] {
            let error = message(&npy(dtype, order, &format!("({rows}, 4)"), &[0; 100]), None);
            assert!(error.contains("but 100 bytes follow the header"), "{error}");
        }
    }
    let sides = "18446744073709551615, 18446744073709551615";
    assert!(message(&npy("<f4", false, &format!("({sides}, 4)"), b""), None).contains("shape"));
    assert_eq!(read_spheres(b"", None), Err(SpheresError::NoNpy));
    assert_eq!(read_spheres(b"PK\x03\x04", None), Err(SpheresError::NoNpy));
    for length in 6..100 {
        let error = message(&file[..length], None);
        assert!(error.starts_with("the .npy header is cut off; "), "{length}: {error}");
    }
    assert!(message(b"\x93NUMPY\x04\x00    ", None).contains("unknown version 4.0"));
    assert!(message(b"\x93NUMPY\x02\x00\xff\xff\xff\xff", None).contains("4294967295 bytes long"));
    assert!(message(b"\x93NUMPY\x01\x00\x02\x00\xff\xff", None).contains("is not valid text"));
    let garbage = file_with_header("import os");
    assert!(message(&garbage, None).contains("is not a valid Python dictionary: `import os`"));
}

#[test]
fn archives() {
    let file = file();
    for deflated in [false, true] {
        for names in [&["arr_0.npy"][..], &["spheres.npy", "b.npy"], &["a.txt", "positions.npy"]] {
            let entries: Vec<_> = names.iter().map(|name| (*name, &file[..])).collect();
            let spheres = npz::read_spheres(&zip(&entries, deflated), None);
            assert_eq!(spheres, Ok(SphereArray::F32(ROWS.to_vec())), "{names:?} {deflated}");
        }
    }
    let error = |archive: &[u8]| npz::read_spheres(archive, None).unwrap_err().to_string();
    assert_eq!(
        error(&zip(&[("a.npy", &file), ("b.npy", &file)], true)),
        "the archive has the arrays `a`, `b`; name the one to read `spheres` or `positions`, or save it alone"
    );
    assert_eq!(
        error(&zip(&[("a.txt", &file)], true)),
        "the archive has no array; save the spheres with numpy.savez"
    );
    assert_eq!(
        error(&zip(&[], true)),
        "the archive has no array; save the spheres with numpy.savez"
    );
    let flat = npy("<f4", false, "(8,)", &[0; 32]);
    assert!(
        error(&zip(&[("a.npy", &flat)], true))
            .starts_with("array `a`: the array has the shape (8,)")
    );
    assert!(error(b"not a zip").starts_with("this is not a complete .npz file: "));
    assert!(error(&file).starts_with("this is not a complete .npz file: "));
    let whole = zip(&[("a.npy", &file)], false);
    assert!(error(&whole[..whole.len() - 1]).starts_with("this is not a complete .npz file: "));
}

/// A flipped bit in the numbers is found by the archive's checksum.
#[test]
fn damaged_archives() {
    for deflated in [false, true] {
        let mut archive = zip(&[("a.npy", &file())], deflated);
        archive[if deflated { 60 } else { 170 }] ^= 1;
        let error = npz::read_spheres(&archive, None).unwrap_err().to_string();
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

#[test]
fn noise_never_panics() {
    let file = file();
    let deep =
        file_with_header("{'descr': [('a', [('b', '<f4', (1, 2))])], 'shape': ((((1,),),),)}");
    let stored = zip(&[("a.npy", &file), ("spheres.npy", &file)], false);
    let deflated = zip(&[("a.npy", &file)], true);
    let mut random = fastrand::Rng::with_seed(18);
    for seed in [&file, &deep, &stored, &deflated] {
        for _ in 0..5_000 {
            let mut bytes = seed.clone();
            for _ in 0..random.usize(1..6) {
                let at = random.usize(..bytes.len());
                match random.u8(..4) {
                    0 => bytes[at] = random.u8(..),
                    1 if bytes.len() > 1 => drop(bytes.remove(at)),
                    2 => bytes.insert(at, *random.choice(b"\n\t '(),:[]{}<>f48901-\\x").unwrap()),
                    _ => bytes.truncate(at.max(1)),
                }
            }
            let radius = random.bool().then_some(1.0);
            let _ = read_spheres(&bytes, radius);
            let _ = npz::read_spheres(&bytes, radius);
            let _ = raw::read_spheres(&bytes);
        }
    }
}
