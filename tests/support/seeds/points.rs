//! Good files of formats for clouds of points.

use std::io::Write as _;

use data_encoding::BASE64;
use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::Seed;

pub(super) fn las() -> Vec<Seed> {
    let file = |format: u8, minor: u8, length: u16| {
        let header: u16 = if minor >= 4 { 375 } else { 227 };
        let mut bytes = vec![0; usize::from(header)];
        let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
        put(0, b"LASF");
        put(24, &[1, minor]);
        put(94, &header.to_le_bytes());
        put(96, &u32::from(header).to_le_bytes());
        put(104, &[format]);
        put(105, &length.to_le_bytes());
        put(107, &2_u32.to_le_bytes());
        if minor >= 4 {
            put(247, &2_u64.to_le_bytes());
        }
        for axis in 0..3 {
            put(131 + 8 * axis, &0.01_f64.to_le_bytes());
        }
        bytes.extend((0..2 * length).map(|byte| byte as u8));
        Seed::new(bytes)
    };
    vec![file(2, 2, 26), file(7, 4, 40)]
}

pub(super) fn ply() -> Vec<Seed> {
    let header = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 2\nproperty float x\nproperty double y\n\
                  property short z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n";
    let faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let text = format!("{header}{faces}0 0.5 0 255 0 0\n1 -2.5e0 3 0 0 255\n3 0 1 0\n");
    let mut little = format!("{header}property list uchar int near\nelement edge 0\nend_header\n")
        .replace("ascii", "binary_little_endian")
        .into_bytes();
    let mut big = format!("{header}{faces}").replace("ascii", "binary_big_endian").into_bytes();
    for i in 0..2_u8 {
        let (x, y, z) = (f32::from(i), 0.5 * f64::from(i), i16::from(i));
        little.extend(
            [&x.to_le_bytes()[..], &y.to_le_bytes(), &z.to_le_bytes(), &[i, 2, 3, 1]].concat(),
        );
        little.extend(7_i32.to_le_bytes());
        big.extend([&x.to_be_bytes()[..], &y.to_be_bytes(), &z.to_be_bytes(), &[i, 2, 3]].concat());
    }
    big.extend([&[1][..], &0_i32.to_be_bytes()].concat());
    vec![Seed::new(text), Seed::new(little), Seed::new(big)]
}

pub(super) fn vtk() -> Vec<Seed> {
    let file = |attributes: &str, arrays: [String; 3], appended: &[u8]| {
        let [points, radius, cells] = arrays;
        let xml = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" {attributes}><PolyData>\
             <Piece NumberOfPoints=\"2\" NumberOfPolys=\"1\"><PointData Scalars=\"radius\">{radius}</PointData>\
             <CellData>{cells}</CellData><Points>{points}</Points></Piece></PolyData>"
        );
        [xml.as_bytes(), appended, b"</VTKFile>\n"].concat()
    };
    let array = |name: &str, kind: &str, components: usize, rest: &str| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" {rest}</DataArray>"
        )
    };
    let all = |data: [&str; 3]| {
        [
            array("Points", "Float32", 3, data[0]),
            array("Radius", "Float64", 1, data[1]),
            array("material", "UInt8", 1, data[2]),
        ]
    };
    let points: Vec<u8> =
        [0.0_f32, 0.5, -1.0, 2.0, 3.0, 4.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let radii: Vec<u8> = [0.25_f64, 0.5].iter().flat_map(|x| x.to_le_bytes()).collect();
    let with_length = |bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), bytes].concat();
    let [points_raw, radii_raw, cells_raw] = [&points[..], &radii, &[1]].map(with_length);
    let inline = |bytes: &[u8]| format!("format=\"binary\">\n  {}\n", BASE64.encode(bytes));
    let compressed = |bytes: &[u8]| {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(bytes).unwrap();
        let block = encoder.finish().unwrap();
        let numbers = [1, bytes.len() as u64, 0, block.len() as u64];
        let header: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        format!("format=\"binary\">{}{}", BASE64.encode(&header), BASE64.encode(&block))
    };
    let appended = [&points_raw[..], &radii_raw, &cells_raw].concat();
    let offset = |offset: usize| format!("format=\"appended\" offset=\"{offset}\">");
    let offsets = [0, points_raw.len(), points_raw.len() + radii_raw.len()].map(offset);
    let wide =
        "byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"";
    let texts = ["format=\"ascii\">0 0.5 -1 2 3 4", ">\n0.25 0.5", ">1"];
    vec![
        Seed::new(file("byte_order=\"BigEndian\"", all(texts), b"")),
        Seed::new(file(
            "",
            all([&points_raw, &radii_raw, &cells_raw].map(|b| inline(b)).each_ref().map(|s| &**s)),
            b"",
        )),
        Seed::new(file(
            wide,
            all([&points[..], &radii, &[1]].map(compressed).each_ref().map(|s| &**s)),
            b"",
        )),
        Seed::new(file(
            "",
            all(offsets.each_ref().map(|s| &**s)),
            &[b"<AppendedData encoding=\"raw\">_", &appended[..], b"</AppendedData>"].concat(),
        )),
    ]
}
