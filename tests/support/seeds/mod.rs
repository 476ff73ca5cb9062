//! Small good files of every format that can be read, from which the fuzzer makes bad ones.
//!
//! A new format gets one function here and one row in [`SEEDS`]; a test fails until it has.

mod arrays;

use std::io::Write as _;
use std::path::Path;

use data_encoding::BASE64;
use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use pinhole::load::{Format, Options};

use crate::binary_files::{dcd as charmm, gromacs, gsd as hoomd, topology};

/// A good file.
pub(crate) struct Seed {
    pub(crate) bytes: Vec<u8>,
    /// What reading it needs beside the format.
    pub(crate) options: Options,
}

impl Seed {
    pub(crate) fn new(bytes: impl Into<Vec<u8>>) -> Self {
        Self { bytes: bytes.into(), options: Options::default() }
    }

    pub(crate) fn with_options(bytes: impl Into<Vec<u8>>, options: Options) -> Self {
        Self { bytes: bytes.into(), options }
    }
}

/// Makes the good files of a format. It may write files that they need, such as a topology, into the folder.
type Maker = fn(&Path) -> Vec<Seed>;

/// The good files of each format, by its name.
const SEEDS: &[(&str, Maker)] = &[
    ("xyz", |_| xyz()),
    ("extxyz", |_| extxyz()),
    ("pdb", |_| pdb()),
    ("lammps-dump", |_| lammps_dump()),
    ("lammps-data", |_| lammps_data()),
    ("mmcif", |_| mmcif()),
    ("las", |_| las()),
    ("gsd", |_| gsd()),
    ("dcd", dcd),
    ("trr", trr),
    ("xtc", xtc),
    ("npy", |_| arrays::npy()),
    ("npz", |_| arrays::npz()),
    ("csv", |_| csv()),
    ("ply", |_| ply()),
    ("raw-f32x4", |_| arrays::raw()),
    ("vtk", |_| vtk()),
];

/// The good files of a format; none if it has no row in [`SEEDS`].
pub(crate) fn of(format: &Format, folder: &Path) -> Vec<Seed> {
    let maker = SEEDS.iter().find(|(name, _)| *name == format.name);
    maker.map(|(_, maker)| maker(folder)).unwrap_or_default()
}

fn xyz() -> Vec<Seed> {
    let two =
        "3\nwater\nO 0 0 0.1\nH 0.76 0 -0.5\nH -0.76 0 -0.5\n2\n\nFe 1e1 2.5D0 -3\nXx 0 0 0\n";
    let mut gz = GzEncoder::new(Vec::new(), Compression::fast());
    gz.write_all(two.as_bytes()).unwrap();
    vec![Seed::new(two), Seed::new(two.replace('\n', "\r\n")), Seed::new(gz.finish().unwrap())]
}

fn extxyz() -> Vec<Seed> {
    let head = "2\nLattice=\"4 0 0 0 4 0 0 0 4\" Properties=species:S:1:pos:R:3:radius:R:1:color:R:3:forces:R:3:id:I:1 \
                energy=-1.5\n";
    let atoms = "O 0 0 0.1 0.5 1 0 0.5 1 2 3 7\nH 0.76 0 -0.5 0.3 0 0 1 -1 -2 -3 8\n";
    let numbers = "1\nProperties=Z:I:1:pos:R:3:label:S:1:fixed:L:1\n6 1 2 3 CA T\n";
    vec![Seed::new([head, atoms, head, atoms].concat()), Seed::new(numbers)]
}

fn pdb() -> Vec<Seed> {
    let atoms = "ATOM      1  N   VAL A   1       6.204  16.869   4.854  1.00 49.05           N\n\
                 ATOM      2  CA AVAL A   1       6.913  17.759   4.607  0.50 43.14           C\n\
                 ATOM      3  CA BVAL A   1       6.913  17.859   4.607  0.50 43.14           C\n\
                 HETATM 4430 FE   HEM A 142       8.128   7.371 -15.022  1.00 16.74          FE\n";
    let cell = "HEADER    OXYGEN TRANSPORT\n\
                CRYST1   63.150   83.590   53.800  90.00  99.34  90.00 P 1 21 1      4\n";
    let models =
        format!("{cell}MODEL        1\n{atoms}ENDMDL\nMODEL        2\n{atoms}TER\nENDMDL\nEND\n");
    vec![Seed::new(models), Seed::new([cell, atoms].concat())]
}

