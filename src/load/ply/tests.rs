use super::super::ColumnValues;
use super::*;
use crate::image::color::LinearRgb;
use crate::scene::sphere_array::SphereArray;

const TEXT: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 2\nproperty float x\nproperty double y\n\
                    property int z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
                    property float radius\nproperty float nx\nproperty list uchar int near\nelement face 1\n\
                    property list uchar int vertex_indices\nend_header\n\
                    0 0.5 0 255 0 0 0.25 0.1 2 7 8\n\n1 -2.5e0 3 0 0 255 0.75 0 0\n3 0 1 0\n";

/// The same as [`TEXT`], as binary data.
fn binary(is_little: bool) -> Vec<u8> {
    let name = if is_little { "binary_little_endian" } else { "binary_big_endian" };
    let header = TEXT.split_inclusive("end_header\n").next().unwrap().replace("ascii", name);
    let mut bytes = header.into_bytes();
    macro_rules! put {
        ($($number:expr),*) => {$(
            bytes.extend(if is_little { $number.to_le_bytes().to_vec() } else { $number.to_be_bytes().to_vec() });
        )*};
    }
    put!(0_f32, 0.5_f64, 0_i32, 255_u8, 0_u8, 0_u8, 0.25_f32, 0.1_f32, 2_u8, 7_i32, 8_i32);
    put!(1_f32, -2.5_f64, 3_i32, 0_u8, 0_u8, 255_u8, 0.75_f32, 0_f32, 0_u8);
    put!(3_u8, 0_i32, 1_i32, 0_i32);
    bytes
}

fn read_text(text: &str) -> Result<Loaded, String> {
    read(text.as_bytes(), &Options::default()).map_err(|error| error.to_string())
}

#[test]
fn text_and_binary_data_are_the_same() {
    let text = read_text(TEXT).unwrap();
    let SphereArray::F64(spheres) = &text.spheres else { panic!("{:?}", text.spheres) };
    assert_eq!(*spheres, [[0.0, 0.5, 0.0, 0.25], [1.0, -2.5, 3.0, 0.75]]);
    let [red, blue] = [[255, 0, 0], [0, 0, 255]].map(LinearRgb::from_srgb8);
    assert_eq!(text.colors, Some(vec![red, blue]));
    assert_eq!(text.column("nx"), Some(&ColumnValues::Numbers(vec![0.1_f32.into(), 0.0])));
    assert_eq!(text.columns.len(), 1);
    assert_eq!(
        text.notes,
        [
            "the property near of the vertices is a list, and is not used",
            "vertices become spheres; not used are 1 of face"
        ]
    );
    assert_eq!(read_text(&TEXT.replace('\n', "\r\n")).unwrap(), text);
    for is_little in [true, false] {
        assert_eq!(read(&binary(is_little), &Options::default()).unwrap(), text);
    }
}

#[test]
fn without_lists_vertices_are_read_column_by_column() {
    let header = "ply\nformat binary_big_endian 1.0\nelement camera 2\nproperty list char double view\n\
                  element vertex 3\nproperty ushort x\nproperty float y\nproperty short z\nproperty uint id\nend_header\n";
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend([&[1, 0, 0, 0, 0, 0, 0, 0, 0][..], &[0]].concat());
    for i in 0..3_u16 {
        bytes.extend(i.to_be_bytes());
        bytes.extend(f32::from(i).to_be_bytes());
        bytes.extend((-2 * i as i16).to_be_bytes());
        bytes.extend((70_000 + u32::from(i)).to_be_bytes());
    }
    let loaded = read(&bytes, &Options::default().with_radius(2.0)).unwrap();
    let SphereArray::F64(spheres) = &loaded.spheres else { panic!("{:?}", loaded.spheres) };
    assert_eq!(spheres[2].to_vec(), [2.0, 2.0, -4.0, 2.0]);
    assert_eq!(
        loaded.column("id"),
        Some(&ColumnValues::Numbers(vec![70_000.0, 70_001.0, 70_002.0]))
    );
    assert_eq!(loaded.notes, ["vertices become spheres; not used are 2 of camera"]);
    let refused = |bytes: &[u8]| read(bytes, &Options::default()).unwrap_err().to_string();
    assert_eq!(
        refused(&bytes[..bytes.len() - 1]),
        format!(
            "byte {}: the header declares `element vertex 3`, which begin here, but the file ends within number 2, counted from 0; it is cut off",
            header.len() + 10
        )
    );
    assert_eq!(
        refused(&[&bytes[..], &[0]].concat()),
        format!(
            "byte {}: there are more data after those of `element vertex 3`, the last that the header declares",
            bytes.len()
        )
    );
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    for (text, expected) in [
        ("", "this is not a PLY file: its first line is not `ply`"),
        ("ply\n", "the header has no line `end_header`"),
        ("ply\nformat ascii 2.0\n", "line 2: the version `2.0` is not 1.0"),
        ("ply\nformat text 1.0\n", "line 2: the format `text` is not one of ascii,"),
        ("ply\nelement vertex many\n", "line 2: `many` is not a valid number of elements"),
        ("ply\nproperty float x\n", "line 2: a property must come after the element"),
        (
            "ply\nelement vertex 1\nproperty real x\n",
            "line 3: `real` is not a type of PLY; these are char",
        ),
        ("ply\nelement vertex 1\nproperty list float int x\n", "line 3: the length of a list"),
        ("ply\nelement vertex 1\nproperty float\n", "line 3: write `property TYPE NAME`"),
        ("ply\nvertices 3\n", "line 2: `vertices 3` is not a line of a PLY header"),
        ("ply\nelement vertex 1\nend_header\n", "line 3: the header ends without a line `format`"),
        (
            "ply\nformat ascii 1.0\nelement point 1\nend_header\n",
            "the header declares no `element vertex`",
        ),
        (
            &format!("{head}end_header\n"),
            "the header declares `element vertex 1`, but the file ends after 0",
        ),
        (&format!("{head}end_header\n0 0\n"), "line 8: the property z is missing"),
        (
            &format!("{head}end_header\n0 x 0\n"),
            "line 8: the property y is `x`, which is not a number",
        ),
        (&format!("{head}end_header\n0 0 0 1\n"), "line 8: there are more values than the 3"),
        (
            &format!("{head}end_header\n0 0 0\n1 1 1\n"),
            "line 9: there are more data after those of `element vertex 1`",
        ),
        (&format!("{head}end_header\n0 nan 0\n"), "row 0: y is NaN; a position must be finite"),
        (
            &head.replace("float z\n", "float w\nend_header\n0 0 0\n"),
            "there are no columns x, y and z; the columns are x, y, w",
        ),
        (&format!("{head}property float radius\nend_header\n0 0 0 -1\n"), "row 0: radius is -1;"),
    ] {
        let error = read_text(text).unwrap_err();
        assert!(error.starts_with(expected), "{text:?}: {error}");
    }
    let many = head
        .replace("vertex 1", "vertex 18446744073709551615")
        .replace("ascii", "binary_little_endian");
    let many = format!("{many}end_header\n");
    let expected = format!("byte {}: the header declares", many.len());
    assert!(read_text(&many).unwrap_err().starts_with(&expected));
}
