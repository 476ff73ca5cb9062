//! The check whether light is hidden from a surface. The WGSL twins are `shaders/studio/hidden_light.wgsl`,
//! `shadow.wgsl` and `ambient.wgsl`. Rays towards lights are not stored. The start of such a ray is known exactly, and
//! its direction up to an error.

use glam::DVec3;

use crate::geometry::math::wide;
use crate::light::codes::lamp::HEAD;
use crate::recording::lit::{flag, slot};
use crate::scene::Shape;
use crate::verify::camera::{BoxCrossing, SMALLEST_COMPONENT, SlabCrossing};
use crate::verify::hit::{Candidates, shape_of};
use crate::verify::lit::kernel::Kernel;
use crate::verify::lit::sampling::{Lamp, axes_around, cosine_direction};
use crate::verify::lit::search::{Entry, Obstacle, Role, is_same};
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::{DIVIDE, FLUSH, Interval, PAD, U, gamma};
use crate::verify::sphere::{Line, Slack};

/// The first pair of random numbers of a surface. `shaders/studio/shadow.wgsl` has the same numbers.
pub(crate) const PAIRS: u32 = 4096;

impl Kernel<'_> {
    /// Whether this light needs a search: lamps at the eye do not.
    pub(crate) fn casts_shadow(&self, light: u32) -> bool {
        self.lighting().flags & flag::SHADOWS != 0 && self.table(light.saturating_mul(3))[3] != HEAD
    }

    /// The point of a light that is chosen for this surface.
    pub(crate) fn lamp_of_surface(&mut self, light: u32) -> Lamp {
        let number = 2 + PAIRS.wrapping_mul(self.address.surface).wrapping_add(light);
        let u = self.numbers(self.address.sample, number);
        let position = self.before.vector(slot::ORIGIN);
        self.lamp(light, position, u, None)
    }

    /// Whether a light is hidden from the surface. A light behind the surface is not searched for.
    pub(crate) fn is_light_hidden(&mut self, candidates: &Candidates, light: u32) -> Obstacle {
        let Lamp { direction, distance, .. } = self.lamp_of_surface(light);
        let normal = self.before.vector(slot::NORMAL);
        if !self.choices.decide(normal.dot(direction).is_above_zero()) {
            return Obstacle::NEVER;
        }
        self.is_hidden(candidates, direction, distance)
    }

    /// Whether a shape is near in a direction of ambient light.
    pub(crate) fn is_direction_hidden(&mut self, candidates: &Candidates, index: u32) -> Obstacle {
        let lighting = self.lighting();
        let sample = self.address.sample.wrapping_mul(lighting.occlusion_samples).wrapping_add(index);
        let number = 2 + PAIRS.wrapping_mul(self.address.surface).wrapping_add(PAIRS - 1);
        let u = self.numbers(sample, number);
        let normal = self.before.vector(slot::NORMAL);
        let direction = axes_around(normal, self.choices).to_world(cosine_direction(u));
        self.is_hidden(candidates, direction, Number::recorded(lighting.occlusion_radius))
    }

    fn is_hidden(&mut self, candidates: &Candidates, direction: Vector, distance: Number) -> Obstacle {
        let state = self.before;
        if state.has(flag::BACK) {
            let radius = state.number(slot::DEPARTURE);
            let to_center = state.vector(slot::NORMAL) * radius;
            let to_far_side = (Number::TWO * to_center.dot(direction)).max(Number::ZERO);
            if self.choices.decide(to_far_side.is_less(distance)) {
                return Obstacle::ALWAYS;
            }
        }
        if !state.has(flag::ON_GROUND) {
            let origin = state.vector(slot::ORIGIN);
            let ground = self.ground_distance(origin, direction, Number::ZERO);
            if ground.is_some_and(|t| self.choices.decide(t.is_less(distance))) {
                return Obstacle::ALWAYS;
            }
        }
        self.is_occluded(candidates, direction, distance)
    }

    /// Whether an opaque shape, other than the shape of the surface, is nearer than a distance. Of a cone that is seen from
    /// inside, the far side is searched.
    fn is_occluded(&self, candidates: &Candidates, toward: Vector, distance: Number) -> Obstacle {
        let (scene, state) = (self.scene, self.before);
        let corners = self.inputs.occluders.map(wide);
        let Some(ray) = Entry::aimed(corners, state.vector(slot::ORIGIN), toward) else {
            return Obstacle { must: false, ..Obstacle::ALWAYS };
        };
        let departed = shape_of(scene, state.raw.departure().id);
        let are_opaque = scene.is_opaque();
        ray.hidden(candidates, distance, |id, shape| match shape {
            _ if !are_opaque && scene.surface(id).opacity < 1.0 => Role::Exempt,
            _ if departed.is_none_or(|own| !is_same(shape, own)) => Role::Occluder,
            Shape::Cone(_) if state.has(flag::BACK) => Role::FarSide,
            _ => Role::Exempt,
        })
    }
}

