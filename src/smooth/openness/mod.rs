//! Openness: the share of ambient light that reaches a point of a surface, without random rays.
//!
//! Spheres near a point count one by one, cones near it as strings of balls inside them, and all others through *cells*, cubes with eight sample points each, of which
//! those inside shapes are counted. The light that passes through the cells along 32 directions is the same for all
//! points around a *vertex*, the centre of every second cell along each axis, so that it is computed once for each vertex
//! that a visible point needs. A near sphere fades out over the distances at which its cells fade in.
//!
//! The tables depend on the spheres and on how far these occlude, and the openness of a point on the tables, so that it is
//! the same for every camera.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{IVec3, Vec3};

use super::cells::{Cells, corners, index};
use super::levels::Places;
use super::lists::{CubeLists, NONE, Needed};
use super::spots::Row;
use crate::parallel;
use far::{DIRECTIONS, Rays, directions};

mod at;
mod far;
mod near;

/// The tables from which the openness of points is computed.
#[derive(Debug)]
pub(super) struct Openness {
    /// For each cell the number of its sample points, of eight, that are inside spheres.
    filled: Vec<u8>,
    rays: Rays,
    /// The distance at which near spheres no longer count.
    near_end: f32,
    directions: [Vec3; DIRECTIONS],
    /// The number of each vertex's entry in `far`. Entry 0 is that of vertices that no visible point needs.
    vertices: Vec<u32>,
    /// The share of light, of 255, that passes along each direction from a vertex.
    far: Vec<[u8; DIRECTIONS]>,
    /// Centres, counted from the middle of the cube, and radii of the spheres near each cube.
    near: CubeLists<[f32; 4]>,
    /// The number of lists that lack spheres.
    pub(super) crowded: AtomicUsize,
}

impl Openness {
    /// Counts the sample points of cells inside spheres. `radius` is the distance up to which spheres occlude.
    pub(super) fn new(places: &Places<'_>, radius: f64) -> Self {
        let cells = places.cells;
        let near_end = radius.min(2.0 * cells.side) as f32;
        let cubes = cells.cube_counts().into_iter().product();
        Self {
            filled: cells.fill(places.shapes, places.pieces),
            rays: Rays::new(cells, radius),
            near_end,
            directions: directions().map(|direction| direction.as_vec3()),
            vertices: vec![NONE; cubes],
            far: vec![[0; DIRECTIONS]],
            near: CubeLists::new(places),
            crowded: AtomicUsize::new(0),
        }
    }

    /// The bytes of the tables for a picture with so many pixels, with 64 spheres in each list.
    #[cfg(feature = "gpu")]
    pub(super) fn bytes(cells: &Cells, pixels: u64) -> u64 {
        let [all, cubes] =
            [cells.counts, cells.cube_counts()].map(|counts| counts.into_iter().product::<usize>() as u64);
        all + 16 * cubes + cubes.min(2 * pixels) * (DIRECTIONS as u64 + 64 * 16)
    }

    /// Completes the tables for some spots and their cubes.
    pub(super) fn see(&mut self, places: &Places<'_>, rows: &[Row], cubes: &Needed) {
        let cells = places.cells;
        let vertices = Needed::none(self.vertices.len());
        parallel::for_each(rows.iter().collect(), |row: &Row| {
            for spot in &row.all {
                let (first, parts) = cells.tetrahedron(spot.position, spot.normal);
                corners(first, parts)
                    .into_iter()
                    .for_each(|(vertex, _)| vertices.mark(index(cells.cube_counts(), vertex)));
            }
        });
        let new = vertices.number(&mut self.vertices, self.far.len());
        self.far.extend(parallel::map(new.len(), |k| self.rays.from(cells, &self.filled, cells.vertex(new[k]))));
        let crowded = &self.crowded;
        self.near.complete(cubes, |cube| {
            let (list, is_cut) = near::list(places, cube);
            crowded.fetch_add(usize::from(is_cut), Ordering::Relaxed);
            list
        });
    }

    /// The shares of light, of 255, that pass along each direction from a vertex.
    fn far_of(&self, cells: &Cells, vertex: IVec3) -> &[u8; DIRECTIONS] {
        &self.far[self.vertices[index(cells.cube_counts(), vertex) as usize] as usize]
    }
}
