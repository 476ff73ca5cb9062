//! The spheres near visible points.

use glam::DVec3;

use crate::smooth::cells::Cells;
use crate::smooth::levels::Places;
use crate::smooth::spots::sphere;

/// The most spheres of a list. The smallest and farthest of more are left out.
const MOST: usize = 256;

/// Distances at which spheres are near, in sides of cells. Near spheres count up to 2; the rest is for rounding.
const REACH: f64 = 2.01;

/// The smallest radius of near spheres, in sides of cells.
const LEAST: f64 = 0.25;

/// The list of a cube, with centres counted from its middle, and whether it lacks spheres. Cones are strings of balls here,
/// which are inside them, so that they hide nothing from the cone itself.
pub(super) fn list(places: &Places<'_>, cube: u32) -> (Vec<[f32; 4]>, bool) {
    let Places { balls, cells, levels, .. } = places;
    let middle = cells.middle(cube);
    let mut near: Vec<(u32, DVec3, f64)> = Vec::new();
    levels.around(cells, middle, |id| {
        let (center, radius) = sphere(balls, id);
        if !is_near(cells, middle, center, radius) {
            return;
        }
        match places.piece(id) {
            None => near.push((id, center, radius)),
            Some((piece, cone)) => {
                let beads = piece.beads(cone).filter(|(center, radius)| is_near(cells, middle, *center, *radius));
                near.extend(beads.map(|(center, radius)| (id, center, radius)));
            }
        }
    });
    near.sort_by_key(|(id, ..)| *id);
    let is_cut = near.len() > MOST;
    if is_cut {
        let size = |(_, center, radius): &(u32, DVec3, f64)| radius / (center - middle).length().max(*radius);
        near.sort_by(|a, b| size(b).total_cmp(&size(a)));
        near.truncate(MOST);
        near.sort_by_key(|(id, ..)| *id);
    }
    let from_middle = |(_, center, radius): &(u32, DVec3, f64)| {
        let [x, y, z] = (center - middle).as_vec3().to_array();
        [x, y, z, *radius as f32]
    };
    (near.iter().map(from_middle).collect(), is_cut)
}

/// True if a ball counts near a cube.
fn is_near(cells: &Cells, middle: DVec3, center: DVec3, radius: f64) -> bool {
    let beyond = ((center - middle).abs() - cells.side).max(DVec3::ZERO);
    let reach = radius + REACH * cells.side;
    radius >= LEAST * cells.side && beyond.length_squared() <= reach * reach
}
