//! The check of maps from the unit square to directions, and of samples of the lights of the settings. The WGSL twins are
//! `shaders/math/warp.wgsl`, `math/disk.wgsl` and `scene/lamp.wgsl`.

use std::f64::consts::PI;

use crate::camera::sampling::unit;
use crate::light::codes::lamp::{DIRECTIONAL, POINT};
use crate::verify::choices::Choices;
use crate::verify::lit::kernel::Kernel;
use crate::verify::number::{Number, Vector, sin_cos_eighth};
use crate::verify::recording::NO_HIT;

/// A tangent frame: two unit vectors perpendicular to a third and to each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axes {
    x: Vector,
    y: Vector,
    z: Vector,
}

impl Axes {
    pub(crate) fn to_world(self, v: Vector) -> Vector {
        let Vector([x, y, z]) = v;
        (self.x * x + self.y * y + self.z * z).normalized().fence()
    }

    pub(crate) fn to_local(self, v: Vector) -> Vector {
        Vector([self.x.dot(v), self.y.dot(v), self.z.dot(v)].map(Number::fence))
    }
}

/// π as a constant of the kernels.
pub(crate) fn pi() -> Number {
    Number::constant(PI)
}

pub(crate) fn axes_around(n: Vector, choices: &mut Choices) -> Axes {
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
pub(crate) fn disk(u: [u32; 2]) -> [Number; 2] {
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
pub(crate) fn cosine_direction(u: [u32; 2]) -> Vector {
    let [x, y] = disk(u);
    let square = x.squared() + y.squared();
    let z = (Number::ONE - square).max(Number::ZERO).sqrt();
    Vector([x, y, z])
}

/// A random direction within an angle of z, uniformly distributed; `k` is 1 minus the cosine of the angle.
pub(crate) fn cone_direction(u: [u32; 2], k: Number) -> Vector {
    let [x, y] = disk(u);
    let q = (x.squared() + y.squared()) * k;
    let aside = (k * (Number::TWO - q)).max(Number::ZERO).sqrt();
    Vector([x * aside, y * aside, Number::ONE - q])
}

/// The parameter `k` of [`cone_direction`] for a sphere seen from a distance beyond its radius: 1 minus the cosine of
/// its angular radius.
pub(crate) fn cone_of_sphere(radius: Number, distance: Number) -> Number {
    let square = (radius / distance).squared();
    square / (Number::ONE + (Number::ONE - square).max(Number::ZERO).sqrt())
}

/// A point of a light, seen from a surface.
pub(crate) struct Lamp {
    pub(crate) direction: Vector,
    pub(crate) distance: Number,
    /// The radiance that a white surface facing the light would reflect.
    pub(crate) strength: Vector,
    /// 1 minus the cosine of the angular radius of a sun; 0 for other lights.
    pub(crate) sun: Number,
}

impl Kernel<'_> {
    /// The point of a light that `u` chooses. A direction that the kernel fences is narrowed to the recorded one, if
    /// there is one and it is legal.
    pub(crate) fn lamp(
        &mut self,
        light: u32,
        position: Vector,
        u: [u32; 2],
        recorded: Option<Vector>,
    ) -> Lamp {
        let at = light.saturating_mul(3);
        let [x, y, z, _] = self.table_numbers(at);
        let position_of_light = Vector::recorded([x, y, z]);
        let [r, g, b, size] = self.table_numbers(at.saturating_add(1));
        let (power, size) = (Vector::recorded([r, g, b]), Number::recorded(size));
        let kind = self.table(at)[3];
        let narrowed = |direction: Vector| match recorded {
            Some(recorded) => direction.zip(recorded, Number::narrowed),
            None => direction,
        };
        if kind == DIRECTIONAL {
            let direction =
                axes_around(position_of_light, self.choices).to_world(cone_direction(u, size));
            let strength = power * (Number::TWO / (Number::TWO - size));
            let distance = Number::known(NO_HIT.into());
            return Lamp { direction: narrowed(direction), distance, strength, sun: size };
        }
        let toward = position_of_light - position;
        let distance = toward.fence().squared().sqrt();
        let axis = toward.fence().map(|c| c / distance.max(Number::constant(1e-30)));
        if kind == POINT {
            let square = distance.squared().max(Number::constant(1e-30));
            let strength = power.map(|p| p / square);
            return Lamp { direction: axis, distance, strength, sun: Number::ZERO };
        }
        let is_outside = self.choices.decide(size.is_less(distance));
        let (k, around) = if is_outside {
            (cone_of_sphere(size, distance), axis)
        } else {
            (Number::TWO, Vector([Number::ZERO, Number::ZERO, Number::ONE]))
        };
        let direction = axes_around(around, self.choices).to_world(cone_direction(u, k));
        let direction = narrowed(direction);
        let middle = toward.dot(direction);
        let foot = toward - direction * middle;
        let chord = (size.squared() - foot.squared()).max(Number::ZERO).sqrt();
        let side = if is_outside { middle - chord } else { middle + chord };
        let distance = side.max(Number::ZERO);
        Lamp { direction, distance, strength: power * (Number::TWO * k), sun: Number::ZERO }
    }
}
