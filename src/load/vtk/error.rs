//! Errors of reading VTK files.

/// An error of reading a VTK XML file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum VtkError {
    /// The file has no element `VTKFile`.
    #[error("this is not a VTK XML file: it has no element VTKFile")]
    NoVtk,
    /// The file is of the older kind, which is not XML.
    #[error(
        "this is a legacy VTK file, which is not read; save it as .vtp or .vtu, such as with PyVista: \
         pyvista.read('a.vtk').save('a.vtp')"
    )]
    Legacy,
    /// The file holds something else than points.
    #[error(
        "the file is of the type {found}, but only PolyData (.vtp) and UnstructuredGrid (.vtu) can be read{}",
        advice(found)
    )]
    Type {
        /// The type that the file names.
        found: String,
    },
    /// The XML cannot be read.
    #[error("byte {byte}: {message}")]
    Xml {
        /// Where it is in the file.
        byte: u64,
        /// What is wrong.
        message: String,
    },
    /// The file ends before its XML does.
    #[error("the file ends within the element {element}; it is cut off")]
    CutOff {
        /// Name of the innermost element.
        element: String,
    },
    /// The data are compressed with another library than zlib.
    #[error(
        "the data are compressed with {found}, but only vtkZLibDataCompressor can be read; save the file with zlib or \
         without compression"
    )]
    Compressor {
        /// The compressor that the file names.
        found: String,
    },
    /// An array of numbers cannot be read.
    #[error("piece {piece}: the array {name}: {message}")]
    Array {
        /// Index of the piece, from 0.
        piece: usize,
        /// Name of the array.
        name: String,
        /// What is wrong.
        message: String,
    },
    /// A piece has no positions.
    #[error(
        "piece {piece}: it declares NumberOfPoints={points}, but has no array in an element Points, which holds their \
         positions"
    )]
    NoPoints {
        /// Index of the piece, from 0.
        piece: usize,
        /// Number of points by the file.
        points: u64,
    },
}

/// What to do about a file of another type.
fn advice(found: &str) -> &'static str {
    if found.starts_with('P') || found.contains("MultiBlock") || found == "Collection" {
        "; name one of the files that it lists"
    } else {
        ""
    }
}
