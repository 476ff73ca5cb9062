//! The cells of a grid that a cone overlaps, and capsules: a capsule is a coarse shape around the part of a cone in a
//! cell, two ends and a radius, packed into two words as balls are into one (`ball.rs`).
//!
//! # Why no cone is lost
//! A hit is within the margin of the cone, as for the boxes of trees; for cones this is not proved as it is for spheres,
//! but random scenes are searched by lists, trees and grids (`tests/gpu/cones.rs`). Given that, a cone is left out of a cell only if a plane separates them by more than the margin, or if the cell is inside by more
//! than the margin. Planes are tried whose normals are along the cell's sides, across one of them and the axis
//! (Gottschalk, Lin and Manocha, 1996, for boxes), and along the line from the cone to the middle of the cell. All
//! numbers are f64. So the cells are those near the cone and a few others at its rims.
//!
//! A point of the cone that is within the margin of the cell is no farther than the radius R from its foot on the axis,
//! and so is the foot from the cell, plus the margin. Hence the axis is cut to the box around the cell that is larger
//! by R and the margin on each side. The radius at the foot is at most the larger one at both ends of that part. What
//! rounding moves an end is added to the radius. The kernel sees both ends along the ray, in two coordinates: roundings of
//! numbers up to 442 quanta, and directions that are off by 2⁻¹⁹, move a squared distance of at most 7,600 by less than a
//! quarter; the slack of balls is 1.

use glam::DVec3;

use super::ball::BallFrame;
use super::cells::Cells;
use super::listed::Listed;
use crate::geometry::cone::ConeInFrame;

/// The number of capsules in a vector of a kernel.
#[cfg(all(feature = "gpu", test))]
pub(crate) const CAPSULES_PER_VECTOR: usize = ConeInFrame::PER_VECTOR;

/// A cone prepared for the search of cells.
struct Body<'a> {
    cone: &'a ConeInFrame,
    margin: f64,
    start: DVec3,
    span: DVec3,
    length: f64,
    axis: DVec3,
    /// The largest radius with the margin.
    reach: f64,
    /// Directions across the axis and the sides of cells.
    across: [DVec3; 3],
}

impl<'a> Body<'a> {
    fn new(cone: &'a ConeInFrame, margin: f32) -> Self {
        let [start, end] = cone.ends();
        let [first, second] = cone.radii();
        let (span, margin, axis) = (end - start, f64::from(margin), cone.axis());
        let across = DVec3::AXES.map(|side| side.cross(axis).normalize_or_zero());
        Self { cone, margin, start, span, length: span.length(), axis, reach: first.max(second) + margin, across }
    }

    /// True if a cell with this middle and half this edge length may be within the margin of the surface.
    fn is_near(&self, middle: DVec3, half: f64) -> bool {
        let Self { cone, margin, start, axis, length, .. } = *self;
        let to_middle = middle - start;
        let spread = |n: DVec3| half * n.abs().element_sum();
        if self.across.iter().any(|n| n.dot(to_middle).abs() > self.reach + spread(*n)) {
            return false;
        }
        let [first, second] = cone.radii();
        let (height, slope) = (to_middle.dot(axis), (second - first) / length);
        let from_axis = to_middle - height * axis;
        // From about the nearest place of the cone to the middle of the cell.
        let foot = height.clamp(0.0, length);
        let n = (to_middle - foot * axis - from_axis.clamp_length_max(first + slope * foot)).normalize_or_zero();
        if n.dot(middle) - spread(n) - cone.support(axis, n) > margin {
            return false;
        }
        // A ball around the cell that is inside.
        let ball = half * 3_f64.sqrt() + margin;
        let from_side = first + slope * height - from_axis.length();
        height < ball || length - height < ball || from_side < ball * slope.hypot(1.0)
    }
}

/// The parts of a way from a start, from 0 to 1, at which it has these two values, or the nearest parts.
fn parts(start: f64, span: f64, values: [f64; 2]) -> [f64; 2] {
    values.map(|value| if span == 0.0 { 0.0 } else { ((value - start) / span).clamp(0.0, 1.0) })
}

impl Listed for ConeInFrame {
    type Guard = [u32; 2];

    /// Measured on lavapipe with a million random cylinders, where the time hardly changes between three and eight.
    const STEP_COST: f32 = 6.0;

