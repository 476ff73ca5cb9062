//! Lists of the spheres near visible points.

use std::collections::BTreeSet;

use glam::DVec3;

use super::cells::{Cells, floor};
use crate::parallel;
use crate::smooth::spots::sphere;

/// The most spheres of a list. The smallest and farthest of more are left out.
const MOST: usize = 256;

/// Distances at which spheres are near, in sides of cells. Near spheres count up to 2; the rest is for rounding.
const REACH: f64 = 2.01;

/// The smallest radius of near spheres, in sides of cells.
const LEAST: f64 = 0.25;

/// The largest radius of the smallest level of spheres, in sides of cells. With their reach, they touch no more than two
/// cubes beside that of their centre.
const LARGEST: f64 = 1.9;

/// The spheres of a scene by size and place.
#[derive(Debug)]
pub(super) struct Levels(Vec<Level>);

/// Spheres of similar size in cubes. From level to level, sides and radii double.
#[derive(Debug)]
struct Level {
    /// Side of a cube.
    side: f64,
    counts: [usize; 3],
    /// The start of each cube in `ids`, and the end of the last.
    starts: Vec<u32>,
    ids: Vec<u32>,
}

impl Levels {
    pub(super) fn new(cells: &Cells, spheres: &[[f32; 4]]) -> Self {
        let level_of = |[.., radius]: &[f32; 4]| match f64::from(*radius) / cells.side {
            radius if radius < LEAST => None,
            radius if radius <= LARGEST => Some(0),
            radius => Some((radius / LARGEST).log2().ceil() as u32),
        };
        let levels = parallel::map_chunks(spheres, |_, part| part.iter().filter_map(level_of).collect::<BTreeSet<_>>());
        let levels = levels.into_iter().flatten().collect::<BTreeSet<_>>().into_iter().map(|number| {
            let grown = 2.0_f64.powi(number as i32);
            let counts = cells.cube_counts().map(|count| (count as f64 / grown).ceil() as usize);
            let mut level = Level { side: 2.0 * cells.side * grown, counts, starts: Vec::new(), ids: Vec::new() };
            level.fill(cells, spheres, |sphere| level_of(sphere) == Some(number));
            level
        });
        Self(levels.collect())
    }

    /// The list of a cube, with centres counted from its middle, and whether it lacks spheres.
    fn list(&self, cells: &Cells, spheres: &[[f32; 4]], cube: u32) -> (Vec<[f32; 4]>, bool) {
        let middle = cells.middle(cube);
        let mut ids = Vec::new();
        for level in &self.0 {
            let place = level.place(cells, middle);
            let around = [0, 1, 2].map(|axis| place[axis].saturating_sub(2)..(place[axis] + 3).min(level.counts[axis]));
            for z in around[2].clone() {
                for y in around[1].clone() {
                    let row = (z * level.counts[1] + y) * level.counts[0];
                    let [first, last] = [around[0].start, around[0].end].map(|x| level.starts[row + x] as usize);
                    ids.extend(level.ids[first..last].iter().filter(|id| {
                        let (center, radius) = sphere(spheres, **id);
                        let beyond = ((center - middle).abs() - cells.side).max(DVec3::ZERO);
                        beyond.length_squared() <= (radius + REACH * cells.side).powi(2)
                    }));
                }
            }
        }
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

    /// The lists of some cubes, one after the other; their ends; and the number of those that lack spheres.
    pub(super) fn lists(&self, cells: &Cells, spheres: &[[f32; 4]], cubes: &[u32]) -> (Vec<[f32; 4]>, Vec<u32>, usize) {
        let (mut near, mut ends, mut cut) = (Vec::new(), Vec::new(), 0);
        for (list, is_cut) in parallel::map(cubes.len(), |k| self.list(cells, spheres, cubes[k])) {
            near.extend(list);
            ends.push(near.len() as u32);
            cut += usize::from(is_cut);
        }
        (near, ends, cut)
    }
}

impl Level {
    /// Sorts the spheres of this level by their cubes.
    fn fill(&mut self, cells: &Cells, spheres: &[[f32; 4]], is_here: impl Fn(&[f32; 4]) -> bool + Sync) {
        let cube_of = |sphere: &[f32; 4]| {
            let [x, y, z, _] = sphere.map(f64::from);
            let [x, y, z] = self.place(cells, DVec3::new(x, y, z));
            let cube = (z * self.counts[1] + y) * self.counts[0] + x;
            is_here(sphere).then_some(cube as u32)
        };
        let parts = parallel::map_chunks(spheres, |_, spheres| spheres.iter().map(cube_of).collect::<Vec<_>>());
        let cubes = || parts.iter().flatten().enumerate().filter_map(|(id, cube)| Some((id, (*cube)? as usize)));
        self.starts = vec![0; self.counts.into_iter().product::<usize>() + 2];
        cubes().for_each(|(_, cube)| self.starts[cube + 2] += 1);
        (1..self.starts.len()).for_each(|cube| self.starts[cube] += self.starts[cube - 1]);
        self.ids = vec![0; self.starts.last().map_or(0, |end| *end as usize)];
        // The start of each cube moves to its end, which is where the next one starts.
        for (id, cube) in cubes() {
            let next = &mut self.starts[cube + 1];
            self.ids[*next as usize] = id as u32;
            *next += 1;
        }
    }

    /// The cube of a point.
    fn place(&self, cells: &Cells, point: DVec3) -> [usize; 3] {
        let place = ((point - cells.origin) / self.side).to_array();
        [0, 1, 2].map(|axis| (floor(place[axis]).max(0) as usize).min(self.counts[axis] - 1))
    }
}
