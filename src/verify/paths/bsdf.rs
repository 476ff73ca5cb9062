//! The check of scattering at surfaces. The WGSL twins are `shaders/path/bsdf.wgsl`, `dielectric.wgsl` and
//! `scatter_light.wgsl`.

use crate::light::codes::material::{CONDUCTOR, DIELECTRIC, LAMBERT};
use crate::verify::lit::kernel::Kernel;
use crate::verify::lit::sampling::{
    ENERGIES, Material, cosine_direction, ggx_lambda, mirrors_brdf, pi, reflected_density, visible_mirror,
};
use crate::verify::number::{Number, Vector};
use crate::verify::paths::kernel::Surface;

/// The BSDF times the cosine, and the density with which the direction is sampled.
pub(crate) struct Reflection {
    pub(crate) value: Vector,
    pub(crate) density: Number,
}

/// A scattered direction in the tangent frame, its weight, and its density.
pub(crate) struct BsdfSample {
    pub(crate) direction: Vector,
    pub(crate) weight: Vector,
    pub(crate) density: Number,
}

/// The density as a divisor: at least 10⁻³⁰.
fn as_divisor(density: Number) -> Number {
    density.max(Number::constant(1e-30))
}

fn schlick(color: Vector, cosine: Number) -> Vector {
    let m = (Number::ONE - cosine).clamp(0.0, 1.0);
    let m2 = m.squared();
    let part = m2.squared() * m;
    color.map(|c| c + (Number::ONE - c) * part)
}

fn compensation(color: Vector, kept: Number) -> Vector {
    let lost = (Number::ONE - kept) / kept;
    color.map(|c| Number::ONE + c * lost)
}

