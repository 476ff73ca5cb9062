use std::io::Write as _;

use data_encoding::BASE64;
use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::super::ColumnValues;
use super::*;
use crate::image::color::LinearRgb;
use crate::scene::sphere_array::SphereArray;

const POSITIONS: [f32; 6] = [0.0, 0.5, -1.0, 2.0, 3.0, 4.0];
const RADII: [f64; 2] = [0.25, 0.75];
const COLORS: [u8; 6] = [255, 0, 0, 0, 0, 255];

#[derive(Clone, Copy, Debug)]
enum Form {
    Ascii,
    Binary { is_compressed: bool },
    Appended { is_compressed: bool, is_base64: bool },
}

/// A file of two points in two pieces of one, with the bytes in this order, and lengths of this width.
fn file(form: Form, is_little: bool, is_wide: bool) -> Vec<u8> {
    let length = |length: usize| match (is_wide, is_little) {
        (true, true) => (length as u64).to_le_bytes().to_vec(),
        (true, false) => (length as u64).to_be_bytes().to_vec(),
        (false, true) => (length as u32).to_le_bytes().to_vec(),
        (false, false) => (length as u32).to_be_bytes().to_vec(),
    };
    let zlib = |bytes: &[u8]| {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    };
    // The two parts that VTK encodes in base64, each by itself if they are compressed. Blocks have 8 bytes.
    let parts = |bytes: &[u8], is_compressed: bool| {
        if !is_compressed {
            return vec![[length(bytes.len()), bytes.to_vec()].concat()];
        }
        let blocks: Vec<_> = bytes.chunks(8).map(zlib).collect();
        let mut header = [length(blocks.len()), length(8), length(bytes.len() % 8)].concat();
        header.extend(blocks.iter().flat_map(|block| length(block.len())));
        vec![header, blocks.concat()]
    };
    let in_base64 =
        |parts: Vec<Vec<u8>>| parts.iter().map(|part| BASE64.encode(part)).collect::<String>();
    let mut appended = Vec::new();
    let mut array = |name: &str, kind: &str, components: usize, bytes: Vec<u8>, text: String| {
        let head = format!(
            "<DataArray type='{kind}' Name='{name}' NumberOfComponents='{components}' format="
        );
        match form {
            Form::Ascii => format!("{head}'ascii'>\n {text}\n</DataArray>\n"),
            Form::Binary { is_compressed } => {
                let text = in_base64(parts(&bytes, is_compressed));
                format!(
                    "{head}'binary'>\n {text}\n<InformationKey>7</InformationKey></DataArray>\n"
                )
            }
            Form::Appended { is_compressed, is_base64 } => {
                let offset = appended.len();
                let parts = parts(&bytes, is_compressed);
                appended.extend(if is_base64 {
                    in_base64(parts).into_bytes()
                } else {
                    parts.concat()
                });
                format!("{head}'appended' offset='{offset}'/>\n")
            }
        }
    };
    let mut pieces = String::new();
    for i in 0..2 {
        let positions = &POSITIONS[3 * i..3 * i + 3];
        let colors = &COLORS[3 * i..3 * i + 3];
        let bytes = |x: &f32| if is_little { x.to_le_bytes() } else { x.to_be_bytes() };
        let radius = if is_little { RADII[i].to_le_bytes() } else { RADII[i].to_be_bytes() };
        let text = |numbers: Vec<String>| numbers.join("  ");
        pieces += "<Piece NumberOfPoints='1' NumberOfVerts='1' NumberOfPolys='0'>\n<PointData Scalars='radius'>\n";
        pieces += &array("radius", "Float64", 1, radius.to_vec(), RADII[i].to_string());
        pieces += &array(
            "tint",
            "UInt8",
            3,
            colors.to_vec(),
            text(colors.iter().map(u8::to_string).collect()),
        );
        pieces += "</PointData>\n<Points>\n";
        let positions_bytes = positions.iter().flat_map(bytes).collect();
        pieces += &array(
            "Points",
            "Float32",
            3,
            positions_bytes,
            text(positions.iter().map(f32::to_string).collect()),
        );
        pieces += "</Points>\n<CellData>\n";
        pieces += &array("material &lt;1&gt;", "Int8", 1, vec![1], "1".to_owned());
        pieces += "</CellData>\n</Piece>\n";
    }
    let order = if is_little { "LittleEndian" } else { "BigEndian" };
    let header = if is_wide { " header_type='UInt64'" } else { "" };
    let (compressor, encoding) = match form {
        Form::Ascii => (false, None),
        Form::Binary { is_compressed } => (is_compressed, None),
        Form::Appended { is_compressed, is_base64 } => {
            (is_compressed, Some(if is_base64 { "base64" } else { "raw" }))
        }
    };
    let compressor = if compressor { " compressor='vtkZLibDataCompressor'" } else { "" };
    let mut file = format!(
        "<?xml version='1.0'?>\n<VTKFile type='PolyData' version='1.0' byte_order='{order}'{header}{compressor}>\n\
         <PolyData>\n<Piece NumberOfPoints='0'/>\n{pieces}</PolyData>\n"
    )
    .into_bytes();
    if let Some(encoding) = encoding {
        file.extend(format!("<AppendedData encoding='{encoding}'>\n _").bytes());
        file.extend(appended);
        file.extend(b"\n</AppendedData>\n");
    }
    file.extend(b"</VTKFile>\n");
    file
}

