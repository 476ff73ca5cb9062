//! The check of materials and of the GGX distribution. The WGSL twins are `shaders/scene/material.wgsl` and
//! `microfacet.wgsl`.

use super::kernel::Kernel;
use crate::light::codes::material::{CONDUCTOR, DIELECTRIC, EMISSIVE, LAMBERT};
use crate::verify::lit::kernel::Vertex;
use crate::verify::lit::lamp::{disk, pi};
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::Interval;

/// The number of entries of an energy table.
pub(crate) const ENERGIES: u32 = crate::light::energy::ENTRIES as u32;

/// A material in the tables of the device.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Material {
    kind: u32,
    pub(crate) parameter: Number,
    /// The square of the roughness.
    pub(crate) alpha: Number,
    pub(crate) energies: u32,
    pub(crate) absorption: Vector,
}

impl Material {
    pub(crate) fn is_lambert(&self) -> bool {
        self.kind == LAMBERT
    }

    pub(crate) fn is_metal(&self) -> bool {
        self.kind == CONDUCTOR
    }

    pub(crate) fn is_dielectric(&self) -> bool {
        self.kind == DIELECTRIC
    }

    pub(crate) fn is_emissive(&self) -> bool {
        self.kind == EMISSIVE
    }
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
        let entry = |at: u32| {
            Number::recorded(self.table_numbers(first.saturating_add(at >> 2))[(at & 3) as usize])
        };
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
    // Both are bounds; the second includes the rounding errors of the quotient and the difference.
    let error = 8.0 * crate::verify::rounding::U;
    let beyond = Number::between(
        low.max(floor - error * (1.0 + 1.0 / most)),
        high.min(ceiling + error * (1.0 + 1.0 / least)),
    );
    let root = (Number::ONE + alpha.squared() * beyond).max(Number::ZERO).sqrt();
    Number::HALF * (root - Number::ONE)
}

fn ggx_density(alpha: Number, half: Vector) -> Number {
    let Vector([x, y, z]) = half;
    let scaled = Vector([x / alpha, y / alpha, z]);
    let q = scaled.squared();
    Number::ONE / (pi() * alpha.squared() * q.squared())
}

/// A random microfacet normal, of those that are visible from `out`.
pub(crate) fn visible_mirror(
    alpha: Number,
    out: Vector,
    u: [u32; 2],
    choices: &mut crate::verify::choices::Choices,
) -> Vector {
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
    // The cross product of both; the first has no z component.
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
