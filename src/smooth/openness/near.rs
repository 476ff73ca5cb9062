//! The spheres near visible points.

use glam::DVec3;

use crate::smooth::levels::Places;
use crate::smooth::spots::sphere;

/// The most spheres of a list. The smallest and farthest of more are left out.
const MOST: usize = 256;

/// Distances at which spheres are near, in sides of cells. Near spheres count up to 2; the rest is for rounding.
const REACH: f64 = 2.01;

/// The smallest radius of near spheres, in sides of cells.
const LEAST: f64 = 0.25;

/// The list of a cube, with centres counted from its middle, and whether it lacks spheres.
pub(super) fn list(places: &Places<'_>, cube: u32) -> (Vec<[f32; 4]>, bool) {
    let Places { spheres, cells, levels } = places;
    let middle = cells.middle(cube);
    let mut ids = Vec::new();
    levels.around(cells, middle, |id| {
        let (center, radius) = sphere(spheres, id);
        let beyond = ((center - middle).abs() - cells.side).max(DVec3::ZERO);
        let reach = radius + REACH * cells.side;
        if radius >= LEAST * cells.side && beyond.length_squared() <= reach * reach {
            ids.push(id);
        }
    });
    let is_cut = ids.len() > MOST;
    if is_cut {
        let size = |id: &u32| {
            let (center, radius) = sphere(spheres, *id);
            radius / (center - middle).length().max(radius)
        };
        ids.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
        ids.truncate(MOST);
    }
    ids.sort_unstable();
    let from_middle = |id: &u32| {
        let (center, radius) = sphere(spheres, *id);
        let [x, y, z] = (center - middle).as_vec3().to_array();
        [x, y, z, radius as f32]
    };
    (ids.iter().map(from_middle).collect(), is_cut)
}
