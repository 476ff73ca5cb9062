//! Reads molecules, particles and points for [`pinhole`]: files in, spheres and columns out.
//!
//! | I want to … | start here |
//! |---|---|
//! | read a file of atoms or points | [`load::open`] |
//! | choose some of its spheres by a condition | [`select::Selection`] |
//! | draw bonds, or the edges of the periodic cell | [`added::Additions`] |
//! | find a column by its name | [`column::column`] |
//! | write spheres as an array | [`write::npy`], [`write::raw`] |
//!
//! Nothing here needs a GPU, and nothing but [`load::open`] and the frames that it returns accesses the file system.

pub mod added;
mod cell;
pub mod column;
pub mod css;
mod keys;
pub mod kind;
pub mod load;
pub mod replicate;
pub mod select;
pub mod show;
pub mod write;
