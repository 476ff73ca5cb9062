//! Files of bricks. A brick is a compact group of spheres. `sort` divides the spheres of a file among bricks, so that
//! rendering a picture needs only one brick in memory at a time.
//!
//! `writer` reads the spheres in input order, as often as needed, and writes bricks. `sort` divides space by a sample
//! of the spheres. `outer` finds the spheres that determine what a camera frames. `file` describes the layout of the
//! file, `read` reads it, and `picture` renders one brick after the other.

pub(super) use self::picture::{check_without_light, nearest_of, render};
pub(super) use self::read::BrickFile;
pub(super) use crate::bricks::read::lines as info_lines;
pub(super) use crate::bricks::sort::{SortArgs, run};

mod file;
mod outer;
mod picture;
mod read;
mod sort;
mod writer;

pub(super) const EXTENSION: &str = "bricks";