impl Kernel<'_> {
    pub(crate) fn reflect_toward(
        &mut self,
        material: &Material,
        color: Vector,
        out: Vector,
        toward: Vector,
    ) -> Reflection {
        let none = Reflection { value: Vector::ZERO, density: Number::ZERO };
        let (along, back) = (toward.0[2].fence(), out.0[2].fence());
        if material.kind != LAMBERT && material.kind != CONDUCTOR {
            return none;
        }
        if !self.choices.decide(along.is_above_zero()) || !self.choices.decide(back.is_above_zero()) {
            return none;
        }
        // The values after the decisions: cosines are not negative.
        let along = along.max(Number::ZERO);
        let [out, toward] =
            [(out, back.max(Number::ZERO)), (toward, along)].map(|(Vector([x, y, _]), z)| Vector([x, y, z]));
        let is_metal = material.kind == CONDUCTOR;
        let share = if is_metal { Number::ONE } else { material.parameter };
        let matt = (Number::ONE - share) * along / pi();
        if share.is_zero() {
            return Reflection { value: color * matt, density: matt };
        }
        let half = (out + toward).normalized();
        let kept = self.energy(material.energies, out.0[2]);
        let mirrors = mirrors_brdf(material.alpha, out, toward, half);
        let lobe = if is_metal {
            schlick(color, half.dot(out)).times(compensation(color, kept))
        } else {
            Vector::ONE.map(|one| one / kept)
        };
        let matt = if is_metal { Number::ZERO } else { matt };
        let density = matt + share * reflected_density(material.alpha, out, half);
        Reflection { value: color * matt + lobe * (share * mirrors), density }
    }

    pub(crate) fn scatter_light(&mut self, at: &Surface, lobe: Number, u: [u32; 2]) -> BsdfSample {
        let color = Vector::recorded(at.vertex.color);
        let Surface { material, out, .. } = at;
        if material.kind == DIELECTRIC {
            return self.scatter_dielectric(at, lobe, u);
        }
        if self.is_matt {
            let direction = cosine_direction(u);
            let density = direction.0[2] / pi();
            return BsdfSample { direction, weight: color, density };
        }
        let is_metal = material.kind == CONDUCTOR;
        if !is_metal && lobe.is_less(material.parameter) != Some(true) {
            let direction = cosine_direction(u);
            let r = self.reflect_toward(material, color, *out, direction);
            let weight = if material.parameter.is_zero() {
                color
            } else {
                let divisor = as_divisor(r.density);
                r.value.map(|value| value / divisor)
            };
            return self.above(direction, weight, r.density);
        }
        let half = visible_mirror(material.alpha, *out, u, self.choices);
        let direction = half * (Number::TWO * half.dot(*out)) - *out;
        let r = self.reflect_toward(material, color, *out, direction);
        if is_metal {
            let kept = self.energy(material.energies, out.0[2]);
            let seen = Number::ONE + ggx_lambda(material.alpha, out.0[2]);
            let ratio = seen / (seen + ggx_lambda(material.alpha, direction.0[2]));
            let weight = schlick(color, half.dot(*out)).times(compensation(color, kept)) * ratio;
            return self.above(direction, weight, r.density);
        }
        let divisor = as_divisor(r.density);
        BsdfSample { direction, weight: r.value.map(|value| value / divisor), density: r.density }
    }

    /// A sample of the BSDF. Light that is scattered below the surface has no weight.
    fn above(&mut self, direction: Vector, weight: Vector, density: Number) -> BsdfSample {
        let is_above = self.choices.decide(direction.0[2].is_above_zero());
        let weight = if is_above { weight } else { Vector::ZERO };
        BsdfSample { direction, weight, density }
    }

    fn scatter_dielectric(&mut self, at: &Surface, lobe: Number, u: [u32; 2]) -> BsdfSample {
        let Surface { material, out, .. } = at;
        let is_entering = !at.vertex.is_back;
        let relative = if is_entering { material.parameter } else { Number::ONE / material.parameter };
        let is_rough = !material.alpha.is_zero();
        let half = if is_rough {
            visible_mirror(material.alpha, *out, u, self.choices)
        } else {
            Vector([Number::ZERO, Number::ZERO, Number::ONE])
        };
        let cosine = out.dot(half).clamp(0.0, 1.0);
        let share = self.fresnel(relative, cosine);
        let is_reflected = self.choices.decide(lobe.is_less(share));
        let toward = if is_reflected {
            half * (Number::TWO * cosine) - *out
        } else {
            let beyond = beyond(relative, cosine);
            half * (cosine / relative - beyond) - out.map(|c| c / relative)
        };
        let is_up = self.choices.decide(toward.0[2].is_above_zero());
        if is_up != is_reflected {
            return BsdfSample { direction: toward, weight: Vector::ZERO, density: Number::ZERO };
        }
        let weight = if is_rough {
            let first = material.energies + if is_entering { 0 } else { ENERGIES / 4 };
            let kept = self.energy(first, out.0[2]);
            let hidden = Number::ONE + ggx_lambda(material.alpha, toward.0[2].abs());
            Number::ONE / (hidden * kept)
        } else {
            Number::ONE
        };
        BsdfSample { direction: toward, weight: Vector([weight; 3]), density: Number::ZERO }
    }

    /// The fraction of unpolarised light that is reflected.
    fn fresnel(&mut self, relative: Number, cosine: Number) -> Number {
        let sine2 = (Number::ONE - cosine.squared()) / relative.squared();
        if !self.choices.decide(sine2.is_less(Number::ONE)) {
            return Number::ONE;
        }
        let beyond = (Number::ONE - sine2).max(Number::ZERO).sqrt();
        let behind = relative * beyond;
        let across = (cosine - behind) / (cosine + behind);
        let ahead = relative * cosine;
        let along = (ahead - beyond) / (ahead + beyond);
        let whole = Number::HALF * (across.squared() + along.squared());
        // The fraction is at most 1, apart from rounding.
        whole.min(Number::known(1.0 + 1e-4))
    }
}

/// The cosine of the refracted direction.
fn beyond(relative: Number, cosine: Number) -> Number {
    let sine2 = (Number::ONE - cosine.squared()) / relative.squared();
    (Number::ONE - sine2).max(Number::ZERO).sqrt()
}
