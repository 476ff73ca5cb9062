//! Openness: the share of ambient light that reaches a point of a surface, without random rays.
//!
//! Spheres near a point count one by one, and all others through *cells*, cubes with eight sample points each, of which
//! those inside spheres are counted. The light that passes through the cells along 32 directions is the same for all
//! points around a *vertex*, the centre of every second cell along each axis, so that it is computed once for each vertex
//! that a visible point needs. A near sphere fades out over the distances at which its cells fade in.
//!
//! The tables depend on the spheres and on how far these occlude, and the openness of a point on the tables, so that it is
//! the same for every camera.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DVec3, IVec3, Vec3};

use super::spots::Spot;
use crate::parallel;
use cells::{Cells, index};
use far::{DIRECTIONS, Rays, directions};
use near::Levels;

mod at;
mod cells;
mod far;
mod near;

/// The number of a vertex or a cube that no visible point needs.
const NONE: u32 = 0;

/// The tables from which the openness of points is computed.
#[derive(Debug)]
pub(super) struct Openness {
    cells: Cells,
    rays: Rays,
    /// The distance at which near spheres no longer count.
    near_end: f32,
    levels: Levels,
    directions: [Vec3; DIRECTIONS],
    /// The number of each vertex's entry in `far`. Entry 0 is that of vertices that no visible point needs.
    vertices: Vec<u32>,
    /// The share of light, of 255, that passes along each direction from a vertex.
    far: Vec<[u8; DIRECTIONS]>,
    /// The number of the list of each cube of 2×2×2 cells. List 0 is that of cubes without visible points, and empty.
    cubes: Vec<u32>,
    /// The end of each list in `near`.
    ends: Vec<u32>,
    /// Centres, counted from the middle of the cube, and radii of the spheres near the visible points of each cube.
    near: Vec<[f32; 4]>,
    /// The number of lists that lack spheres.
    pub(super) crowded: usize,
}

impl Openness {
    /// Counts the sample points of cells inside spheres. `radius` is the distance up to which spheres occlude.
    pub(super) fn new(spheres: &[[f32; 4]], radius: f64) -> Self {
        let cells = Cells::new(spheres);
        let rays = Rays::new(&cells, radius);
        let near_end = radius.min(2.0 * cells.side) as f32;
        let cubes = cells.cube_counts().into_iter().product();
        Self {
            rays,
            near_end,
            levels: Levels::new(&cells, if cells.has_near { spheres } else { &[] }),
            directions: directions().map(|direction| direction.as_vec3()),
            vertices: vec![NONE; cubes],
            far: vec![[0; DIRECTIONS]],
            cubes: vec![NONE; cubes],
            ends: vec![0],
            near: Vec::new(),
            crowded: 0,
            cells,
        }
    }

    /// The bytes of the tables for a picture with so many pixels, with 64 spheres in each list.
    #[cfg(feature = "gpu")]
    pub(super) fn bytes(spheres: &[[f32; 4]], pixels: u64) -> u64 {
        let cells = Cells::unfilled(spheres);
        let [all, cubes] =
            [cells.counts, cells.cube_counts()].map(|counts| counts.into_iter().product::<usize>() as u64);
        all + 16 * cubes + 4 * spheres.len() as u64 + cubes.min(2 * pixels) * (DIRECTIONS as u64 + 64 * 16)
    }

    /// Completes the tables for the points of some lists.
    pub(super) fn see<'a>(&mut self, spheres: &[[f32; 4]], lists: Vec<impl Iterator<Item = &'a Spot> + Send>) {
        let flags = |all: &[u32]| all.iter().map(|_| AtomicBool::new(false)).collect::<Vec<_>>();
        let (vertices, cubes) = (flags(&self.vertices), flags(&self.cubes));
        parallel::for_each(lists, |list| {
            list.for_each(|spot| self.cells.needs(spot.position, spot.normal, &vertices, &cubes));
        });
        let new = number(&mut self.vertices, &vertices, self.far.len());
        self.far.extend(parallel::map(new.len(), |k| self.rays.from(&self.cells, self.cells.vertex(new[k]))));
        let new = number(&mut self.cubes, &cubes, self.ends.len());
        let (near, ends, crowded) = self.levels.lists(&self.cells, spheres, &new);
        let before = self.near.len() as u32;
        self.ends.extend(ends.into_iter().map(|end| before + end));
        self.near.extend(near);
        self.crowded += crowded;
    }

    /// The spheres that are near a visible point, and the middle of its cube.
    fn near_of(&self, position: DVec3) -> (&[[f32; 4]], DVec3) {
        let cube = self.cells.cube_of(position);
        let list = self.cubes[cube as usize] as usize;
        let start = list.checked_sub(1).map_or(0, |before| self.ends[before] as usize);
        (&self.near[start..self.ends[list] as usize], self.cells.middle(cube))
    }

    /// The shares of light, of 255, that pass along each direction from a vertex.
    fn far_of(&self, vertex: IVec3) -> &[u8; DIRECTIONS] {
        &self.far[self.vertices[index(self.cells.cube_counts(), vertex) as usize] as usize]
    }
}

/// Numbers the needed places that have no number, from `first` on, in order. Returns them.
fn number(numbers: &mut [u32], needed: &[AtomicBool], first: usize) -> Vec<u32> {
    let mut new = Vec::new();
    for (place, (number, needed)) in numbers.iter_mut().zip(needed).enumerate() {
        if *number == NONE && needed.load(Ordering::Relaxed) {
            *number = (first + new.len()) as u32;
            new.push(place as u32);
        }
    }
    new
}
