//! What `info` says about a file of bricks.

use std::path::Path;

use anyhow::Result;
use serde::Serialize;

use super::BrickFile;
use super::file::StoredColors;
use crate::memory::readable;

/// What a file of bricks holds.
#[derive(Serialize)]
pub(crate) struct Report {
    version: &'static str,
    file: String,
    bytes: u64,
    kind: &'static str,
    source: String,
    spheres: u64,
    min: [f64; 3],
    max: [f64; 3],
    radius_min: f32,
    radius_max: f32,
    bricks: usize,
    largest_brick_spheres: u64,
    largest_brick_bytes: u64,
    outer_spheres: u64,
    colors: &'static str,
}

impl Report {
    fn new(path: &Path) -> Result<Self> {
        let file = BrickFile::open(path)?;
        let (header, whole) = (&file.header, file.whole());
        Ok(Self {
            version: env!("CARGO_PKG_VERSION"),
            file: path.display().to_string(),
            bytes: path.metadata().map_or(0, |metadata| metadata.len()),
            kind: "bricks",
            source: header.source.clone(),
            spheres: whole.count,
            min: whole.bounds.min().to_array(),
            max: whole.bounds.max().to_array(),
            radius_min: whole.radius_min,
            radius_max: whole.radius_max,
            bricks: file.len(),
            largest_brick_spheres: file.largest(),
            largest_brick_bytes: header.largest(),
            outer_spheres: header.outer.count,
            colors: match header.colors {
                StoredColors::None => "none",
                StoredColors::One(_) => "one",
                StoredColors::Palette(_) => "palette",
                StoredColors::Rgba8 => "rgba8",
            },
        })
    }
}

/// The text of the report, as JSON or for people.
pub(crate) fn lines(path: &Path, json: bool) -> Result<String> {
    let report = Report::new(path)?;
    if json {
        return Ok(serde_json::to_string_pretty(&report)? + "\n");
    }
    let corner = |corner: [f64; 3]| corner.map(|x| x.to_string()).join(" ");
    Ok(format!(
        "file: {}\nformat: bricks, sorted from {}\nsize: {} bytes\nspheres: {}\nbox: {} to {}\nradii: {} to {}\n\
         bricks: {}, the largest with {} spheres in {}\nspheres that a camera frames: {}\ncolors: {}\n",
        report.file,
        report.source,
        report.bytes,
        report.spheres,
        corner(report.min),
        corner(report.max),
        report.radius_min,
        report.radius_max,
        report.bricks,
        report.largest_brick_spheres,
        readable(report.largest_brick_bytes),
        report.outer_spheres,
        report.colors
    ))
}
