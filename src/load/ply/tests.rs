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
}