/// The largest error of a direction. Above it, the search is undecided.
const MOST_TURNED: f64 = 0.01;

/// The largest distance of a box. Above it, the search is undecided. All lengths are smaller.
const MOST_DISTANT: f64 = 1e30;

impl Entry {
    /// All rays from a point in a direction; `None` if the direction, or the entry into the box, is hardly known.
    pub(crate) fn aimed([low, high]: [DVec3; 2], origin: Vector, direction: Vector) -> Option<Self> {
        let axes = direction.intervals();
        let [(origin, displaced), (middle, half)] = [origin, direction].map(Vector::ball);
        // The middle has the error of an addition in f64.
        let turned = PAD * half.length() + 4.0 * f64::EPSILON * middle.length();
        // This is also false for NaN.
        let is_known = turned <= MOST_TURNED;
        if !is_known {
            return None;
        }
        let mut crossing = BoxCrossing::UNBOUNDED;
        for axis in 0..3 {
            // Planes that are displaced instead of the origin, both ways.
            let planes = |sign: f64| [low[axis], high[axis]].map(|plane| plane + sign * displaced[axis]);
            let [one, other] = [-1.0, 1.0].map(|sign| slab(planes(sign), origin[axis], axes[axis]));
            crossing.cut(if displaced[axis] > 0.0 { one.or(other) } else { one });
        }
        let BoxCrossing { enter, leave } = crossing;
        if enter.high > MOST_DISTANT {
            return None;
        }
        // The squared length of the device's direction d', which has about unit length and is within `turned` of the
        // middle d, differs from that of d by at most 2 turned + turned². Searches of the checker widen boxes by twice
        // the bend times the longest vector, which is more than the ray is displaced.
        let mut line = Line::exact(origin, middle);
        line.bend += 2.5 * turned;
        let (may_hit_box, may_miss_box) = (enter.low <= leave.high, enter.high > leave.low);
        let displaced = PAD * displaced.length();
        let (mut across, mut along) = (displaced, displaced);
        if enter.high > 0.0 {
            let start = 0.5 * (enter.low + enter.high);
            let moved = start * middle;
            // The error of the start: two roundings of a product and a sum, and the error of the direction.
            let rounded = PAD * gamma(6) * (origin.abs() + moved.abs()) + DVec3::splat(2.0 * FLUSH);
            across += rounded.length() + PAD * enter.high * turned;
            along = across + enter.high - start;
            line.origin = origin + moved;
        }
        let slack = Slack { across, along, direction: turned };
        Some(Self { line, slack, enter, may_hit_box, may_miss_box })
    }
}

/// The distances at which a ray meets the planes that bound a box along an axis: the nearer and the farther one.
fn slab([low, high]: [f64; 2], origin: f64, direction: Interval) -> SlabCrossing {
    let sizes = [direction.low.abs(), direction.high.abs()].map(|size| size.max(SMALLEST_COMPONENT));
    let is_positive = direction.low >= 0.0;
    if !is_positive && direction.high >= 0.0 {
        // The sign of the direction is unknown. From between the planes, one of them lies behind and one ahead.
        let is_between = low < origin && origin < high;
        let nearest = (origin - low).min(high - origin) / sizes[0].max(sizes[1]);
        let everything = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
        return if is_between {
            let behind = Interval { low: f64::NEG_INFINITY, high: 0.0 };
            SlabCrossing { near: behind, far: Interval { low: nearest * (1.0 - 8.0 * U), high: f64::INFINITY } }
        } else {
            SlabCrossing { near: everything, far: everything }
        };
    }
    let [least, most] = [sizes[0].min(sizes[1]), sizes[0].max(sizes[1])];
    let sign = if is_positive { 1.0 } else { -1.0 };
    let plane = |plane: f64| {
        let away = sign * (plane - origin);
        let ends = [away / least, away / most];
        let [a, b] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        // Errors of the difference, the reciprocal of the direction and their product.
        let error = |end: f64| PAD * (DIVIDE + 5.0 * U) * end.abs() + 2.0 * FLUSH / least + FLUSH;
        Interval { low: a - error(a), high: b + error(b) }
    };
    SlabCrossing::between(plane(low), plane(high))
}
