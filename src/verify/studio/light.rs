//! The check of light that is added to a surface, and of shadow catchers. The WGSL twins are
//! `shaders/studio/illuminate.wgsl`, `gather.wgsl`, `reflected.wgsl` and `catcher.wgsl`.

use crate::image::color::LUMINANCE;
use crate::light::codes::lamp::{DIRECTIONAL, HEAD, SPHERE};
use crate::recording::lit::{flag, slot};
use crate::verify::lit::kernel::Kernel;
use crate::verify::lit::sampling::{cone_of_sphere, mirrors_brdf, pi};
use crate::verify::number::{Number, Vector};

/// A change of radiance and opacity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    pub(crate) radiance: Vector,
    pub(crate) opacity: Number,
}

impl Change {
    pub(crate) const NONE: Self = Self { radiance: Vector::ZERO, opacity: Number::ZERO };

    pub(crate) fn plus(self, other: Self) -> Self {
        Self { radiance: self.radiance + other.radiance, opacity: self.opacity + other.opacity }
    }

    /// The union of two changes.
    pub(crate) fn union(self, other: Self) -> Self {
        Self { radiance: self.radiance.zip(other.radiance, Number::union), opacity: self.opacity.union(other.opacity) }
    }
}

impl Kernel<'_> {
    /// The light that a lamp adds. `total` is the luminance of all lights on a shadow catcher.
    pub(crate) fn light_added(&mut self, light: u32, is_hidden: bool, total: Number) -> Change {
        if self.is_caught() {
            if !is_hidden {
                return Change::NONE;
            }
            let share = self.central_light(light) / total;
            return self.caught(share);
        }
        if is_hidden {
            return Change::NONE;
        }
        let out = -self.before.vector(slot::DIRECTION);
        let at = light.saturating_mul(3);
        let (toward, strength) = if self.table(at)[3] == HEAD {
            let [r, g, b, _] = self.table_numbers(at.saturating_add(1));
            (out, Vector::recorded([r, g, b]))
        } else {
            let lamp = self.lamp_of_surface(light);
            (lamp.direction, lamp.strength)
        };
        let radiance = strength.times(self.reflected(out, toward));
        Change { radiance, opacity: Number::ZERO }
    }

    /// The light that directions of ambient light add. Some of them are hidden.
    pub(crate) fn ambient_added(&mut self, count: u32, hidden: u32, total: Number) -> Change {
        let lighting = self.lighting();
        let share = Number::ONE / Number::known(lighting.occlusion_samples.max(1).into());
        let hidden_count = Number::known(hidden.into());
        if self.is_caught() {
            let share = share * hidden_count * self.ambient_luminance() / total;
            return self.caught(share);
        }
        let albedo = self.before.vector(slot::ALBEDO);
        // Both are whole numbers.
        let open = Number::known(f64::from(count) - f64::from(hidden));
        let ambient = Vector::recorded(lighting.ambient);
        Change { radiance: albedo.times(ambient) * (share * open), opacity: Number::ZERO }
    }

    /// The light that the surface reflects, for a light of strength 1.
    fn reflected(&mut self, out: Vector, toward: Vector) -> Vector {
        let Vector([share, alpha, _]) = self.before.vector(slot::LOBE);
        let energies = self.before.raw.slots[slot::LOBE][2];
        let normal = self.before.vector(slot::NORMAL);
        let albedo = self.before.vector(slot::ALBEDO);
        let along = normal.dot(toward);
        let cosine = along.max(Number::ZERO);
        let seen = albedo * ((Number::ONE - share) * cosine);
        if share.is_zero() || !self.choices.decide(along.is_above_zero()) {
            return seen;
        }
        let weight = self.before.vector(slot::THROUGHPUT).0[1];
        let half = (out + toward).normalized();
        let least = Number::constant(1e-6);
        let [o, i] = [normal.dot(out).max(least), cosine.max(least)];
        let upright = |z: Number| Vector([Number::ZERO, Number::ZERO, z]);
        let beside = cross(half, normal).fence().squared().sqrt();
        let half = Vector([beside, Number::ZERO, half.dot(normal)]);
        let mirrors = mirrors_brdf(alpha, upright(o), upright(i), half);
        let lobe = share * pi() * mirrors / self.energy(energies, o);
        let shine = weight * lobe;
        seen.map(|c| c + shine)
    }
}

fn cross(Vector([a, b, c]): Vector, Vector([x, y, z]): Vector) -> Vector {
    Vector([b * z - c * y, c * x - a * z, a * y - b * x])
}

fn luminance(color: [f32; 3]) -> Number {
    Vector::recorded(color).dot(Vector(LUMINANCE.map(Number::constant)))
}

impl Kernel<'_> {
    /// Whether the surface is a shadow catcher, of which only shadows are seen.
    pub(crate) fn is_caught(&self) -> bool {
        !self.before.number(slot::ALBEDO).is_zero()
    }

    pub(crate) fn ambient_luminance(&self) -> Number {
        luminance(self.lighting().ambient)
    }

    /// The luminance that the centre of a light contributes to the ground.
    pub(crate) fn central_light(&mut self, light: u32) -> Number {
        let at = light.saturating_mul(3);
        let [x, y, z, _] = self.table_numbers(at);
        let [r, g, b, size] = self.table_numbers(at.saturating_add(1));
        let (place, size) = (Vector::recorded([x, y, z]), Number::recorded(size));
        let kind = self.table(at)[3];
        if kind == HEAD {
            return Number::ZERO;
        }
        let position = self.before.vector(slot::ORIGIN);
        let (axis, strength) = if kind == DIRECTIONAL {
            (place, Number::TWO / (Number::TWO - size))
        } else {
            let toward = place - position;
            let distance = toward.fence().squared().max(Number::constant(1e-30)).sqrt();
            let strength = if kind == SPHERE {
                let is_outside = self.choices.decide(size.is_less(distance));
                let cone = if is_outside { cone_of_sphere(size, distance) } else { Number::TWO };
                Number::TWO * cone
            } else {
                Number::ONE / distance.squared()
            };
            (toward.fence().map(|c| c / distance), strength)
        };
        let normal = Vector::recorded(self.lighting().ground_normal);
        luminance([r, g, b]) * strength * normal.dot(axis).max(Number::ZERO)
    }

    /// The luminance that all lights together contribute, or 1 if there is no light.
    pub(crate) fn light_to_catch(&mut self) -> Number {
        if !self.is_caught() {
            return Number::ONE;
        }
        let lights = 0..self.lighting().light_count;
        let sum = lights.fold(self.ambient_luminance(), |sum, light| sum + self.central_light(light));
        // No term is negative.
        let is_none = if sum.is_zero() { Some(true) } else { sum.is_above_zero().map(|is| !is) };
        if self.choices.decide(is_none) { Number::ONE } else { sum }
    }

    /// The change of radiance and opacity if the ground lacks a share of all light.
    fn caught(&self, share: Number) -> Change {
        let lighting = self.lighting();
        let opacity = self.before.number(slot::ALBEDO) * share;
        let is_transparent = lighting.flags & flag::TRANSPARENT != 0;
        let missing = || -(Vector::recorded(lighting.background) * opacity);
        Change { radiance: if is_transparent { Vector::ZERO } else { missing() }, opacity }
    }
}
