//! The edges of the periodic cell.

use glam::DVec3;

use super::spheres::{Added, Base, Look};
use super::{AddError, string};
use crate::image::color::LinearRgb;

/// How the twelve edges of the periodic cell are drawn.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CellEdges {
    /// The width of the edges; if it is not given, 1/300 of the longest diagonal of the cell.
    pub width: Option<f64>,
}

/// The part of the diagonal that the width is.
const WIDTH: f64 = 1.0 / 300.0;

/// The least such part, so that there are at most some hundred thousand spheres.
const LEAST_WIDTH: f64 = 1.0 / 20_000.0;

/// The distance of centres on an edge, in radii. Edges are a few pixels wide, where no one sees the spheres.
const SPACING: f64 = 0.6;

/// The colour of edges in 8-bit sRGB: a dark grey, near that of outlines, which are as wide as an edge.
const COLOR: [u8; 3] = [0x33, 0x38, 0x3f];

impl CellEdges {
    /// Edges of this width.
    #[must_use]
    pub fn of_width(width: f64) -> Self {
        Self { width: Some(width) }
    }

    /// Adds the edges.
    pub(super) fn add(&self, base: &Base<'_>, added: &mut Added) -> Result<(), AddError> {
        let edges = base.cell.ok_or(AddError::NoCell)?;
        let origin = DVec3::from(base.cell_origin);
        let [a, b, c] = edges.map(DVec3::from);
        let diagonals = [a + b + c, a + b - c, a - b + c, b + c - a];
        let diagonal = diagonals.into_iter().map(DVec3::length).fold(0.0, f64::max);
        if !(diagonal.is_finite() && diagonal > 0.0 && origin.is_finite()) {
            return Err(AddError::Cell { edges });
        }
        let width = self.width.unwrap_or(WIDTH * diagonal);
        if !(LEAST_WIDTH * diagonal..=diagonal).contains(&width) {
            return Err(AddError::Width { width, diagonal });
        }
        let radius = 0.5 * width;
        let look = Look::Own(LinearRgb::from_srgb8(COLOR));
        // Four edges are parallel to each of the three.
        for (edge, [one, other]) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
            let length = edge.length();
            if length <= 0.0 {
                continue;
            }
            // Every edge begins and ends half a distance before its corners, so spheres at corners join them.
            let count = string::count(length, radius, SPACING) as usize;
            for start in [DVec3::ZERO, one, other, one + other] {
                let start = origin + start;
                added.push(string::between(start, start + edge, radius, count), look);
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
