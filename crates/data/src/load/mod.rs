//! Reads files of spheres: [`open`] takes a path, [`from_bytes`] takes bytes, and both return a [`Dataset`].
//!
//! [`FORMATS`] lists every format that this build can read; no other module names a format. The format of a file is
//! [`Options::format`], or else follows from the file's extension, or else from its content.
//!
//! ```
//! use pinhole_data::load::{self, Options};
//!
//! let water = "3\nwater\nO 0 0 0.1\nH 0.76 0 -0.5\nH -0.76 0 -0.5\n";
//! let loaded = load::from_bytes(water.as_bytes(), "water.xyz", &Options::default())?;
//! assert_eq!(loaded.spheres.len(), 3);
//! assert_eq!(loaded.labels("species").unwrap().names, ["O", "H"]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arrays;
mod atoms;
mod bonds;
mod compressed;
mod cone_kind;
mod cones;
mod dataset;
mod elements;
mod error;
mod file_rows;
mod file_set;
mod format;
mod formats;
mod labels;
mod numbers;
mod open;
mod refused;
mod rows;
mod source;
mod spacing;
mod table;
mod together;
mod topology;
mod trajectory;

pub(crate) use atoms::element::Residue;
pub use compressed::{is_compressed, without_ending};
pub use cone_kind::ConeKind;
pub use cones::ConeSet;
pub(crate) use dataset::labels_in;
pub use dataset::{Column, ColumnValues, Dataset, Labels};
pub(crate) use elements::{Covalent, Family, covalent, element_symbol, is_metal};
pub use error::{LoadError, LoadErrorKind, Place};
pub use file_rows::FileRows;
pub use file_set::FileSet;
pub use format::{Format, Options};
pub use formats::{FORMATS, csv, lammps, mmcif, npy, npz, pdb, raw, xyz};
pub use open::from_bytes;
pub use source::open_regular;
pub use trajectory::{Trajectory, open};