fn mmcif() -> Vec<Seed> {
    let cell = "_cell.length_a 10.0\n_cell.length_b 20\n_cell.length_c 30.00(2)\n_cell.angle_alpha 80\n\
                _cell.angle_beta 100\n_cell.angle_gamma '110'\n";
    let names = [
        "group_PDB",
        "type_symbol",
        "auth_atom_id",
        "label_alt_id",
        "auth_comp_id",
        "auth_asym_id",
        "auth_seq_id",
        "pdbx_PDB_ins_code",
        "Cartn_x",
        "Cartn_y",
        "Cartn_z",
        "occupancy",
        "pdbx_PDB_model_num",
    ];
    let header: String = names.map(|name| format!("_atom_site.{name}\n")).concat();
    let model = |number: u32| {
        format!(
            "ATOM C CA A ALA A 7 ? 1.5 -2.25 103.125 0.40 {number}\n\
             ATOM C CA B ALA A 7 ? 2.5 -2.25 103.125 0.60 {number} # a comment\n\
             HETATM ? \"O5'\" . DA\n;B\n; 42 . 0 0 .5 1 {number}\n"
        )
    };
    let models = format!("data_4HHB\n{cell}loop_\n{header}{}{}#\n", model(1), model(2));
    let small = "data_x\n_cell_length_a 10\n_cell_length_b 20\n_cell_length_c 30\n_cell_angle_alpha 90\n\
                 _cell_angle_beta 90\n_cell_angle_gamma 90\nloop_\n_atom_site_label\n_atom_site_fract_x\n\
                 _atom_site_fract_y\n_atom_site_fract_z\nFe1 0.5000(3) -0.25 1\nC12A 0 0 0\nloop_\n_other\nFe1\n";
    vec![Seed::new(models.replace('\n', "\r\n")), Seed::new(models), Seed::new(small)]
}

fn csv() -> Vec<Seed> {
    let table = "# made by hand\nname,x,y,z,radius,element,q,note\n\"a, b\",1,-2.5,3,0.5,O,,\"two\nlines\"\n\
                 c,4,5,6e-3,2,H,NA,\n";
    let bare = "1 2 3\n4\t5 6\n";
    let named = Options::default().with_columns(["x", "y", "z"]);
    vec![
        Seed::new(table),
        Seed::new("# x; y; z; id\n1;2;3;7\n\n4;5;6;A2\n"),
        Seed::with_options(bare, named),
    ]
}

const LAMMPS_HEAD: &str = "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\n";

fn lammps_dump() -> Vec<Seed> {
    let frames = |bounds: &str, columns: &str, atoms: &str| {
        format!("{LAMMPS_HEAD}ITEM: BOX BOUNDS {bounds}\nITEM: ATOMS {columns}\n{atoms}").repeat(2)
    };
    let plain = frames(
        "pp pp pp\n-1 3\n0 10\n5 25",
        "z id type vx x y radius c_1[2] element ",
        "6 9 2 .1 1 2 0.5 -7 O \n7 3 1 1 4 5 1.5 1e3 H\n",
    );
    let tilted = frames(
        "xy xz yz pp pp ff\n-1 6 -1\n0 4 2\n-1 1 1",
        "id type xs ys zs",
        "1 O .5 .5 .5\n2 H 0 0 1\n",
    );
    let general =
        frames("abc origin pp pp pp\n1 2 3 10\n0 1 0 20\n0 0 2 30", "", "1 1 0 0 0\n2 1 1 1 1\n");
    let named = Options::default().with_columns(["id", "type", "xsu", "ysu", "zsu"]);
    vec![
        Seed::new(format!("ITEM: UNITS\nmetal\nITEM: TIME\n0.5\n{plain}")),
        Seed::new(tilted),
        Seed::with_options(general, named),
    ]
}

fn lammps_data() -> Vec<Seed> {
    let full = "made by hand\n\n3 atoms\n2 atom types\n0 4 xlo xhi\n0 5 ylo yhi # a comment\n-1 5 zlo zhi\n\
                1 0 0.5 xy xz yz\n\nAtom Type Labels\n\n1 OW\n2 HW\n\nMasses\n\n1 15.9994 # O\n2 1.008\n\n\
                Bond Coeffs\n\n1 2 3\n\nAtoms # full\n\n2 1 2 0.4 1 0 0 0 0 -1\n1 1 1 -0.8 0 0 0 0 0 0 # first\n\
                3 1 2 0.4 0 1 0 0 0 0\n\nVelocities\n\n3 7 8 9\n1 1 2 3\n2 4 5 6\n\nBonds\n\n1 1 1 2\n";
    let sphere = "\n1 atoms\n\nAtoms # sphere\n\n1 1 0.5 2.5 1 2 3\n";
    let bare = "\n1 atoms\n\nAtoms\n\n1 1 0.5 1 2 3\n";
    let named = Options::default().with_columns(["id", "type", "q", "x", "y", "z"]);
    vec![Seed::new(full), Seed::new(sphere), Seed::with_options(bare, named)]
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
