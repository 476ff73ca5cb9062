//! The spheres of a scene, and balls around pieces of its cones, by size and place.

use std::collections::BTreeSet;

use glam::DVec3;

use super::cells::{Cells, floor};
use super::pieces::{Piece, Pieces};
use super::spots::sphere;
use crate::geometry::cone::ConeInFrame;
use crate::parallel;
use crate::scene::SharedShapes;

/// The largest radius of the smallest level of spheres, in sides of cells. With the reach of near spheres, they touch no
/// more than two cubes beside that of their centre.
const LARGEST: f64 = 1.9;

/// The shapes of a scene in cells and, as far as light needs them one by one, by size and place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places<'a> {
    pub(super) shapes: &'a SharedShapes,
    pub(super) pieces: &'a Pieces,
    /// The spheres, and then a ball around each piece. Levels have their indices.
    pub(super) balls: &'a [[f32; 4]],
    pub(super) cells: &'a Cells,
    pub(super) levels: &'a Levels,
}

impl<'a> Places<'a> {
    /// The piece, and its cone, for which a ball stands; `None` for a sphere.
    pub(super) fn piece(&self, ball: u32) -> Option<(Piece, &'a ConeInFrame)> {
        let piece = self.pieces.all[(ball as usize).checked_sub(self.shapes.spheres.len())?];
        Some((piece, &self.shapes.cones[piece.cone as usize]))
    }
}

/// The levels of spheres of similar size, from small ones on.
#[derive(Debug)]
pub(super) struct Levels(Vec<Level>);

/// Spheres of similar size in cubes. From level to level, sides and radii double.
#[derive(Debug)]
struct Level {
    /// The grid of cubes, and those of cubes with twice the side of the one before, up to a single cube.
    grids: Vec<Grid>,
    /// The start of each cube in `ids`, and the end of the last.
    starts: Vec<u32>,
    ids: Vec<u32>,
    largest: f64,
}

#[derive(Debug)]
struct Grid {
    side: f64,
    counts: [usize; 3],
    /// True for cubes with spheres. Empty for the smallest cubes, which `starts` counts.
    has_any: Vec<bool>,
}

/// The points whose distance from a half line is at most `radius`, and more by `slope` along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    pub(super) start: DVec3,
    /// Unit vector.
    pub(super) axis: DVec3,
    pub(super) radius: f64,
    pub(super) slope: f64,
}

impl Beam {
    /// Returns true if a ball may meet the beam.
    pub(super) fn meets(&self, center: DVec3, radius: f64) -> bool {
        let to_center = center - self.start;
        let along = to_center.dot(self.axis);
        let reach = radius + self.radius + self.slope * (along + radius).max(0.0);
        along > -radius && to_center.length_squared() - along * along <= reach * reach
    }
}

impl Levels {
    pub(super) fn new(cells: &Cells, spheres: &[[f32; 4]]) -> Self {
        let level_of = |[.., radius]: &[f32; 4]| match f64::from(*radius) / (LARGEST * cells.side) {
            grown if grown <= 1.0 => 0,
            grown => grown.log2().ceil() as u32,
        };
        let levels = parallel::map_chunks(spheres, |_, part| part.iter().map(level_of).collect::<BTreeSet<_>>());
        let levels = levels.into_iter().flatten().collect::<BTreeSet<_>>().into_iter();
        Self(levels.map(|number| Level::new(cells, spheres, number, |sphere| level_of(sphere) == number)).collect())
    }

    /// The bytes of levels, with one level of all spheres.
    #[cfg(feature = "gpu")]
    pub(super) fn bytes(cells: &Cells, spheres: usize) -> u64 {
        let cubes = cells.cube_counts().into_iter().product::<usize>();
        (4 * spheres + 5 * cubes) as u64
    }

    /// Visits the spheres whose centres are within two cubes, along each axis, of the one in which a point lies, level by
    /// level.
    pub(super) fn around(&self, cells: &Cells, point: DVec3, mut visit: impl FnMut(u32)) {
        for level in &self.0 {
            let Grid { counts, .. } = level.grids[0];
            let place = level.grids[0].place(cells, point);
            let around = [0, 1, 2].map(|axis| place[axis].saturating_sub(2)..(place[axis] + 3).min(counts[axis]));
            for z in around[2].clone() {
                for y in around[1].clone() {
                    let row = (z * counts[1] + y) * counts[0];
                    level.ids_of(row + around[0].start..row + around[0].end).iter().for_each(|id| visit(*id));
                }
            }
        }
    }