    /// By Steiner's formula for the mean over all turns of a convex body with the volume V, the surface S and the mean
    /// width b: V + 3/4 S size + 3 b size² + size³.
    fn mean_overlapped_cells(&self, size: f32) -> f32 {
        use std::f64::consts::PI;
        let size = f64::from(size);
        let [start, end] = self.ends();
        let ([r, s], length) = (self.radii(), (end - start).length());
        let volume = PI / 3.0 * length * (r * r + r * s + s * s);
        let surface = PI * ((r + s) * (s - r).hypot(length) + r * r + s * s);
        let width = 0.5 * length + 0.25 * PI * (r + s);
        // Cells inside are left out.
        let inside = (0.5 * (r + s) / size - 0.866).max(0.0);
        let without = PI * inside * inside * (length / size - 1.732).max(0.0);
        ((volume / size + 0.75 * surface) / (size * size) + 3.0 * width / size + 1.0 - without) as f32
    }

    /// Goes along the axis from layer to layer of cells, so that a long cone takes as long as the cells around it.
    fn for_each_near(&self, cells: &Cells, margin: f32, mut f: impl FnMut(usize)) {
        let body = Body::new(self, margin);
        let (min, size) = (cells.min.as_dvec3(), f64::from(cells.size));
        let last = DVec3::from(cells.counts.map(|count| f64::from(count - 1)));
        let cell_of = |at: DVec3| ((at - min) / size).floor().clamp(DVec3::ZERO, last);
        let [low, high] = self.corners();
        let (low, high) = (low - body.margin, high + body.margin);
        let (first, end) = (cell_of(low), cell_of(high));
        let along = body.axis.abs().max_position();
        for layer in first[along] as u32..=end[along] as u32 {
            let near = min[along] + f64::from(layer) * size;
            let ends = parts(body.start[along], body.span[along], [near - body.reach, near + size + body.reach]);
            let ends = ends.map(|part| body.start + part * body.span);
            let mut from = cell_of(low.max(ends[0].min(ends[1]) - body.reach)).as_uvec3();
            let mut to = cell_of(high.min(ends[0].max(ends[1]) + body.reach)).as_uvec3();
            (from[along], to[along]) = (layer, layer);
            for z in from.z..=to.z {
                for y in from.y..=to.y {
                    for x in from.x..=to.x {
                        let middle = min + size * (DVec3::new(x.into(), y.into(), z.into()) + 0.5);
                        if body.is_near(middle, 0.5 * size) {
                            f(cells.index([x, y, z]));
                        }
                    }
                }
            }
        }
    }

