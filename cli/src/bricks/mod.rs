//! Files of bricks: spheres that `sort` has divided among compact bricks, so that a picture needs one of them in memory at
//! a time.
//!
//! `stream` reads the spheres in input order, as often as needed; `cuts` divides space by a sample of them; `outer` finds
//! the spheres that decide what a camera frames; `sort` writes the file, `file` says what it holds, `read` reads it, and
//! `picture` renders one brick after the other.

mod cuts;
mod file;
mod info;
mod outer;
mod picture;
mod read;
mod sort;
mod stream;
mod writer;

pub(super) use info::lines as info_lines;
pub(super) use picture::{check_without_light, nearest_of, render};
pub(super) use read::BrickFile;
pub(super) use sort::{SortArgs, run};

/// The extension of files of bricks.
pub(super) const EXTENSION: &str = "bricks";
