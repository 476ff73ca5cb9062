//! Shapes that are added to the spheres of data: the edges of the periodic cell, bonds between atoms, and arrows.
//!
//! Edges and bonds are cylinders, and arrows cylinders and cones. Spheres at the corners of the cell, which join its edges, come after the spheres of the
//! data. So the indices of these stay as they are, and added shapes do not affect properties of the data, such as the range
//! of colours. [`Additions`] holds the choices.

mod arrows;
mod atoms;
mod bonds;
mod neighbours;
mod shapes;

pub use arrows::Arrows;
pub use bonds::StickSize;
pub use bonds::{BondLength, Bonds};
pub(crate) use bonds::{bonded_pairs, radius_factor};
pub(crate) use neighbours::contacts;
pub use shapes::{AddError, AddedShapes, ArrowKey};

use glam::{DMat3, DVec3};

use crate::load::{Column, Dataset, covalent, labels_in};
use pinhole::scene::Appearance;
use shapes::{Look, between};

/// The shapes to add to the spheres of data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Additions {
    /// The edges of the periodic cell.
    pub cell: Option<CellEdges>,
    /// Bonds between atoms.
    pub bonds: Option<Bonds>,
    /// Arrows that show a vector of each sphere.
    pub arrows: Option<Arrows>,
    /// Whether spheres keep their radii when bonds or arrows are drawn, because the user chose the radii. Otherwise atoms
    /// of elements shrink by the factor 0.25, and other spheres by 0.5, so that the sticks between them can be seen.
    pub keeps_radii: bool,
}

impl Additions {
    /// Returns true if nothing is added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cell.is_none() && self.bonds.is_none() && self.arrows.is_none()
    }

    /// Makes the chosen spheres of data smaller, if bonds or arrows need it and the user did not choose the radii.
    pub fn shrink(&self, loaded: &mut Dataset, is_chosen: impl Fn(usize) -> bool) {
        if (self.bonds.is_none() && self.arrows.is_none()) || self.keeps_radii {
            return;
        }
        let is_element = element_test(&loaded.columns);
        loaded.spheres.map_radii(|index, radius| match is_chosen(index) {
            true => radius * radius_factor(is_element(index)),
            false => radius,
        });
    }

    /// Returns the shapes to add to spheres of data with this appearance. `drawn` says which of them are drawn, if not all.
    ///
    /// # Errors
    /// Returns an error if there is no cell to draw, if no bonds can be found, if there is no such vector, or if a length
    /// is out of range.
    pub fn add(
        &self,
        data: &Dataset,
        appearance: &Appearance,
        drawn: Option<&DrawnSpheres>,
    ) -> Result<AddedShapes, AddError> {
        let mut added = AddedShapes::default();
        let sticks = drawn.map(|drawn| &*drawn.sticks);
        let need_bonds = drawn.is_some_and(|drawn| drawn.need_bonds);
        if let Some(bonds) = &self.bonds {
            bonds.add(data, appearance, sticks, &mut added)?;
        } else if need_bonds {
            // Nobody asked for bonds in so many words.
            let found = Bonds::default().add(data, appearance, sticks, &mut added);
            added.notes.retain(|note| note != bonds::METALS);
            added.notes.extend(found.err().map(|error| format!("no sticks are drawn: {error}")));
        }
        if let Some(edges) = &self.cell {
            edges.add(data, &mut added)?;
        }
        if let Some(arrows) = &self.arrows {
            arrows.add(data, |index| drawn.is_none_or(|drawn| drawn.are_drawn[index]), &mut added)?;
        }
        Ok(added)
    }
}

/// The spheres that are drawn, and the sticks between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawnSpheres {
    /// The size of the stick at each sphere.
    pub sticks: Vec<StickSize>,
    /// True for each sphere that is drawn, with its arrow.
    pub are_drawn: Vec<bool>,
    /// True if there are sticks although nobody asked for bonds.
    pub need_bonds: bool,
}

/// Tells which spheres are atoms of a chemical element.
pub(crate) fn element_test(columns: &[Column]) -> impl Fn(usize) -> bool {
    let labels = labels_in(columns, "species");
    let are_elements: Vec<bool> =
        labels.map(|labels| labels.names.iter().map(|name| covalent(name).is_some()).collect()).unwrap_or_default();
    let indices = labels.map_or(&[][..], |labels| &labels.indices);
    move |row| indices.get(row).and_then(|index| are_elements.get(*index as usize)).copied().unwrap_or_default()
}

/// The twelve edges of the periodic cell, or of the box around all spheres without one, drawn as cylinders.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CellEdges {
    /// The width of the edges; if it is not given, 1/300 of the longest diagonal of the cell.
    pub width: Option<f64>,
}

/// The default width of edges, as a share of the longest diagonal.
const WIDTH: f64 = 1.0 / 300.0;

/// The least width of edges, as a share of the diagonal: cylinders must not be thinner for their length.
const LEAST_WIDTH: f64 = 1.0 / 4000.0;

/// The edges and the first corner of the box around all spheres, for data without a cell.
fn box_around(data: &Dataset) -> ([[f64; 3]; 3], DVec3) {
    let ends = |index: usize| (data.center(index), DVec3::splat(data.spheres.at(index)[3]));
    let finite = (0..data.spheres.len()).map(ends).filter(|(center, radius)| (center + radius).is_finite());
    let (low, high) = finite.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (center, radius)| {
        (low.min(center - radius), high.max(center + radius))
    });
    let sides = high - low;
    (DMat3::from_diagonal(sides).to_cols_array_2d(), low)
}

impl CellEdges {
    /// Edges of this width.
    #[must_use]
    pub fn of_width(width: f64) -> Self {
        Self { width: Some(width) }
    }

    fn add(&self, data: &Dataset, added: &mut AddedShapes) -> Result<(), AddError> {
        let (edges, origin) = match data.cell {
            Some(edges) => (edges, DVec3::from(data.cell_origin)),
            None => box_around(data),
        };
        let [a, b, c] = edges.map(DVec3::from);
        let diagonals = [a + b + c, a + b - c, a - b + c, b + c - a];
        let diagonal = diagonals.into_iter().map(DVec3::length).fold(0.0, f64::max);
        if !(diagonal.is_finite() && diagonal > 0.0 && origin.is_finite()) {
            return Err(AddError(format!(
                "the cell, or the box around all, has the edges {edges:?} and cannot be drawn as a box; leave out `--box`, or the key \
                 `box`"
            )));
        }
        let width = self.width.unwrap_or(WIDTH * diagonal);
        if !(LEAST_WIDTH * diagonal..=diagonal).contains(&width) {
            return Err(AddError(format!(
                "`box`: the width of the edges is {width}; it must lie between 1/4000 of the diagonal of the cell, which \
                 is {diagonal:.4}, and the diagonal"
            )));
        }
        let radius = 0.5 * width;
        // Four edges are parallel to each of the three. Shorter ones are hidden by the spheres at the corners.
        for (edge, [one, other]) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
            for start in [DVec3::ZERO, one, other, one + other].into_iter().filter(|_| edge.length() > radius) {
                let start = origin + start;
                let refused = |error| AddError(format!("an edge of the periodic cell cannot be drawn: {error}"));
                added.push(between([start, start + edge], radius), Look::of_edges()).map_err(refused)?;
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
        added.balls.extend(corners.map(|corner| (corner, Look::of_edges())));
        Ok(())
    }
}