    fn guard(&self, frame: &BallFrame) -> [u32; 2] {
        let (corner, size, margin) = frame.cell();
        let (corner, size) = (corner.as_dvec3(), f64::from(size));
        let ([start, end], [first, second]) = (self.ends(), self.radii());
        let (span, reach) = (end - start, first.max(second) + f64::from(margin));
        let mut part = [0.0_f64, 1.0];
        for axis in (0..3).filter(|axis| span[*axis] != 0.0) {
            let [a, b] = parts(start[axis], span[axis], [corner[axis] - reach, corner[axis] + size + reach]);
            part = [part[0].max(a.min(b)), part[1].min(a.max(b))];
        }
        // The cell is listed although the axis does not come near it, or the capsule would be larger than three cells.
        if part[0] > part[1] || reach > size {
            return frame.capsule(None, 0.0);
        }
        let radius = part.map(|part| first + part * (second - first)).into_iter().fold(0.0, f64::max);
        let ends = part.map(|part| (start + part * span - corner).as_vec3());
        frame.capsule(Some(ends), radius as f32)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::accel::ball::{QUANTA, unpack};

    fn cone(rng: &mut fastrand::Rng, size: f32) -> ConeInFrame {
        let mut at = || [0.0; 3].map(|_| 2.0 * rng.f32() - 0.5);
        let (start, there) = (at(), at());
        let mut end: [f32; 3] = std::array::from_fn(|axis| start[axis] + size * (there[axis] - start[axis]));
        if rng.bool() {
            // Along an axis of the cells.
            let axis = rng.usize(..3);
            end = start;
            end[axis] += size * (rng.f32() + 0.01);
        }
        let mut radius = || size * [0.0, 0.01, 0.3, 2.0][rng.usize(..4)] * (rng.f32() + 0.1) + 1e-4;
        ConeInFrame { start, first_radius: radius(), end, second_radius: radius() }
    }

    /// A place on the side of a cone or on a disc.
    fn place(rng: &mut fastrand::Rng, cone: &ConeInFrame) -> DVec3 {
        let ([start, end], [first, second]) = (cone.ends(), cone.radii());
        let axis = (end - start).normalize_or_zero();
        let (right, up) = axis.any_orthonormal_pair();
        let (sine, cosine) = (std::f64::consts::TAU * rng.f64()).sin_cos();
        let (along, part) = match rng.u32(..3) {
            0 => (rng.f64(), 1.0),
            disc => (f64::from(disc - 1), rng.f64()),
        };
        start + along * (end - start) + part * (first + along * (second - first)) * (cosine * right + sine * up)
    }

    /// Every place of a surface is in a cell that lists the cone, and in the capsule of that list.
    #[test]
    fn cells_and_capsules_hold_all_places() {
        let mut rng = fastrand::Rng::with_seed(5);
        let mut inside = 0;
        for round in 0..20_000 {
            let size = 10_f32.powf(rng.f32() * 3.0 - 2.5);
            let cone = cone(&mut rng, size);
            let cells = Cells { min: Vec3::ZERO, size: 0.125, counts: [8, 8, 8] };
            let margin = if round % 2 == 0 { 1e-6 } else { 0.01 };
            let mut listed = Vec::new();
            cone.for_each_near(&cells, margin, |cell| listed.push(cell));
            for _ in 0..8 {
                let at = place(&mut rng, &cone);
                let coordinates = (at / 0.125).floor();
                if coordinates.min_element() < 0.0 || coordinates.max_element() > 7.0 {
                    continue;
                }
                inside += 1;
                assert!(listed.contains(&cells.index(coordinates.as_uvec3().to_array())), "{cone:?} {at}");
                let frame = BallFrame::new((0.125 * coordinates).as_vec3(), 0.125, margin);
                let [first, second] = cone.guard(&frame);
                let ((first, squared), (second, _)) = (unpack(first), unpack(second));
                let from_corner = (at - 0.125 * coordinates).as_vec3() * (QUANTA / 0.125) + QUANTA;
                let span = second - first;
                let along = ((from_corner - first).dot(span) / span.length_squared().max(1e-9)).clamp(0.0, 1.0);
                let away = from_corner.distance(first + along * span);
                assert!(away * away <= squared, "{cone:?} {at} {away} {squared}");
            }
        }
        assert!(inside > 20_000, "{inside}");
    }

    /// A cylinder that crosses many cells from corner to corner is listed only along its way, and the mean number of cells
    /// is what Steiner's formula says.
    #[test]
    fn only_cells_near_a_cone_list_it() {
        let cells = Cells { min: Vec3::ZERO, size: 0.01, counts: [100; 3] };
        let long = ConeInFrame { start: [0.1; 3], first_radius: 1e-4, end: [0.9; 3], second_radius: 1e-4 };
        let mut listed = 0;
        long.for_each_near(&cells, 1e-6, |_| listed += 1);
        assert!((80..=600).contains(&listed), "{listed}");
        let mut rng = fastrand::Rng::with_seed(6);
        for (length, radius) in [(0.05_f64, 0.002_f64), (0.2, 0.01), (0.004, 0.003), (0.03, 0.03)] {
            let (mut found, mut expected) = (0.0, 0.0);
            for _ in 0..500 {
                let axis = DVec3::from([0; 3].map(|_| rng.f64() - 0.5)).normalize_or(DVec3::X);
                let middle = DVec3::from([0; 3].map(|_| 0.3 + 0.4 * rng.f64()));
                let [start, end] = [-0.5, 0.5].map(|part| (middle + part * length * axis).as_vec3().to_array());
                let radius = radius as f32;
                let cone = ConeInFrame { start, first_radius: radius, end, second_radius: radius };
                cone.for_each_near(&cells, 0.0, |_| found += 1.0);
                expected += Listed::mean_overlapped_cells(&cone, 0.01);
            }
            let ratio = found / expected;
            assert!((0.85..1.2).contains(&ratio), "{length} {radius}: {ratio}");
        }
    }
}
