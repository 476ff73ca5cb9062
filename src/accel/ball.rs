//! Balls: a ball is a coarse centre and radius of a sphere listed in a cell, packed into 31 bits. A ray that misses the
//! ball needs no test of the sphere. The WGSL twin is `shaders/accel/balls.wgsl`.
//!
//! Lengths are in quanta; a side of the cell has [`QUANTA`] of them. A ball's centre has three coordinates from 0 to
//! 255, counted from one side's length before the cell's corner, so that it lies in the 3×3×3 cells around the cell.
//! The radius is stored as its square, from 1 to 61440, with 4 bits of exponent and 3 bits of mantissa.
//!
//! # Why no sphere is lost
//! A ball must be met by every ray that, according to the sphere test, hits its sphere at a distance that lies in the
//! cell. The terms are those of `slab.rs`, for a device that rounds as it likes: u = 2⁻²⁴ D, and the margin m is 128 u.
//! The point P at that distance is within r + 51 u of the sphere's centre, in the cell up to 17 u, and on the part of
//! the ray between the distances at which the walk enters and leaves the cell. The ray's position in the cell, start +
//! t · speed − cell, is off by 17 u (two roundings each of start and of t · speed, two of the sum, and the quotient in
//! `per_cell`), the length of that part by 11 u of a cell's part of D, and the builder's position of the centre by 4 u.
//! The distance between the ball's centre and that part of the ray is therefore at most |ball's centre − sphere's
//! centre| + r + m, which is the ball's radius.
//!
//! The test itself computes squares of vectors v whose components are below 170 quanta, since the ray's position is in
//! the cell: v·v − (v·d)² and the square of the length beyond it. Its ten roundings, and the direction's length, which
//! may be off by 11 · 2⁻²³, move the result by less than 32 · 2⁻²³ v·v, which is 0.34; [`SLACK`] is more than that.
//!
//! A sphere whose ball would need a larger radius has a ball that contains the whole cell, so that every ray meets it.

use glam::Vec3;

/// The number of quanta along a side of a cell: three cells have 255.
pub(crate) const QUANTA: f32 = 85.0;

/// The largest coordinate of a ball's centre, in quanta.
const LARGEST: f32 = 255.0;

/// The coordinates of the middle of the cell, in quanta.
const MIDDLE: u32 = 128;

/// Added to the square of the radius to allow for the rounding errors of the test.
const SLACK: f32 = 1.0;

/// The number of bits of a coordinate. The bits of the radius follow those of the three coordinates.
pub(crate) const COORDINATE_BITS: u32 = 8;

/// The largest encoded radius, and the number of bits of its mantissa.
const LARGEST_RADIUS: u32 = (1 << 7) - 1;
const MANTISSA_BITS: u32 = 3;

/// The position of an encoded radius in an f32: the lowest exponent bits and the highest mantissa bits.
const RADIUS_SHIFT: u32 = f32::MANTISSA_DIGITS - 1 - MANTISSA_BITS;

/// The right shift that moves the radius of a packed ball to that position, and the mask of its bits there.
pub(crate) const RADIUS_TO_FLOAT: u32 = 3 * COORDINATE_BITS - RADIUS_SHIFT;
pub(crate) const RADIUS: u32 = LARGEST_RADIUS << RADIUS_SHIFT;

/// The number of balls in a vector of a kernel. A list is padded to a multiple of it by repeating its last element.
pub(crate) const BALLS_PER_VECTOR: usize = 4;

/// The cell of a list, which is the reference frame of its balls.
#[derive(Clone, Copy, Debug)]
pub(super) struct BallFrame {
    corner: Vec3,
    margin: f32,
    /// Quanta per unit of length.
    per_length: f32,
}

impl BallFrame {
    /// The frame of a cell with the given corner of smallest coordinates and edge length, for the margin of the scene.
    pub(super) fn new(corner: Vec3, size: f32, margin: f32) -> Self {
        Self { corner, margin, per_length: QUANTA / size }
    }

    /// The corner of the cell with the smallest coordinates, its edge length, and the margin of the scene.
    pub(super) fn cell(&self) -> (Vec3, f32, f32) {
        (self.corner, QUANTA / self.per_length, self.margin)
    }

    /// Packs the ball of a sphere.
    pub(super) fn ball(&self, [x, y, z, radius]: [f32; 4]) -> u32 {
        let (center, apart) = self.packed(Vec3::new(x, y, z) - self.corner);
        match self.squared_radius(radius, apart) {
            Some(radius) => pack(center, radius),
            None => pack([MIDDLE; 3], LARGEST_RADIUS),
        }
    }

    /// Packs a capsule, whose ends are given from the corner. It is in the order of a ball at the first end, and the second
    /// end. Without ends, every ray in the cell meets it.
    pub(super) fn capsule(&self, ends: Option<[Vec3; 2]>, radius: f32) -> [u32; 2] {
        let packed = ends.and_then(|ends| {
            let [(first, apart), (second, also)] = ends.map(|end| self.packed(end));
            Some([pack(first, self.squared_radius(radius, apart.max(also))?), pack(second, 0)])
        });
        packed.unwrap_or([pack([MIDDLE; 3], LARGEST_RADIUS), pack([MIDDLE; 3], 0)])
    }

