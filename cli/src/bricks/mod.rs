//! Files of bricks: spheres that `sort` has divided among compact bricks, so that a picture needs one of them in memory at
//! a time.
//!
//! `writer` reads the spheres in input order, as often as needed, and writes bricks; `sort` divides space by a sample of them; `outer` finds
//! the spheres that decide what a camera frames; `file` says what it holds, `read` reads it, and
//! `picture` renders one brick after the other.

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
