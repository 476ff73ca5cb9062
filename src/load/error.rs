//! Errors of loading spheres.

use std::io;
use std::path::PathBuf;

/// An error of loading spheres. Messages from a reader name the line, column or byte but not the file, which the
/// caller knows.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {error}", path.display())]
    File {
        /// The path of the file.
        path: PathBuf,
        /// The error of the operating system.
        error: io::Error,
    },
    /// The bytes of a file cannot be read; [`LoadError::File`] has its path as well.
    #[error("the file cannot be read: {0}")]
    Io(#[from] io::Error),
    /// Neither the name nor the content of the file shows its format.
    #[error(
        "neither the name nor the content of this file shows its format; choose one of {formats}"
    )]
    UnknownFormat {
        /// The names of all formats.
        formats: String,
    },
    /// The format has no frames.
    #[error("a file of the format {format} has no frames; read it as a whole")]
    NoFrames {
        /// Name of the format.
        format: &'static str,
    },
    /// The file has fewer frames.
    #[error(
        "there is no frame {wanted}; the file has {frames} {}, counted from 0",
        if *frames == 1 { "frame" } else { "frames" }
    )]
    NoSuchFrame {
        /// The frame that was asked for.
        wanted: usize,
        /// Number of frames in the file.
        frames: usize,
    },
    /// A line of values cannot be read.
    #[error(transparent)]
    Line(#[from] super::rows::LineError),
    /// An option does not apply to the format.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// A table of text cannot be read.
    #[error(transparent)]
    Csv(#[from] super::csv::CsvError),
    /// A file of LAMMPS cannot be read.
    #[error(transparent)]
    Lammps(#[from] super::lammps::LammpsError),
    /// An mmCIF file cannot be read.
    #[error(transparent)]
    MmCif(#[from] super::mmcif::MmCifError),
    /// A LAS file cannot be read.
    #[error(transparent)]
    Las(#[from] super::las::LasError),
    /// A binary trajectory cannot be read.
    #[error(transparent)]
    Binary(#[from] super::binary::BinaryError),
    /// A trajectory does not go with its topology.
    #[error(transparent)]
    Topology(#[from] super::topology::TopologyError),
    /// An `.npy` file cannot be read.
    #[error(transparent)]
    Npy(#[from] super::npy::SpheresError),
    /// An `.npz` archive cannot be read.
    #[error(transparent)]
    Npz(#[from] super::npz::NpzError),
    /// A PDB file cannot be read.
    #[error(transparent)]
    Pdb(#[from] super::pdb::PdbError),
    /// A PLY file cannot be read.
    #[error(transparent)]
    Ply(#[from] super::ply::PlyError),
    /// Raw numbers cannot be read.
    #[error(transparent)]
    Raw(#[from] super::raw::RawError),
    /// A table of points does not make spheres.
    #[error(transparent)]
    Table(#[from] super::table::TableError),
    /// A VTK XML file cannot be read.
    #[cfg(feature = "vtk")]
    #[error(transparent)]
    Vtk(#[from] super::vtk::VtkError),
    /// An XYZ file cannot be read.
    #[error(transparent)]
    Xyz(#[from] super::xyz::XyzError),
}

/// The error of an option that does not apply to the format of a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{option} applies only to {what}; remove it")]
pub struct OptionError {
    /// Name of the option, such as `frame`.
    pub option: &'static str,
    /// The kind of file that the option applies to, with its extensions.
    pub what: String,
}
