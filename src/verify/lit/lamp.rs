//! The check of samples of the lights of the settings. The WGSL twin is `shaders/scene/lamp.wgsl`.

use super::kernel::Kernel;
use super::warp::{axes_around, cone_direction, cone_of_sphere};
use crate::light::codes::lamp::{DIRECTIONAL, POINT};
use crate::verify::number::{Number, Vector};
use crate::verify::recording::NO_HIT;

/// A point of a light, seen from a surface.
pub(in crate::verify) struct Lamp {
    pub(in crate::verify) direction: Vector,
    pub(in crate::verify) distance: Number,
    /// The radiance that a white surface facing the light would reflect.
    pub(in crate::verify) strength: Vector,
    /// 1 minus the cosine of the angular radius of a sun; 0 for other lights.
    pub(in crate::verify) sun: Number,
}

impl Kernel<'_> {
    /// The point of a light that `u` chooses. A direction that the kernel fences is narrowed to the recorded one, if
    /// there is one and it is legal.
    pub(in crate::verify) fn lamp(
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
