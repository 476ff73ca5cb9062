//! A walk of a grid in f64. The caller tests the spheres.
//!
//! # Why it misses no sphere
//! The terms are those of `wide_tree_visit.rs`: if `intersect` of `src/cpu/sphere.rs` accepts the distance t, the point
//! of the ray at t, or one before it, is within w of the sphere's surface, where w = (128 u + 8 β) D bounds all errors of
//! that test and of the walk: the test computes a point of the surface, or the quotient of its third case, which is no
//! earlier than the entry into the widened sphere or the origin, if that lies in it and not in the sphere. `Grid::ray`
//! accepts only rays for which twice w is at most a quarter of the grid's margin, which is more than 2⁻¹⁹ of the longest
//! side of all cells ([`LEAST_MARGIN`]): 2⁻¹⁷ of the scene's diagonal, and cells reach less than twice as far. So:
//!
//! 1. *Cells.* The walk enters every cell that the ray crosses, up to a rounding of less than 8 u D. The sphere is
//!    listed in the cell of that point and in all cells within its margin, because lists hold all spheres whose
//!    surfaces come within the margin of the cell. A ray along the plane between two cells may be on the far side of it
//!    by rounding. Since no cell is left before it is entered, such a ray goes to the next cell at once.
//! 2. *Balls.* The budget of `ball.rs` is the same, except for the ray's position in the cell, its direction and the
//!    length of its part, which are computed in f64 and rounded to f32. Each rounding moves the part by less than 2⁻²⁴
//!    of two cells' sides, together less than 2⁻²¹ of a side, a quarter of the margin.
//! 3. *The end.* A walk ends after a cell that the ray leaves at or after the limit. Spheres that the ray hits at the
//!    limit are in the lists of the cell that contains the limit.

use glam::{DVec3, Vec3};

use super::ball::{BALLS_PER_VECTOR, PartInCell};
use super::grid::{Grid, LAST, word};

/// The margin of every grid is at least this fraction of its longest side.
const LEAST_MARGIN: f64 = 1.0 / (1 << 19) as f64;

/// The smallest magnitude of a direction's component. Smaller ones are replaced by it, as in `wide_tree_visit.rs`.
const SMALLEST: f64 = 1e-18;

/// A ray prepared for a grid. Positions are in units of the grid's cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridRay {
    /// The distance to plane p of an axis is base + p · delta.
    base: DVec3,
    delta: DVec3,
    /// The position at distance t is start + t · speed.
    start: DVec3,
    speed: DVec3,
    direction: Vec3,
    per_cell: f64,
}

impl Grid {
    /// Prepares a ray. Returns `None` if it starts so far away that rounding errors are not small beside the margin.
    pub(crate) fn ray(&self, origin: DVec3, direction: DVec3) -> Option<GridRay> {
        let (min, size) = (self.min.as_dvec3(), f64::from(self.cell_size));
        let extent = DVec3::from(self.cell_counts.map(f64::from)) * size;
        let farthest = (min - origin).abs().max((min + extent - origin).abs()).length();
        let bend = (1.0 - direction.length_squared()).abs();
        let errors = (128.0 * f64::EPSILON + 16.0 * bend) * farthest;
        if errors.is_nan() || errors > 0.25 * LEAST_MARGIN * extent.max_element() {
            return None;
        }
        let inverse = 1.0 / direction.abs().max(DVec3::splat(SMALLEST)).copysign(direction);
        let per_cell = 1.0 / size;
        Some(GridRay {
            base: (min - origin) * inverse,
            delta: size * inverse,
            start: (origin - min) * per_cell,
            speed: direction * per_cell,
            direction: direction.as_vec3(),
            per_cell,
        })
    }