fn forms() -> Vec<Form> {
    let mut forms = vec![Form::Ascii];
    for is_compressed in [false, true] {
        forms.push(Form::Binary { is_compressed });
        forms.extend([false, true].map(|is_base64| Form::Appended { is_compressed, is_base64 }));
    }
    forms
}

fn refused(file: &[u8]) -> String {
    read(file, &Options::default()).unwrap_err().to_string()
}

#[test]
fn every_way_to_write_an_array_is_read() {
    for form in forms() {
        for (is_little, is_wide) in [(true, false), (true, true), (false, false), (false, true)] {
            let file = file(form, is_little, is_wide);
            assert!(starts(&file));
            let loaded =
                read(&file, &Options::default()).unwrap_or_else(|e| panic!("{form:?}: {e}"));
            let SphereArray::F64(spheres) = &loaded.spheres else { panic!("{:?}", loaded.spheres) };
            assert_eq!(*spheres, [[0.0, 0.5, -1.0, 0.25], [2.0, 3.0, 4.0, 0.75]], "{form:?}");
            let [red, blue] = [[255, 0, 0], [0, 0, 255]].map(LinearRgb::from_srgb8);
            assert_eq!(loaded.colors, Some(vec![red, blue]), "{form:?}");
            assert_eq!(loaded.columns, [], "{form:?}");
            assert_eq!(loaded.notes, ["not used: the array material <1> of cells"; 2], "{form:?}");
        }
    }
}

#[test]
fn arrays_that_are_cut_off_or_damaged_are_refused() {
    for form in forms() {
        let file = file(form, true, false);
        for end in 0..file.len() {
            let _ = read(&file[..end], &Options::default());
        }
        let points = [&b"NumberOfPoints='1'"[..], b"NumberOfPoints='7'"];
        let at = file.windows(18).position(|window| window == points[0]).unwrap();
        let mut more = file.clone();
        more[at..at + 18].copy_from_slice(points[1]);
        assert!(refused(&more).starts_with("piece 1: the array"), "{form:?}: {}", refused(&more));
    }
}

#[test]
fn components_have_names_and_pieces_must_agree() {
    let text = "<VTKFile type='UnstructuredGrid'><UnstructuredGrid>\
        <Piece NumberOfPoints='1' NumberOfCells='3'><Points><DataArray type='Int64' NumberOfComponents='3'>1 2 3\
        </DataArray></Points><PointData><DataArray type='Float32' Name='v' NumberOfComponents='3'>4 5 6</DataArray>\
        <DataArray type='Int32' Name='id'>7</DataArray><DataArray type='Int32' Name='alone'>8</DataArray>\
        <DataArray type='UInt8' Name='RGBA' NumberOfComponents='4'>0 255 0 51</DataArray>\
        <Array type='String' Name='label'>9</Array></PointData></Piece>\
        <Piece NumberOfPoints='1'><PointData><DataArray type='UInt8' Name='RGBA' NumberOfComponents='4'>0 0 0 255\
        </DataArray><DataArray type='Int32' Name='id'>-7</DataArray>\
        <DataArray type='Float32' Name='v' NumberOfComponents='3'>-4 -5 -6</DataArray></PointData>\
        <Points><DataArray type='Float32' NumberOfComponents='3'>3 2 1</DataArray></Points></Piece>\
        </UnstructuredGrid></VTKFile>";
    let loaded = read(text.as_bytes(), &Options::default().with_radius(0.5)).unwrap();
    let names: Vec<_> = loaded.columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["v.x", "v.y", "v.z", "id"]);
    assert_eq!(loaded.column("v.z"), Some(&ColumnValues::Numbers(vec![6.0, -6.0])));
    assert_eq!(loaded.colors.unwrap()[0], LinearRgb::from_srgb8([0, 255, 0]));
    assert_eq!(loaded.opacities, Some(vec![0.2, 1.0]));
    assert_eq!(
        loaded.notes,
        [
            "not used: the array label, which is text",
            "not used: 3 cells; the 2 points become spheres",
            "not used: the array alone, which piece 1 lacks"
        ]
    );
}

/// However often a file names the same bytes, they are read once, so that a small file does not take much memory.
#[test]
fn arrays_do_not_share_bytes() {
    let file = |more: &str| {
        let array =
            "<DataArray type='Float32' NumberOfComponents='3' format='appended' offset='0'/>";
        let xml = format!(
            "<VTKFile type='PolyData'><PolyData><Piece NumberOfPoints='1'><Points>{array}</Points><PointData>{more}\
             </PointData></Piece></PolyData><AppendedData encoding='raw'>_"
        );
        [xml.as_bytes(), &12_u32.to_le_bytes(), &[0; 12], b"</AppendedData></VTKFile>"].concat()
    };
    assert_eq!(read(&file(""), &Options::default()).unwrap().spheres.len(), 1);
    let again = (0..9).map(|i| {
        format!("<DataArray type='Float32' Name='{i}' NumberOfComponents='3' format='appended' offset='0'/>")
    });
    let error = refused(&file(&again.collect::<String>()));
    assert_eq!(error, "piece 0: the array 1: its data overlap with those of another array");
}
