//! The check of maps from the unit square to directions. The WGSL twins are `shaders/math/warp.wgsl` and `disk.wgsl`.

use std::f64::consts::PI;

use super::kernel::Kernel;
use crate::camera::sampling::unit;
use crate::verify::choices::Choices;
use crate::verify::number::{Number, Vector, sin_cos_eighth};

/// A tangent frame: two unit vectors perpendicular to a third and to each other.
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct Axes {
    x: Vector,
    y: Vector,
    z: Vector,
}

impl Axes {
    pub(in crate::verify) fn to_world(self, v: Vector) -> Vector {
        let Vector([x, y, z]) = v;
        (self.x * x + self.y * y + self.z * z).normalized().fence()
    }

    pub(in crate::verify) fn to_local(self, v: Vector) -> Vector {
        Vector([self.x.dot(v), self.y.dot(v), self.z.dot(v)].map(Number::fence))
    }
}

/// π as a constant of the kernels.
pub(in crate::verify) fn pi() -> Number {
    Number::constant(PI)
}

impl Kernel<'_> {
    pub(in crate::verify) fn axes_around(&mut self, n: Vector) -> Axes {
        axes_around(n, self.choices)
    }
}

pub(in crate::verify) fn axes_around(n: Vector, choices: &mut Choices) -> Axes {
    let Vector([x, y, z]) = n;
    let is_down = choices.decide(z.is_less(Number::ZERO));
    let (s, z) = if is_down {
        (Number::known(-1.0), z.min(Number::ZERO))
    } else {
        (Number::ONE, z.max(Number::ZERO))
    };
    let a = Number::known(-1.0) / (s + z);
    let b = x * y * a;
    Axes {
        x: Vector([Number::ONE + s * x.squared() * a, s * b, -(s * x)]),
        y: Vector([b, s + y.squared() * a, -y]),
        z: n,
    }
}

/// Maps a point of the unit square to the unit disk.
pub(in crate::verify) fn disk(u: [u32; 2]) -> [Number; 2] {
    // The numbers are multiples of 2⁻²³ below 1, so they are exact.
    let [x, y] = u.map(|bits| 2.0 * unit(bits) - 1.0);
    let is_wide = x.abs() > y.abs();
    let (radius, along) = if is_wide { (x, y) } else { (y, x) };
    if radius == 0.0 {
        return [Number::ZERO; 2];
    }
    let radius = Number::known(radius);
    let part = Number::known(along) / radius;
    let angle = Number::known(0.25) * pi() * part;
    let [sine, cosine] = sin_cos_eighth(angle);
    let [x, y] = if is_wide { [cosine, sine] } else { [sine, cosine] };
    [radius * x, radius * y]
}

/// A random direction around z, with the density cosine over π.
pub(in crate::verify) fn cosine_direction(u: [u32; 2]) -> Vector {
    let [x, y] = disk(u);
    let square = x.squared() + y.squared();
    let z = (Number::ONE - square).max(Number::ZERO).sqrt();
    Vector([x, y, z])
}

/// A random direction within an angle of z, uniformly distributed; `k` is 1 minus the cosine of the angle.
pub(in crate::verify) fn cone_direction(u: [u32; 2], k: Number) -> Vector {
    let [x, y] = disk(u);
    let q = (x.squared() + y.squared()) * k;
    let aside = (k * (Number::TWO - q)).max(Number::ZERO).sqrt();
    Vector([x * aside, y * aside, Number::ONE - q])
}

/// The parameter `k` of [`cone_direction`] for a sphere seen from a distance beyond its radius: 1 minus the cosine of
/// its angular radius.
pub(in crate::verify) fn cone_of_sphere(radius: Number, distance: Number) -> Number {
    let square = (radius / distance).squared();
    square / (Number::ONE + (Number::ONE - square).max(Number::ZERO).sqrt())
}
