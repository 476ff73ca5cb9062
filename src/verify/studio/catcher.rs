//! The check of shadow catchers. The WGSL twin is `shaders/studio/catcher.wgsl`.

use crate::image::color::LUMINANCE;
use crate::light::codes::lamp::{DIRECTIONAL, HEAD, SPHERE};
use crate::verify::lit::kernel::Kernel;
use crate::verify::lit::recording::{flag, slot};
use crate::verify::lit::warp::cone_of_sphere;
use crate::verify::number::{Number, Vector};

fn luminance(color: [f32; 3]) -> Number {
    Vector::recorded(color).dot(Vector(LUMINANCE.map(Number::constant)))
}

impl Kernel<'_> {
    /// Whether only shadows are seen of the surface.
    pub(super) fn is_caught(&self) -> bool {
        self.before.number(slot::ALBEDO) > 0.0
    }

    /// The luminance of ambient light.
    pub(super) fn ambient_luminance(&self) -> Number {
        luminance(self.lighting().ambient)
    }

    /// The luminance that the centre of a light contributes to the ground.
    pub(super) fn central_light(&mut self, light: u32) -> Number {
        let at = light.saturating_mul(3);
        let [x, y, z, _] = self.table_numbers(at);
        let [r, g, b, size] = self.table_numbers(at.saturating_add(1));
        let (place, size) = (Vector::recorded([x, y, z]), Number::recorded(size));
        let kind = self.table(at)[3];
        if kind == HEAD {
            return Number::ZERO;
        }
        let position = Vector::recorded(self.before.vector(slot::ORIGIN));
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
    pub(super) fn light_to_catch(&mut self) -> Number {
        if !self.is_caught() {
            return Number::ONE;
        }
        let lights = 0..self.lighting().light_count;
        let sum =
            lights.fold(self.ambient_luminance(), |sum, light| sum + self.central_light(light));
        // No term is negative.
        let is_none = if sum.is_zero() { Some(true) } else { sum.is_above_zero().map(|is| !is) };
        if self.choices.decide(is_none) { Number::ONE } else { sum }
    }

    /// The change of radiance and opacity if a share of all light is missing on the ground.
    pub(super) fn caught(&self, share: Number) -> (Vector, Number) {
        let lighting = self.lighting();
        let alpha = Number::recorded(self.before.number(slot::ALBEDO)) * share;
        if lighting.flags & flag::TRANSPARENT != 0 {
            return (Vector::ZERO, alpha);
        }
        (-(Vector::recorded(lighting.background) * alpha), alpha)
    }
}
