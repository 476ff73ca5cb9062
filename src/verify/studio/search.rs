//! The check of whether light is hidden from a surface. The WGSL twins are `shaders/studio/hidden_light.wgsl`,
//! `shadow.wgsl` and `ambient.wgsl`.

use super::occlusion::Aimed;
use crate::geometry::math::wide;
use crate::light::codes::lamp::HEAD;
use crate::verify::candidates::Candidates;
use crate::verify::hit::legal_hit;
use crate::verify::lit::alternatives::Doubts;
use crate::verify::lit::kernel::Kernel;
use crate::verify::lit::lamp::Lamp;
use crate::verify::lit::recording::{flag, slot};
use crate::verify::lit::search::{hides, is_same};
use crate::verify::lit::warp::{axes_around, cosine_direction};
use crate::verify::number::{Number, Vector};

/// Whether light may be hidden, and whether it must be.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Hidden {
    pub(super) may: bool,
    pub(super) must: bool,
    /// The spheres that may hide it and need not.
    pub(super) doubts: Doubts,
}

impl Hidden {
    pub(super) const NEVER: Self = Self { may: false, must: false, doubts: Doubts::NONE };
    const ALWAYS: Self = Self { may: true, must: true, doubts: Doubts::NONE };

    /// The answers to several questions of which one is asked.
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            may: self.may || other.may,
            must: self.must && other.must,
            doubts: self.doubts.and(other.doubts),
        }
    }
}

/// The first pair of random numbers of a surface. `shaders/studio/shadow.wgsl` has the same numbers.
pub(super) const PAIRS: u32 = 4096;

impl Kernel<'_> {
    /// Whether lights of this kind are searched for.
    pub(super) fn casts_shadow(&self, light: u32) -> bool {
        self.lighting().flags & flag::SHADOWS != 0 && self.table(light.saturating_mul(3))[3] != HEAD
    }

    /// The point of a light, as it is chosen for this surface.
    pub(super) fn lamp_of_surface(&mut self, light: u32) -> Lamp {
        let number = 2 + PAIRS.wrapping_mul(self.address.surface).wrapping_add(light);
        let u = self.numbers(self.address.sample, number);
        let position = Vector::recorded(self.before.vector(slot::ORIGIN));
        self.lamp(light, position, u, None)
    }

    /// A pair of random numbers of the pixel.
    fn numbers(&self, sample: u32, number: u32) -> [u32; 2] {
        use crate::camera::sampling::{pair, pixel_seed};
        pair(pixel_seed(self.address.pixel, self.lighting().seed), sample, number)
    }

    /// Whether a light is hidden from the surface; a light behind it is not searched for.
    pub(super) fn is_light_hidden(&mut self, candidates: &Candidates, light: u32) -> Hidden {
        let Lamp { direction, distance, .. } = self.lamp_of_surface(light);
        let normal = Vector::recorded(self.before.vector(slot::NORMAL));
        if !self.choices.decide(normal.dot(direction).is_above_zero()) {
            return Hidden::NEVER;
        }
        self.is_hidden(candidates, direction, distance)
    }

    /// Whether something is near in a direction of ambient light.
    pub(super) fn is_direction_hidden(&mut self, candidates: &Candidates, index: u32) -> Hidden {
        let lighting = self.lighting();
        let sample =
            self.address.sample.wrapping_mul(lighting.occlusion_samples).wrapping_add(index);
        let number = 2 + PAIRS.wrapping_mul(self.address.surface).wrapping_add(PAIRS - 1);
        let u = self.numbers(sample, number);
        let normal = Vector::recorded(self.before.vector(slot::NORMAL));
        let direction = axes_around(normal, self.choices).to_world(cosine_direction(u));
        self.is_hidden(candidates, direction, Number::recorded(lighting.occlusion_radius))
    }

    fn is_hidden(
        &mut self,
        candidates: &Candidates,
        direction: Vector,
        distance: Number,
    ) -> Hidden {
        let state = self.before;
        if state.has(flag::BACK) {
            let radius = Number::recorded(f32::from_bits(state.departure().emitter));
            let to_center = Vector::recorded(state.vector(slot::NORMAL)) * radius;
            let to_far_side = (Number::TWO * to_center.dot(direction)).max(Number::ZERO);
            if self.choices.decide(to_far_side.is_less(distance)) {
                return Hidden::ALWAYS;
            }
        }
        if !state.has(flag::ON_GROUND) {
            let origin = Vector::recorded(state.vector(slot::ORIGIN));
            let ground = self.ground_distance(origin, direction, Number::ZERO);
            if ground.is_some_and(|t| self.choices.decide(t.is_less(distance))) {
                return Hidden::ALWAYS;
            }
        }
        self.is_occluded(candidates, direction, distance)
    }

    /// Whether an opaque sphere other than that of the surface is nearer than a distance.
    fn is_occluded(&self, candidates: &Candidates, direction: Vector, distance: Number) -> Hidden {
        let (scene, state) = (self.scene, self.before);
        let corners = self.inputs.occluders.map(wide);
        let Some(ray) = Aimed::new(corners, wide(state.vector(slot::ORIGIN)), direction) else {
            return Hidden { must: false, ..Hidden::ALWAYS };
        };
        let rest = (distance - Number::between(ray.enter.low, ray.enter.high)).interval();
        if !ray.may_hit_box || rest.high <= 0.0 {
            return Hidden::NEVER;
        }
        let departed = scene.spheres().get(state.departure().id as usize);
        let are_opaque = scene.is_opaque();
        let mut found = Hidden::NEVER;
        let moved = ray.slack.across + ray.slack.along;
        candidates.visit(&ray.line, moved, rest.high, |candidate| {
            let is_own = departed.is_some_and(|own| is_same(candidate.sphere, *own));
            if is_own || !(are_opaque || scene.surface(candidate.id).opacity >= 1.0) {
                return rest.high;
            }
            if let Some((hit, may_miss)) = legal_hit(candidate, &ray.line, ray.slack) {
                let (may, must) = hides(&hit, may_miss, rest);
                found.may |= may;
                found.must |= must;
                if may && !must {
                    found.doubts.add(candidate, &ray.line, may_miss);
                }
            }
            // A certain answer ends the search.
            if found.must { -1.0 } else { rest.high }
        });
        found.must &= !ray.may_miss_box && rest.low > 0.0;
        found
    }
}
