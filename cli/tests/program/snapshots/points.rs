//! Files of points with something wrong in them.

use super::cases::{Case, folder};
use super::contents::contents;

/// A file of LAS 1.2 with points of 26 bytes, which `change` damages.
pub(super) fn las(points: u32, change: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
    let mut bytes = vec![0; 227 + 26 * points as usize];
    let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
    put(0, b"LASF");
    put(24, &[1, 2]);
    put(94, &227_u16.to_le_bytes());
    put(96, &227_u32.to_le_bytes());
    put(104, &[2]);
    put(105, &26_u16.to_le_bytes());
    put(107, &points.to_le_bytes());
    (0..3).for_each(|axis| put(131 + 8 * axis, &0.01_f64.to_le_bytes()));
    change(&mut bytes);
    bytes
}

/// PLY, VTK and LAS.
pub(super) fn points() -> Vec<Case> {
    let mut cases = contents("bad.ply", "", &BAD_PLY);
    cases.extend(contents("bad.vtp", "", &BAD_VTP));
    cases.extend(contents("bad.vtu", "", &BAD_VTU));
    let names = folder().files().into_iter().filter(|name| name.ends_with(".las"));
    cases.extend(names.map(|name| Case {
        input: None,
        arguments: format!("render {name} -o out.png --backend cpu"),
    }));
    cases
}

const BAD_PLY: [&str; 14] = [
    "",
    "plx\n",
    "ply\nformat ascii 1.0\nelement vertex 1\n",
    "ply\nelement vertex 1\nproperty float x\nend_header\n0\n",
    "ply\nformat text 1.0\nend_header\n",
    "ply\nformat ascii 2.0\nend_header\n",
    "ply\nformat ascii 1.0\nelement vertex many\nend_header\n",
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n0\n",
    "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n3 0 1 2\n",
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n",
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n1 1 1\n",
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 north 0\n",
    "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n\
     AAAABBBBCCCCDD\n",
];

const BAD_VTP: [&str; 9] = [
    "",
    "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n",
    "<html></html>\n",
    "<VTKFile type=\"ImageData\"></VTKFile>\n",
    "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\">\n",
    "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"one\"></Piece></PolyData></VTKFile>\n",
    "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\"></Piece></PolyData></VTKFile>\n",
    "<VTKFile type=\"PolyData\"><PolyData><Piece></PolyData></VTKFile>\n",
    "<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"><PolyData></PolyData></VTKFile>\n",
];

const BAD_VTU: [&str; 5] = [
    "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"2\"><Points>\n\
     <DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray>\n\
     </Points></Piece></UnstructuredGrid></VTKFile>\n",
    "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"1\"><Points>\n\
     <DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 east 0</DataArray>\n\
     </Points></Piece></UnstructuredGrid></VTKFile>\n",
    "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"1\"><Points>\n\
     <DataArray type=\"Float32\" NumberOfComponents=\"2\" format=\"ascii\">0 0</DataArray>\n\
     </Points></Piece></UnstructuredGrid></VTKFile>\n",
    "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"1\"><Points>\n\
     <DataArray type=\"Complex\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0</DataArray>\n\
     </Points></Piece></UnstructuredGrid></VTKFile>\n",
    "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"1\"><Points>\n\
     <DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">DAAAAAAA</DataArray>\n\
     </Points></Piece></UnstructuredGrid></VTKFile>\n",
];
