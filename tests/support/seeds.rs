//! Small good files of every format that can be read, from which the fuzzer makes bad ones.
//!
//! A new format gets files in `tests/files/good`, with a row each in [`TEXTS`], or a function in [`of`]; a test fails until
//! it has.

use std::io::Write as _;
use std::path::Path;

use data_encoding::BASE64;
use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use pinhole::load::{Format, Options};

use crate::arrays as files;
use crate::binary_files::{dcd as charmm, gromacs, gsd as hoomd, topology};

/// A good file.
pub(crate) struct Seed {
    pub(crate) bytes: Vec<u8>,
    /// What reading it needs beside the format.
    pub(crate) options: Options,
}

impl Seed {
    fn new(bytes: impl Into<Vec<u8>>) -> Self {
        Self::with_options(bytes, Options::default())
    }

    fn with_options(bytes: impl Into<Vec<u8>>, options: Options) -> Self {
        Self { bytes: bytes.into(), options }
    }
}

/// A format, a good file that is text, and the names of its columns where they must be given.
type Text = (&'static str, &'static str, &'static str);

const TEXTS: &[Text] = &[
    ("xyz", include_str!("../files/good/water.xyz"), ""),
    ("extxyz", include_str!("../files/good/columns.extxyz"), ""),
    ("extxyz", include_str!("../files/good/numbers.extxyz"), ""),
    ("pdb", include_str!("../files/good/models.pdb"), ""),
    ("pdb", include_str!("../files/good/one.pdb"), ""),
    ("lammps-dump", include_str!("../files/good/plain.dump"), ""),
    ("lammps-dump", include_str!("../files/good/tilted.dump"), ""),
    ("lammps-dump", include_str!("../files/good/general.dump"), "id,type,xsu,ysu,zsu"),
    ("lammps-data", include_str!("../files/good/full.data"), ""),
    ("lammps-data", include_str!("../files/good/sphere.data"), ""),
    ("lammps-data", include_str!("../files/good/bare.data"), "id,type,q,x,y,z"),
    ("mmcif", include_str!("../files/good/models.cif"), ""),
    ("mmcif", include_str!("../files/good/small.cif"), ""),
    ("csv", include_str!("../files/good/table.csv"), ""),
    ("csv", include_str!("../files/good/semicolons.csv"), ""),
    ("csv", include_str!("../files/good/bare.csv"), "x,y,z"),
    ("ply", include_str!("../files/good/text.ply"), ""),
];

/// The good files of a format; none if it is unknown here. What they need, such as a topology, is written into the folder.
pub(crate) fn of(format: &Format, folder: &Path) -> Vec<Seed> {
    let mut seeds = match format.name {
        "xyz" => compressed(include_str!("../files/good/water.xyz")),
        "las" => las(),
        "gsd" => gsd(),
        "dcd" => dcd(folder),
        "trr" => trr(folder),
        "xtc" => xtc(folder),
        "npy" => npy(),
        "npz" => npz(),
        "ply" => ply(),
        "raw-f32x4" => vec![Seed::new(little_endian())],
        "vtk" => vtk(),
        _ => Vec::new(),
    };
    for (_, text, columns) in TEXTS.iter().filter(|(name, ..)| *name == format.name) {
        let mut options = Options::default();
        options.columns = columns.split_terminator(',').map(str::to_owned).collect();
        seeds.push(Seed::with_options(*text, options.clone()));
        if ["xyz", "mmcif"].contains(&format.name) {
            seeds.push(Seed::with_options(text.replace('\n', "\r\n"), options));
        }
    }
    seeds
}

fn compressed(text: &str) -> Vec<Seed> {
    let mut gz = GzEncoder::new(Vec::new(), Compression::fast());
    gz.write_all(text.as_bytes()).unwrap();
    vec![Seed::new(gz.finish().unwrap())]
}

fn las() -> Vec<Seed> {
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

fn ply() -> Vec<Seed> {
    let text = include_str!("../files/good/text.ply");
    let (header, _) = text.split_once("element face").unwrap();
    let faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
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
    vec![Seed::new(little), Seed::new(big)]
}

fn vtk() -> Vec<Seed> {
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

/// Two spheres: x, y, z, radius.
const NUMBERS: [f32; 8] = [-2.0, 0.0, 0.5, 1.0, 2.0, -1.0, 0.0, 0.5];

fn npy() -> Vec<Seed> {
    let big: Vec<u8> = NUMBERS.iter().flat_map(|x| f64::from(*x).to_be_bytes()).collect();
    vec![
        Seed::new(files::npy("<f4", false, "(2, 4)", &little_endian())),
        Seed::with_options(
            files::npy(">f8", true, "(2, 3)", &big[..48]),
            Options::default().with_radius(1.0),
        ),
        Seed::new(structured()),
    ]
}

/// Two structures with positions, colours, opacities, text and what is not used.
pub(crate) fn structured() -> Vec<u8> {
    let header = "{'descr': [('pos', '<f4', (3,)), ('', '|V2'), ('diameter', '>f8'), ('rgba', '|u1', (4,)), \
                  ('kind', '<U2'), ('phase', '<c8'), ('alive', '|b1')], 'fortran_order': False, 'shape': (2,)}";
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    for (x, kind) in [(1.0_f32, "Ab"), (2.0, "z")] {
        file.extend([x, 10.0 * x, 0.0].map(f32::to_le_bytes).as_flattened());
        file.extend([9, 9]);
        file.extend(f64::from(x).to_be_bytes());
        file.extend([255, 0, 51, 51 * x as u8]);
        let codes: Vec<u32> = kind.chars().map(u32::from).chain([0; 2]).take(2).collect();
        file.extend(codes.into_iter().flat_map(u32::to_le_bytes));
        file.extend([0; 8]);
        file.push(u8::from(x > 1.5));
    }
    file
}

fn npz() -> Vec<Seed> {
    let [spheres, positions] = [0, 1].map(|index| npy().swap_remove(index));
    let (spheres, radius) = (spheres.bytes, positions.options);
    vec![
        Seed::new(files::zip(&[("other.npy", &spheres), ("spheres.npy", &spheres)], false)),
        Seed::new(files::zip(&[("arr_0.npy", &spheres)], true)),
        Seed::with_options(files::zip(&[("a.npy", &positions.bytes)], true), radius),
        Seed::new(files::zip(&[("a.npy", &structured())], false)),
    ]
}

fn little_endian() -> Vec<u8> {
    NUMBERS.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn gsd() -> Vec<Seed> {
    [1, 2].map(|version| Seed::new(hoomd::file(version, &hoomd::chunks()))).into()
}

fn dcd(folder: &Path) -> Vec<Seed> {
    let other = charmm::Layout {
        order: charmm::Order::Big,
        marker_bytes: 8,
        cell: Some([10.0, 0.5, 20.0, 0.0, 0.0, 30.0]),
        has_fourth: true,
        has_fixed: true,
    };
    let seed = |layout| with_topology(charmm::file(layout), folder, charmm::ATOMS);
    [charmm::PLAIN, other].map(seed).into()
}

fn trr(folder: &Path) -> Vec<Seed> {
    [false, true]
        .map(|is_double| with_topology(gromacs::trr(is_double), folder, gromacs::ATOMS))
        .into()
}

fn xtc(folder: &Path) -> Vec<Seed> {
    let (old, new) = (molly::Magic::Xtc1995, molly::Magic::Xtc2023);
    // Of fewer than ten atoms the positions are not compressed.
    [(5, old), (12, old), (60, new)]
        .map(|(atoms, magic)| with_topology(gromacs::xtc(2, atoms, magic), folder, atoms))
        .into()
}

fn with_topology(bytes: Vec<u8>, folder: &Path, atoms: usize) -> Seed {
    Seed::with_options(bytes, Options::default().with_topology(topology(folder, atoms)))
}
