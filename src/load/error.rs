//! Why spheres cannot be loaded.

use std::io;
use std::path::PathBuf;

/// Why spheres cannot be loaded. The messages of readers name the line, column or byte, not the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {error}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// Neither the name nor the content tells the format.
    #[error("neither its name nor its content tells the format; the formats are {formats}")]
    UnknownFormat {
        /// The names of all formats.
        formats: String,
    },
    /// An option is of no use to the format.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// An array of spheres cannot be read.
    #[cfg(feature = "npy")]
    #[error(transparent)]
    Npy(#[from] super::npy::SpheresError),
    /// An archive of arrays cannot be read.
    #[cfg(feature = "npy")]
    #[error(transparent)]
    Npz(#[from] super::npz::NpzError),
    /// A PDB file cannot be read.
    #[cfg(feature = "pdb")]
    #[error(transparent)]
    Pdb(#[from] super::pdb::PdbError),
    /// Raw numbers cannot be read.
    #[error(transparent)]
    Raw(#[from] super::raw::RawError),
    /// An XYZ file cannot be read.
    #[cfg(feature = "xyz")]
    #[error(transparent)]
    Xyz(#[from] super::xyz::XyzError),
}

/// An option is of no use to the format of a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{option} concerns {what}; drop it")]
pub struct OptionError {
    /// The option, such as `frame`.
    pub option: &'static str,
    /// What has a use for it.
    pub what: String,
}
