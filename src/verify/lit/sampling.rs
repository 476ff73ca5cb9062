//! The check of sampled quantities: directions, points of the lights of the settings, and microfacets of
//! materials. The WGSL twins are `shaders/math/warp.wgsl`, `math/disk.wgsl`, `scene/lamp.wgsl`,
//! `scene/material.wgsl` and `path/microfacet.wgsl`.

use std::f64::consts::PI;

use crate::camera::sampling::unit;
use crate::light::codes::lamp::{DIRECTIONAL, POINT};
use crate::recording::NO_HIT;
use crate::verify::choices::Choices;
use crate::verify::lit::kernel::{Kernel, Vertex};
use crate::verify::number::{Number, Vector, sin_cos_eighth};
use crate::verify::rounding::Interval;

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
    let (s, z) = if is_down { (Number::known(-1.0), z.min(Number::ZERO)) } else { (Number::ONE, z.max(Number::ZERO)) };
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

/// A random direction within an angle of z, uniformly distributed. `k` is 1 minus the cosine of the angle.
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
    /// The point of the light that `u` chooses. If the kernel fences the direction, it is narrowed to the recorded
    /// direction, if there is one and it is legal.
    pub(crate) fn lamp(&mut self, light: u32, position: Vector, u: [u32; 2], recorded: Option<Vector>) -> Lamp {
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
            let direction = axes_around(position_of_light, self.choices).to_world(cone_direction(u, size));
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

/// The number of entries of an energy table.
pub(crate) const ENERGIES: u32 = crate::light::energy::ENTRIES as u32;

/// A material in the tables of the device.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Material {
    /// One of the [codes](crate::light::codes::material).
    pub(crate) kind: u32,
    pub(crate) parameter: Number,
    /// The square of the roughness.
    pub(crate) alpha: Number,
    pub(crate) energies: u32,
    pub(crate) absorption: Vector,
}

/// The last index of an energy table.
const LAST: f64 = (ENERGIES - 1) as f64;

impl Kernel<'_> {
    pub(crate) fn material_of(&self, vertex: &Vertex) -> Material {
        let at = self.lighting().material_first.saturating_add(2 * vertex.material_index);
        let [kind, _, _, energies] = self.table(at);
        let [_, parameter, alpha, _] = self.table_numbers(at);
        let [x, y, z, _] = self.table_numbers(at.saturating_add(1));
        Material {
            kind,
            parameter: Number::recorded(parameter),
            alpha: Number::recorded(alpha),
            energies,
            absorption: Vector::recorded([x, y, z]),
        }
    }

    /// The energy that a lobe keeps at a cosine. The interpolation is continuous, so all entries that the interval of
    /// the cosine may select are joined.
    pub(crate) fn energy(&self, first: u32, cosine: Number) -> Number {
        let along = cosine.clamp(0.0, 1.0).sqrt().sqrt() * Number::known(LAST);
        let Interval { low, high } = along.interval();
        let index = |x: f64| x.clamp(0.0, LAST - 1.0) as u32;
        let entry = |at: u32| Number::recorded(self.table_numbers(first.saturating_add(at >> 2))[(at & 3) as usize]);
        (index(low)..=index(high))
            .map(|below| {
                let (a, b) = (entry(below), entry(below + 1));
                let within = Number::between(
                    low.max(below.into()),
                    if below + 2 == ENERGIES { high } else { high.min(f64::from(below) + 1.0) },
                );
                a + (within - Number::known(below.into())) * (b - a)
            })
            .reduce(Number::union)
            .unwrap_or(Number::ONE)
    }
}

/// Smith's Λ of the GGX distribution at a cosine.
pub(crate) fn ggx_lambda(alpha: Number, cosine: Number) -> Number {
    let c2 = cosine.squared().max(Number::constant(1e-12));
    // Not negative, because c2 is at most 1 apart from rounding. The quotient is monotonic in the cosine.
    let beyond = (Number::ONE - c2) / c2;
    let Interval { low, high } = beyond.interval();
    let Interval { low: least, high: most } = c2.interval();
    let exact = Number::between(1.0 / most - 1.0, 1.0 / least - 1.0);
    let Interval { low: floor, high: ceiling } = exact.interval();
    // Both are bounds. The second includes the rounding errors of the quotient and the difference.
    let error = 8.0 * crate::verify::rounding::U;
    let beyond =
        Number::between(low.max(floor - error * (1.0 + 1.0 / most)), high.min(ceiling + error * (1.0 + 1.0 / least)));
    let root = (Number::ONE + alpha.squared() * beyond).max(Number::ZERO).sqrt();
    Number::HALF * (root - Number::ONE)
}

fn ggx_density(alpha: Number, half: Vector) -> Number {
    let Vector([x, y, z]) = half;
    let scaled = Vector([x / alpha, y / alpha, z]);
    let q = scaled.squared();
    Number::ONE / (pi() * alpha.squared() * q.squared())
}

/// A random microfacet normal that is visible from `out`.
pub(crate) fn visible_mirror(alpha: Number, out: Vector, u: [u32; 2], choices: &mut Choices) -> Vector {
    let Vector([x, y, z]) = out;
    let stretched = Vector([alpha * x, alpha * y, z]).normalized();
    let Vector([x, y, z]) = stretched;
    let across = x.squared() + y.squared();
    let is_aside = choices.decide(across.is_more(Number::constant(1e-12)));
    let first = if is_aside {
        let length = across.max(Number::constant(1e-12)).sqrt();
        Vector([-y / length, x / length, Number::ZERO]).map(|c| c.clamp(-1.00001, 1.00001))
    } else {
        Vector([Number::ONE, Number::ZERO, Number::ZERO])
    };
    let Vector([a, b, _]) = first;
    // The cross product of both. The first has no z component.
    let second = Vector([-(z * b), z * a, x * b - y * a]);
    let [p, down] = disk(u);
    let s = Number::HALF * (Number::ONE + z);
    let q = (Number::ONE - s) * (Number::ONE - p.squared()).max(Number::ZERO).sqrt() + s * down;
    let up = (Number::ONE - p.squared() - q.squared()).max(Number::ZERO).sqrt();
    let Vector([x, y, z]) = first * p + second * q + stretched * up;
    Vector([alpha * x, alpha * y, z.max(Number::constant(1e-6))]).normalized()
}

/// The density of directions that are reflected at visible microfacet normals.
pub(crate) fn reflected_density(alpha: Number, out: Vector, half: Vector) -> Number {
    let z = out.0[2];
    let seen = Number::ONE / (Number::ONE + ggx_lambda(alpha, z));
    seen * ggx_density(alpha, half) / (Number::known(4.0) * z)
}

/// The BRDF of a white rough mirror, times the cosine.
pub(crate) fn mirrors_brdf(alpha: Number, out: Vector, toward: Vector, half: Vector) -> Number {
    let (z, along) = (out.0[2], toward.0[2]);
    let both = Number::ONE / (Number::ONE + ggx_lambda(alpha, z) + ggx_lambda(alpha, along));
    both * ggx_density(alpha, half) / (Number::known(4.0) * z)
}