    /// Visits the spheres that meet a beam, those of a level from its start on, until `visit` returns false.
    pub(super) fn along(&self, cells: &Cells, spheres: &[[f32; 4]], beam: &Beam, mut visit: impl FnMut(u32) -> bool) {
        let backwards = [0, 1, 2].map(|axis| usize::from(beam.axis[axis] < 0.0));
        // Large spheres hide most.
        for level in self.0.iter().rev() {
            let mut left = vec![(level.grids.len() - 1, [0; 3])];
            while let Some((depth, cube)) = left.pop() {
                let Grid { side, counts, has_any } = &level.grids[depth];
                let index = (cube[2] * counts[1] + cube[1]) * counts[0] + cube[0];
                let middle = cells.origin + *side * (DVec3::from(cube.map(|c| c as f64)) + 0.5);
                if has_any.get(index) == Some(&false) || !beam.meets(middle, 0.87 * side + level.largest) {
                    continue;
                }
                if depth == 0 {
                    for id in level.ids_of(index..index + 1) {
                        let (center, radius) = sphere(spheres, *id);
                        if beam.meets(center, radius) && !visit(*id) {
                            return;
                        }
                    }
                    continue;
                }
                let below = level.grids[depth - 1].counts;
                for part in (0..8).rev() {
                    let parts = [0, 1, 2].map(|axis| 2 * cube[axis] + (part >> axis & 1 ^ backwards[axis]));
                    if (0..3).all(|axis| parts[axis] < below[axis]) {
                        left.push((depth - 1, parts));
                    }
                }
            }
        }
    }
}

impl Level {
    /// Sorts the spheres of a level by their cubes.
    fn new(cells: &Cells, spheres: &[[f32; 4]], number: u32, is_here: impl Fn(&[f32; 4]) -> bool + Sync) -> Self {
        let grown = 2.0_f64.powi(number as i32);
        let counts = cells.cube_counts().map(|count| (count as f64 / grown).ceil() as usize);
        let grid = Grid { side: 2.0 * cells.side * grown, counts, has_any: Vec::new() };
        let cube_of = |sphere: &[f32; 4]| {
            let [x, y, z, _] = sphere.map(f64::from);
            let [x, y, z] = grid.place(cells, DVec3::new(x, y, z));
            is_here(sphere).then(|| ((z * counts[1] + y) * counts[0] + x) as u32)
        };
        let parts = parallel::map_chunks(spheres, |_, spheres| spheres.iter().map(cube_of).collect::<Vec<_>>());
        let cubes = || parts.iter().flatten().enumerate().filter_map(|(id, cube)| Some((id, (*cube)? as usize)));
        let mut starts = vec![0; counts.into_iter().product::<usize>() + 2];
        cubes().for_each(|(_, cube)| starts[cube + 2] += 1);
        (1..starts.len()).for_each(|cube| starts[cube] += starts[cube - 1]);
        let mut ids = vec![0; starts.last().map_or(0, |end| *end as usize)];
        // The start of each cube moves to its end, which is where the next one starts.
        for (id, cube) in cubes() {
            let next = &mut starts[cube + 1];
            ids[*next as usize] = id as u32;
            *next += 1;
        }
        let largest = ids.iter().map(|id| spheres[*id as usize][3]).fold(0.0, f32::max);
        let mut level = Self { grids: vec![grid], starts, ids, largest: largest.into() };
        while let Some(next) = level.next_grid() {
            level.grids.push(next);
        }
        level
    }

    fn ids_of(&self, cubes: std::ops::Range<usize>) -> &[u32] {
        &self.ids[self.starts[cubes.start] as usize..self.starts[cubes.end] as usize]
    }

    /// The grid of cubes with twice the side of the last ones; `None` if that is a single cube.
    fn next_grid(&self) -> Option<Grid> {
        let Grid { side, counts, has_any } = self.grids.last().filter(|last| last.counts != [1; 3])?;
        let mut next = Grid { side: 2.0 * side, counts: counts.map(|count| count.div_ceil(2)), has_any: Vec::new() };
        next.has_any = vec![false; next.counts.into_iter().product()];
        for (row, cubes) in (0..counts[1] * counts[2]).map(|row| (row, row * counts[0]..(row + 1) * counts[0])) {
            let to = ((row / counts[1] / 2) * next.counts[1] + row % counts[1] / 2) * next.counts[0];
            for (x, cube) in cubes.enumerate() {
                next.has_any[to + x / 2] |=
                    has_any.get(cube).copied().unwrap_or_else(|| !self.ids_of(cube..cube + 1).is_empty());
            }
        }
        Some(next)
    }
}

impl Grid {
    /// The cube of a point.
    fn place(&self, cells: &Cells, point: DVec3) -> [usize; 3] {
        let place = ((point - cells.origin) / self.side).to_array();
        [0, 1, 2].map(|axis| (floor(place[axis]).max(0) as usize).min(self.counts[axis] - 1))
    }
}
