//! Spheres that are added to those of data: the edges of the periodic cell, and bonds between atoms.
//!
//! An edge or a bond is a string of spheres: a row that overlaps so far that it looks like a stick. Added spheres come
//! after the spheres of the data, whose indices stay as they are, and do not affect properties of the data, such as the
//! range of colours. [`Additions`] holds the choices.

mod bonds;
mod spheres;

pub use bonds::{BondLength, Bonds};
pub use spheres::{AddError, AddedSpheres};

use glam::DVec3;

use crate::load::{ColumnValues, Dataset};
use pinhole::image::color::LinearRgb;
use spheres::{Look, string_between, string_count};

/// The shapes to add to the spheres of data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Additions {
    /// The edges of the periodic cell.
    pub cell: Option<CellEdges>,
    /// Bonds between atoms.
    pub bonds: Option<Bonds>,
    /// Whether spheres keep their radii when bonds are drawn, because the user chose the radii. Otherwise atoms of
    /// elements shrink by the factor 0.25, and other spheres by 0.5, so that the sticks between them can be seen.
    pub keeps_radii: bool,
}

impl Additions {
    /// Returns true if nothing is added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cell.is_none() && self.bonds.is_none()
    }

    /// Makes spheres of data smaller, if bonds need it and the user did not choose the radii.
    pub fn shrink(&self, loaded: &mut Dataset) {
        if self.bonds.is_none() || self.keeps_radii {
            return;
        }
        let labels = loaded.columns.iter().find_map(|column| match &column.values {
            ColumnValues::Labels(labels) if column.name == "species" => Some(labels),
            _ => None,
        });
        let factor_of = |name: &String| bonds::radius_factor(Some(name));
        let factors: Vec<f64> = labels.map(|labels| labels.names.iter().map(factor_of).collect()).unwrap_or_default();
        let indices = labels.map_or(&[][..], |labels| &labels.indices);
        let other = bonds::radius_factor(None);
        let factor = |row: usize| {
            let species = indices.get(row).and_then(|index| factors.get(*index as usize));
            species.copied().unwrap_or(other)
        };
        loaded.spheres.map_radii(|row, radius| radius * factor(row));
    }

    /// Returns the spheres to add to these spheres of data.
    ///
    /// # Errors
    /// Returns an error if there is no cell to draw, if no bonds can be found, or if a length is out of range.
    pub fn add(&self, data: &Dataset) -> Result<AddedSpheres, AddError> {
        let mut added = AddedSpheres::default();
        if let Some(bonds) = &self.bonds {
            bonds.add(data, &mut added)?;
        }
        if let Some(edges) = &self.cell {
            edges.add(data, &mut added)?;
        }
        Ok(added)
    }
}

/// The twelve edges of the periodic cell, drawn as sticks.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CellEdges {
    /// The width of the edges; if it is not given, 1/300 of the longest diagonal of the cell.
    pub width: Option<f64>,
}

/// The default width of edges, as a share of the longest diagonal.
const WIDTH: f64 = 1.0 / 300.0;

/// The least width of edges, as a share of the diagonal: it keeps the number of spheres below some hundred thousand.
const LEAST_WIDTH: f64 = 1.0 / 20_000.0;

/// The distance of centres on an edge, in radii. Edges are a few pixels wide, so single spheres cannot be seen.
const SPACING: f64 = 0.6;

/// The colour of edges in 8-bit sRGB: a dark grey, near that of outlines, which are as wide as an edge.
const COLOR: [u8; 3] = [0x33, 0x38, 0x3f];

impl CellEdges {
    /// Edges of this width.
    #[must_use]
    pub fn of_width(width: f64) -> Self {
        Self { width: Some(width) }
    }

    fn add(&self, data: &Dataset, added: &mut AddedSpheres) -> Result<(), AddError> {
        let edges = data.cell.ok_or_else(|| {
            AddError(
                "the data has no periodic cell, so there is no box to draw; leave out `--box`, or the key `box`"
                    .to_owned(),
            )
        })?;
        let origin = DVec3::from(data.cell_origin);
        let [a, b, c] = edges.map(DVec3::from);
        let diagonals = [a + b + c, a + b - c, a - b + c, b + c - a];
        let diagonal = diagonals.into_iter().map(DVec3::length).fold(0.0, f64::max);
        if !(diagonal.is_finite() && diagonal > 0.0 && origin.is_finite()) {
            return Err(AddError(format!(
                "the periodic cell has the edges {edges:?} and cannot be drawn as a box; leave out `--box`, or the key \
                 `box`"
            )));
        }
        let width = self.width.unwrap_or(WIDTH * diagonal);
        if !(LEAST_WIDTH * diagonal..=diagonal).contains(&width) {
            return Err(AddError(format!(
                "`box`: the width of the edges is {width}; it must lie between 1/20000 of the diagonal of the cell, which \
                 is {diagonal:.4}, and the diagonal"
            )));
        }
        let radius = 0.5 * width;
        let look = Look::Own(LinearRgb::from_srgb8(COLOR));
        // Four edges are parallel to each of the three.
        for (edge, [one, other]) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
            let length = edge.length();
            if length <= 0.0 {
                continue;
            }
            // The spheres of an edge end half a distance before its corners. Spheres at the corners join the edges.
            let count = string_count(length, radius, SPACING) as usize;
            for start in [DVec3::ZERO, one, other, one + other] {
                let start = origin + start;
                added.push(string_between(start, start + edge, radius, count), look);
            }
        }
        let ends = [0.0, 1.0];
        let corners = ends.into_iter().flat_map(|u| {
            ends.into_iter().flat_map(move |v| {
                ends.into_iter().map(move |w| {
                    let corner = origin + u * a + v * b + w * c;
                    [corner.x, corner.y, corner.z, radius]
                })
            })
        });
        added.push(corners, look);
        Ok(())
    }
}