    /// Calls `offer` with every sphere for which `intersect` in f64 finds a distance of at most `limit`. The sphere is
    /// given by its place in the order that the grid's references use. `offer` returns the new limit, or a negative
    /// number to end the walk. Some spheres are offered several times.
    #[inline]
    pub(crate) fn visit(&self, ray: &GridRay, mut limit: f64, mut offer: impl FnMut(usize) -> f64) {
        let GridRay { base, delta, start, speed, .. } = *ray;
        let counts = DVec3::from(self.cell_counts.map(f64::from));
        let forward = delta.cmpge(DVec3::ZERO);
        let ahead = DVec3::select(forward, DVec3::ONE, DVec3::ZERO);
        let step = DVec3::select(forward, DVec3::ONE, DVec3::NEG_ONE);
        let near = base + (1.0 - ahead) * counts * delta;
        let t_end = (base + ahead * counts * delta).min_element();
        let mut t = near.max_element().max(0.0);
        if t > t_end {
            return;
        }
        let strides = DVec3::new(1.0, counts.x, counts.x * counts.y);
        let octant = word::REACH_BITS * (!forward).bitmask();
        let mut cell = (start + t * speed).floor().clamp(DVec3::ZERO, counts - 1.0);
        while t <= limit {
            let outer = self.cells[cell.dot(strides) as usize];
            let kind = outer & word::KIND;
            let reach = if kind == word::EMPTY { f64::from(outer >> octant & word::REACH) } else { 0.0 };
            let planes = base + (cell + step * reach + ahead) * delta;
            let t_leave = planes.min_element().max(t);
            if kind == word::LIST {
                let from = start + t * speed - cell;
                let part = self.part(ray, from, t_leave - t, 1.0);
                limit = self.offer_list(&part, outer & !word::KIND, limit, &mut offer);
            } else if kind == word::GRID {
                limit = self.visit_inner(ray, [cell, ahead, step], outer, [t, t_leave], limit, &mut offer);
            }
            if t_leave >= t_end || limit < 0.0 {
                return;
            }
            t = t_leave;
            let left = planes.cmple(DVec3::splat(t_leave));
            if reach > 0.0 {
                let farthest = cell + step * reach;
                let there = (start + t * speed).floor();
                let crossed = there.clamp(cell.min(farthest), cell.max(farthest));
                cell = DVec3::select(left, farthest + step, crossed);
            } else {
                cell = DVec3::select(left, cell + step, cell);
            }
            if cell.cmplt(DVec3::ZERO).any() || cell.cmpge(counts).any() {
                return;
            }
        }
    }

    /// Does the same in the grid inside a cell, which the ray crosses between the two distances `t` and `t_leave`.
    #[inline]
    fn visit_inner(
        &self,
        ray: &GridRay,
        [cell, ahead, step]: [DVec3; 3],
        outer: u32,
        [mut t, t_leave]: [f64; 2],
        mut limit: f64,
        offer: &mut impl FnMut(usize) -> f64,
    ) -> f64 {
        let side = f64::from(1_u32 << word::level(outer));
        let (first, strides) = (word::first_inner(outer), DVec3::new(1.0, side, side * side));
        let within = (ray.start + t * ray.speed - cell) * side;
        let mut inner = within.floor().clamp(DVec3::ZERO, DVec3::splat(side - 1.0));
        while t <= limit {
            let inner_word = self.cells[first + inner.dot(strides) as usize];
            let planes = ray.base + (cell + (inner + ahead) / side) * ray.delta;
            let t_inner = planes.min_element().max(t);
            if inner_word & word::KIND == word::LIST {
                let from = (ray.start + t * ray.speed - cell) * side - inner;
                let part = self.part(ray, from, t_inner - t, side);
                limit = self.offer_list(&part, inner_word & !word::KIND, limit, offer);
            }
            if t_inner >= t_leave || limit < 0.0 {
                break;
            }
            t = t_inner;
            inner = DVec3::select(planes.cmple(DVec3::splat(t)), inner + step, inner);
            if inner.cmplt(DVec3::ZERO).any() || inner.cmpge(DVec3::splat(side)).any() {
                break;
            }
        }
        limit
    }

    fn part(&self, ray: &GridRay, from: DVec3, length: f64, side: f64) -> PartInCell {
        PartInCell::new(from.as_vec3(), ray.direction, (length * ray.per_cell * side) as f32)
    }

    /// Offers the spheres of a list whose balls the ray meets.
    #[inline]
    fn offer_list(&self, part: &PartInCell, start: u32, mut limit: f64, offer: &mut impl FnMut(usize) -> f64) -> f64 {
        let start = start as usize;
        let vectors = self.balls[start..].as_chunks::<BALLS_PER_VECTOR>().0;
        let references = self.references[start..].as_chunks::<BALLS_PER_VECTOR>().0;
        for (four, references) in vectors.iter().zip(references) {
            let mut met = part.meets_four(four);
            while met != 0 && limit >= 0.0 {
                let i = met.trailing_zeros() as usize;
                met &= met - 1;
                limit = offer((references[i] & !LAST) as usize);
            }
            if four[BALLS_PER_VECTOR - 1] & LAST != 0 || limit < 0.0 {
                break;
            }
        }
        limit
    }
}
