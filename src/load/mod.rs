//! Reads files of spheres: [`open`] takes a path, [`from_bytes`] takes bytes, and both return a [`Loaded`].
//!
//! [`FORMATS`] lists every format that this build can read; no other module names a format. The format of a file is
//! the one in [`Options::format`], or else follows from the file's extension, or else from its content.
//!
//! ```
//! # #[cfg(feature = "xyz")] {
//! use pinhole::load::{self, Options};
//!
//! let water = "3\nwater\nO 0 0 0.1\nH 0.76 0 -0.5\nH -0.76 0 -0.5\n";
//! let loaded = load::from_bytes(water.as_bytes(), "water.xyz", &Options::default())?;
//! assert_eq!(loaded.spheres.len(), 3);
//! assert_eq!(loaded.labels("species").unwrap().names, ["O", "H"]);
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(any(feature = "mmcif", feature = "pdb"))]
mod atoms;
#[cfg(feature = "binary")]
#[allow(dead_code, reason = "not every format has every kind of number")]
mod binary;
#[cfg(all(feature = "color-by", feature = "table"))]
mod covalent;
#[cfg(feature = "csv")]
pub mod csv;
#[cfg(feature = "dcd")]
mod dcd;
#[cfg(feature = "table")]
mod elements;
#[cfg(any(feature = "exr", feature = "hdr"))]
pub mod environment;
mod error;
mod format;
mod formats;
#[cfg(feature = "gromacs")]
mod gromacs;
#[cfg(feature = "gsd")]
mod gsd;
#[cfg(feature = "gzip")]
mod gzip;
#[cfg(feature = "table")]
#[allow(dead_code, reason = "not every format has texts")]
mod labels;
#[cfg(feature = "lammps")]
pub mod lammps;
#[cfg(feature = "las")]
mod las;
mod loaded;
#[cfg(feature = "mmcif")]
pub mod mmcif;
#[cfg(feature = "npy")]
pub mod npy;
#[cfg(feature = "npy")]
pub mod npz;
mod numbers;
mod open;
#[cfg(feature = "pdb")]
pub mod pdb;
#[cfg(any(feature = "png", feature = "exr"))]
pub mod picture;
#[cfg(feature = "ply")]
mod ply;
pub mod raw;
#[cfg(feature = "table")]
#[allow(dead_code, reason = "not every format has lines of values")]
mod rows;
#[cfg(any(feature = "ply", feature = "vtk"))]
mod scalar;
mod source;
#[cfg(feature = "table")]
mod spacing;
#[cfg(feature = "table")]
#[allow(dead_code, reason = "not every format has named columns")]
mod table;
#[cfg(feature = "binary")]
#[allow(dead_code, reason = "not every binary format needs one")]
mod topology;
mod trajectory;
#[cfg_attr(not(feature = "table"), allow(dead_code, reason = "atoms come with a feature"))]
mod unknown_species;
#[cfg(feature = "vtk")]
mod vtk;
#[cfg(feature = "xyz")]
pub mod xyz;

#[cfg(all(feature = "color-by", feature = "table"))]
pub(crate) use covalent::{Covalent, covalent};
pub use error::{LoadError, LoadErrorKind, Place};
pub use format::{Format, Options};
pub use formats::FORMATS;
pub use loaded::{Column, ColumnValues, Labels, Loaded};
pub use open::{from_bytes, open};
pub use trajectory::Trajectory;