    /// The coordinates of a place, which is given from the corner, and how far off they are.
    fn packed(&self, from_corner: Vec3) -> ([u32; 3], f32) {
        let at = from_corner * self.per_length + QUANTA;
        // Casts round towards zero. They are much faster than calls of `round`.
        let coordinates = at.to_array().map(|x| (x.clamp(0.0, LARGEST) + 0.5) as u32);
        let apart = Vec3::from_array(coordinates.map(|x| x as f32)) - at;
        (coordinates, apart.length())
    }

    /// The bits of the radius of a ball around what is rounded this far. `None` if it is too large.
    fn squared_radius(&self, radius: f32, apart: f32) -> Option<u32> {
        let reach = apart + (radius + self.margin) * self.per_length;
        let squared = reach * reach + SLACK;
        // Rounded up. `squared` is at least 1, or not a number if lengths overflowed.
        let radius = (squared.to_bits() - 1.0_f32.to_bits()).div_ceil(1 << RADIUS_SHIFT);
        (radius <= LARGEST_RADIUS && !squared.is_nan()).then_some(radius)
    }
}

fn pack([x, y, z]: [u32; 3], radius: u32) -> u32 {
    x | y << COORDINATE_BITS | z << (2 * COORDINATE_BITS) | radius << (3 * COORDINATE_BITS)
}

/// Unpacks a ball's centre, counted from one cell's side before the corner, and the square of its radius, in quanta.
/// Ignores the highest bit.
#[cfg(test)]
pub(super) fn unpack(ball: u32) -> (Vec3, f32) {
    let coordinate = |axis: u32| (ball >> (axis * COORDINATE_BITS) & 255) as f32;
    let squared = f32::from_bits((ball >> RADIUS_TO_FLOAT & RADIUS) + 1.0_f32.to_bits());
    (Vec3::new(coordinate(0), coordinate(1), coordinate(2)), squared)
}

/// The segment of a ray in a cell, in quanta.
#[derive(Clone, Copy, Debug)]
pub(super) struct PartInCell {
    origin: Vec3,
    direction: Vec3,
    length: f32,
}

impl PartInCell {
    /// Makes the segment from a point, relative to the cell's corner, and a length, both in units of the cell's side.
    pub(super) fn new(from: Vec3, direction: Vec3, length: f32) -> Self {
        Self { origin: (from + 1.0) * QUANTA, direction, length: length * QUANTA }
    }

    /// Returns a mask with a bit for each of four balls, set if the segment meets the ball.
    #[inline]
    pub(super) fn meets_four(&self, balls: &[u32; BALLS_PER_VECTOR]) -> u32 {
        let axis =
            |axis: u32, from: f32| balls.map(|ball| (ball >> (axis * COORDINATE_BITS) & 255) as i32 as f32 - from);
        let (x, y, z) = (axis(0, self.origin.x), axis(1, self.origin.y), axis(2, self.origin.z));
        let mut bits = 0;
        for i in 0..BALLS_PER_VECTOR {
            let v = Vec3::new(x[i], y[i], z[i]);
            let along = v.dot(self.direction);
            let beyond = (along - self.length).max(-along).max(0.0);
            let squared_radius = f32::from_bits((balls[i] >> RADIUS_TO_FLOAT & RADIUS) + 1.0_f32.to_bits());
            let is_met = (v.dot(v) - along * along) + beyond * beyond <= squared_radius;
            bits |= u32::from(is_met) << i;
        }
        bits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spheres of all sizes in and around cells of all sizes: a ball contains its sphere and the margin, or the cell.
    #[test]
    fn a_ball_contains_its_sphere() {
        let mut rng = fastrand::Rng::with_seed(1);
        let mut around_cells = 0;
        for _ in 0..100_000 {
            let size = 2_f32.powi(rng.i32(-50..50));
            let mut up_to = |most: f32| most * rng.f32();
            let corner = Vec3::new(up_to(9.0), up_to(9.0), up_to(9.0)) * size;
            let radius = size * 2_f32.powf(up_to(16.0) - 12.0);
            let spread = 2.0 * (size + radius);
            let center = corner + Vec3::new(up_to(spread), up_to(spread), up_to(spread)) - 0.5 * spread;
            let margin = up_to(0.01 * size);
            let frame = BallFrame::new(corner, size, margin);
            let ball = frame.ball([center.x, center.y, center.z, radius]);
            assert_eq!(ball >> 31, 0);
            let (at, squared) = unpack(ball);
            let quantum = f64::from(size) / f64::from(QUANTA);
            let at = corner.as_dvec3() + (at - QUANTA).as_dvec3() * quantum;
            let reach = f64::from(squared).sqrt() * quantum;
            let needed = (at - center.as_dvec3()).length() + f64::from(radius + margin);
            if reach < needed {
                let middle = corner.as_dvec3() + 0.5 * f64::from(size);
                assert!((at - middle).length() + 0.87 * f64::from(size) < reach);
                around_cells += 1;
            } else if squared > 64.0 {
                // The radius is not larger than needed: half a quantum's diagonal, a sixteenth, and the slack.
                let inside = center.clamp(corner - size, corner + 2.0 * size) == center;
                assert!(!inside || reach < 1.08 * (f64::from(radius + margin) + quantum));
            }
        }
        assert!(around_cells > 100 && around_cells < 50_000, "{around_cells}");
    }

    #[test]
    fn lengths_that_overflow_give_a_ball_around_the_cell() {
        let frame = BallFrame::new(Vec3::ZERO, 1e-38, 0.0);
        let ball = frame.ball([1e30, 0.0, 0.0, 1e38]);
        assert_eq!(ball, pack([128; 3], 127));
    }
}
