//! Traversal of a grid in f32. The WGSL twin is `shaders/accel/nested_grid.wgsl`, with the same order of cells and spheres;
//! `ball_grid.wgsl` is the version for one level, without the inner loop.

use glam::{BVec3, Vec3};

use super::ball::PartInCell;
use super::grid::{Grid, LAST, word};
use super::query::{NO_HIT, Nearest, RayF32};
use super::slab::inverse_direction;
use super::sphere::intersect_sphere;

/// The nearest sphere of the brick so far.
struct Found {
    t: f32,
    shape_index: Option<u32>,
}

impl Grid {
    /// Updates `nearest` with the nearest sphere of the grid.
    ///
    /// `spheres` and `ids` are in the order that the grid refers to.
    pub fn find_nearest(
        &self,
        spheres: &[[f32; 4]],
        ids: &[u32],
        ray: &RayF32,
        nearest: &mut Nearest,
    ) {
        let mut found = Found { t: nearest.t, shape_index: None };
        self.walk(spheres, ray, &mut found, false);
        if let Some(shape_index) = found.shape_index {
            nearest.offer(found.t, ids[shape_index as usize]);
        }
    }

    /// Whether the ray hits any sphere before `t_max`.
    #[must_use]
    pub fn find_any(&self, spheres: &[[f32; 4]], ray: &RayF32, t_max: f32) -> bool {
        // A list accepts a hit at the same distance as the nearest so far, so the limit is just below `t_max`.
        let mut found = Found { t: t_max.next_down(), shape_index: None };
        self.walk(spheres, ray, &mut found, true);
        found.shape_index.is_some()
    }

    fn walk(&self, spheres: &[[f32; 4]], ray: &RayF32, found: &mut Found, stop_at_first: bool) {
        let forward = ray.direction.cmpge(Vec3::ZERO);
        let ahead = Vec3::select(forward, Vec3::ONE, Vec3::ZERO);
        let step = Vec3::select(forward, Vec3::ONE, Vec3::NEG_ONE);
        let inverse = inverse_direction(ray.direction);
        let counts = Vec3::from(self.cell_counts.map(|count| count as f32));
        let base = (self.min - ray.origin) * inverse;
        let delta = self.cell_size * inverse;
        let near = base + (1.0 - ahead) * counts * delta;
        let t_end = (base + ahead * counts * delta).min_element();
        let mut t = near.max_element().max(0.0);
        if t > t_end || t > found.t {
            return;
        }
        let per_cell = 1.0 / self.cell_size;
        let start = (ray.origin - self.min) * per_cell;
        let speed = ray.direction * per_cell;
        let strides = Vec3::new(1.0, counts.x, counts.x * counts.y);
        let is_done =
            |found: &Found, t: f32| found.t <= t || (stop_at_first && found.shape_index.is_some());
        let octant = word::REACH_BITS * (!forward).bitmask();
        let mut cell = (start + t * speed).floor().clamp(Vec3::ZERO, counts - 1.0);
        loop {
            let outer = self.word(cell.dot(strides) as usize);
            let kind = outer & word::KIND;
            let reach =
                if kind == word::EMPTY { (outer >> octant & word::REACH) as f32 } else { 0.0 };
            let planes = base + (cell + step * reach + ahead) * delta;
            let t_leave = planes.min_element();
            if kind != word::EMPTY {
                let level = if kind == word::GRID { word::level(outer) } else { 0 };
                let side = (1_u32 << level) as f32;
                let inner_strides = Vec3::new(1.0, side, side * side);
                let last = Vec3::splat(side - 1.0);
                let mut inner = ((start + t * speed - cell) * side).floor().clamp(Vec3::ZERO, last);
                let mut t_enter = t;
                loop {
                    let mut inner_word = outer;
                    if kind == word::GRID {
                        let first = word::first_inner(outer);
                        inner_word = self.word(first + inner.dot(inner_strides) as usize);
                    }
                    let inner_planes = base + (cell + (inner + ahead) / side) * delta;
                    let t_inner = inner_planes.min_element();
                    if inner_word & word::KIND == word::LIST {
                        let from = (start + t_enter * speed - cell) * side - inner;
                        let length = (t_inner - t_enter) * per_cell * side;
                        let part = PartInCell::new(from, ray.direction, length);
                        self.test_list(spheres, ray, &part, inner_word & !word::KIND, found);
                    }
                    if is_done(found, t_inner) || t_inner >= t_leave {
                        break;
                    }
                    t_enter = t_inner;
                    let crossed: BVec3 = inner_planes.cmple(Vec3::splat(t_inner));
                    inner = Vec3::select(crossed, inner + step, inner);
                }
            }
            if is_done(found, t_leave) || t_leave >= t_end {
                break;
            }
            t = t_leave;
            let farthest = cell + step * reach;
            let there = (start + t * speed).floor();
            let crossed = there.clamp(cell.min(farthest), cell.max(farthest));
            let kept = crossed.clamp(Vec3::ZERO, counts - 1.0);
            let left: BVec3 = planes.cmple(Vec3::splat(t_leave));
            cell = Vec3::select(left, cell + step * (reach + 1.0), kept);
        }
    }

    /// The word at an index. Rounding may give the index of a cell beyond the last; a kernel then reads another word,
    /// and so may this.
    fn word(&self, index: usize) -> u32 {
        self.cells.get(index).copied().unwrap_or(word::EMPTY)
    }

    /// Tests the spheres of a list whose balls the part of the ray in the cell meets.
    /// The nearest hit replaces an earlier one at the same distance; `shaders/accel/ball_list.wgsl` explains why.
    fn test_list(
        &self,
        spheres: &[[f32; 4]],
        ray: &RayF32,
        part: &PartInCell,
        start: u32,
        found: &mut Found,
    ) {
        let mut best = Found { t: NO_HIT, shape_index: None };
        for at in self.list(start) {
            if !part.meets(self.balls[at]) {
                continue;
            }
            let shape_index = self.references[at] & !LAST;
            let t = intersect_sphere(ray, spheres[shape_index as usize]);
            if t < best.t {
                best = Found { t, shape_index: Some(shape_index) };
            }
        }
        if best.shape_index.is_some() && best.t <= found.t {
            *found = best;
        }
    }
}
