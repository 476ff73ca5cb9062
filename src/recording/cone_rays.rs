//! Rays and cones of all kinds, by which the cone test is tested.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::generate::Uniform;
use crate::geometry::cone::ConeInFrame;
use crate::parallel;

/// Twin: the struct of the same name in `shaders/self_test/cones.wgsl`, as [`ConeAnswer`]. A ray, and the cone that it is
/// tested with.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct RayAndCone {
    /// The ray's origin.
    pub origin: [f32; 3],
    _pad1: u32,
    /// The ray's direction, of unit length up to rounding.
    pub direction: [f32; 3],
    _pad2: u32,
    /// The cone.
    pub cone: ConeInFrame,
}

/// An answer of a device: the unit normal, and the distance, or [`NO_HIT`](crate::recording::NO_HIT).
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct ConeAnswer {
    /// The normal.
    pub normal: [f32; 3],
    /// The distance.
    pub t: f32,
}

/// Random numbers in the order in which they are asked for.
struct Numbers {
    uniform: Uniform,
    index: u64,
    slot: u64,
}

impl Numbers {
    /// A number from 0 to 1.
    fn next(&mut self) -> f64 {
        self.slot += 1;
        self.uniform.number(self.index, self.slot)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// One of some whole numbers from 0.
    fn pick(&mut self, count: u32) -> u32 {
        ((self.next() * f64::from(count)) as u32).min(count - 1)
    }

    /// A power of ten between two exponents.
    fn power(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.between(low, high))
    }

    /// A unit vector, at times along an axis.
    fn direction(&mut self) -> DVec3 {
        if self.pick(6) == 0 {
            let sign = if self.pick(2) == 0 { 1.0 } else { -1.0 };
            return sign * DVec3::AXES[self.pick(3) as usize];
        }
        DVec3::from([0; 3].map(|_| self.between(-1.0, 1.0))).normalize_or(DVec3::X)
    }
}

/// Rays and cones: cylinders, cones with tips, discs and needles with an aspect of up to 10⁴, with closed and open ends;
/// rays along and across the axis, to rims, tips and tangent points, from inside, from the surface and from afar.
#[must_use]
pub fn rays_and_cones(count: usize) -> Vec<RayAndCone> {
    let input = |index| {
        let mut numbers = Numbers { uniform: Uniform::new(3), index: index as u64, slot: 0 };
        let axis = numbers.direction();
        let scale = numbers.power(-3.0, 3.0);
        let length = scale * numbers.power(-2.0, 1.0);
        let largest = (length * numbers.power(-4.0, 2.0)).min(10.0 * scale);
        let radii = match numbers.pick(4) {
            0 | 1 => [largest; 2],
            2 => [largest, 0.0],
            _ => [numbers.between(0.0, largest), largest],
        };
        let start = scale * DVec3::from([0; 3].map(|_| numbers.between(-1.0, 1.0)));
        let end = start + length * axis;
        let signs = [0; 2].map(|_| if numbers.pick(4) == 0 { -1.0 } else { 1.0 });
        let aside = axis.cross(numbers.direction()).normalize_or(axis.any_orthonormal_vector());
        let around = axis.cross(aside);
        // Every other ray goes anywhere, and the others to where answers are open.
        let last = if index % 2 == 0 { 1 } else { 7 };
        let place = if index % 2 == 0 { 4 } else { 0 };
        let along = [0.0, 1.0, 0.5, numbers.next(), numbers.between(-0.2, 1.2)][place.max(numbers.pick(5)) as usize];
        let radius = radii[0] + along * (radii[1] - radii[0]);
        let near = 1.0 + numbers.power(-8.0, -1.0) * if numbers.pick(2) == 0 { 1.0 } else { -1.0 };
        let out = [0.0, 1.0, near, numbers.next(), numbers.between(0.0, 1.5)][place.max(numbers.pick(5)) as usize];
        let target = start + along * length * axis + out * radius * aside;
        let random = numbers.direction();
        let to_tip = (length * axis + (radii[1] - radii[0]) * aside).normalize_or(axis);
        let direction = [random, axis, -axis, around, -aside, to_tip, (axis + 1e-4 * random).normalize_or(axis)]
            [numbers.pick(last) as usize];
        let distance = if numbers.pick(8) == 0 { 0.0 } else { (length + largest) * numbers.power(-2.0, 3.0) };
        let origin = target - distance * direction;
        let narrow = |v: DVec3| v.as_vec3().to_array();
        RayAndCone {
            origin: narrow(origin),
            direction: narrow(direction),
            cone: ConeInFrame {
                start: narrow(start),
                first_radius: (signs[0] * radii[0]) as f32,
                end: narrow(end),
                second_radius: (signs[1] * radii[1]) as f32,
            },
            ..RayAndCone::zeroed()
        }
    };
    parallel::map(count, input)
}
