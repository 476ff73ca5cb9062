//! The tables from which light is computed and that depend on shapes and settings alone, so that they are kept for the
//! next picture of the same shapes.

use super::cells::Cells;
use super::levels::{Levels, Places};
use super::openness::Openness;
use super::pieces::Pieces;
use crate::render::Studio;
use crate::scene::SharedShapes;

#[derive(Debug)]
pub(super) struct Tables {
    wanted: Wanted,
    cells: Cells,
    pieces: Pieces,
    levels: Levels,
    openness: Option<Openness>,
}

/// The settings on which tables depend.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wanted {
    shadows: bool,
    /// How far spheres occlude; `None` without occlusion.
    radius: Option<f64>,
}

impl Tables {
    /// Takes the tables that an earlier picture left, or begins new ones.
    pub(super) fn take(shapes: &SharedShapes, studio: Option<&Studio>) -> Self {
        let wanted = Wanted {
            shadows: studio.is_some_and(|studio| studio.shadows),
            radius: studio.and_then(|studio| Some(studio.occlusion.as_ref()?.radius.unwrap_or(f64::INFINITY))),
        };
        if let Some(kept) = shapes.take::<Self>().filter(|kept| kept.wanted == wanted) {
            return kept;
        }
        let cells = Cells::new(shapes);
        let pieces = Pieces::new(cells.side, shapes);
        let needs_levels = wanted.shadows || wanted.radius.is_some() && cells.has_near;
        let levels = Levels::new(&cells, if needs_levels { balls(&pieces, shapes) } else { &[] });
        let places = Places { shapes, pieces: &pieces, balls: balls(&pieces, shapes), cells: &cells, levels: &levels };
        let openness = wanted.radius.map(|radius| Openness::new(&places, radius));
        Self { wanted, cells, pieces, levels, openness }
    }

    /// The places of the shapes from which the tables were made, and the openness of points.
    pub(super) fn parts<'a>(&'a mut self, shapes: &'a SharedShapes) -> (Places<'a>, Option<&'a mut Openness>) {
        let (pieces, cells, levels) = (&self.pieces, &self.cells, &self.levels);
        (Places { shapes, pieces, balls: balls(pieces, shapes), cells, levels }, self.openness.as_mut())
    }
}

/// The spheres, and a ball for every piece of a cone.
fn balls<'a>(pieces: &'a Pieces, shapes: &'a SharedShapes) -> &'a [[f32; 4]] {
    if shapes.cones.is_empty() { &shapes.spheres } else { &pieces.balls }
}
