//! Rays towards lights, which are not stored. Where such a ray starts is known exactly, its direction up to an error.

use glam::DVec3;

use crate::verify::line::Line;
use crate::verify::number::Vector;
use crate::verify::rounding::{DIVIDE, FLUSH, Interval, PAD, U, gamma};
use crate::verify::sphere::Slack;

/// The same constant as in `shaders/scene/enter.wgsl`.
const SMALLEST_COMPONENT: f64 = 1.0 / (1_u64 << 40) as f64;

/// The largest error of a direction, above which nothing is said.
const MOST_TURNED: f64 = 0.01;

/// The largest distance of a box, above which nothing is said. All lengths are smaller.
const MOST_DISTANT: f64 = 1e30;

/// A ray that starts where it enters the box of the spheres that cast shadows.
pub(super) struct Aimed {
    pub(super) line: Line,
    pub(super) slack: Slack,
    /// The distance at which the ray enters the box.
    pub(super) enter: Interval,
    /// Whether the device may find that the ray hits the box, and whether it may find that it does not.
    pub(super) may_hit_box: bool,
    pub(super) may_miss_box: bool,
}

impl Aimed {
    /// All rays from a point in a direction; `None` if the direction is hardly known, or where they enter the box.
    pub(super) fn new([low, high]: [DVec3; 2], origin: DVec3, direction: Vector) -> Option<Self> {
        let axes = direction.intervals();
        let middle = DVec3::from(axes.map(|axis| 0.5 * (axis.low + axis.high)));
        let half = DVec3::from(axes.map(|axis| 0.5 * (axis.high - axis.low)));
        // The error of the middle is that of an addition in f64.
        let turned = PAD * half.length() + 4.0 * f64::EPSILON * middle.length();
        // False also for NaN.
        let is_known = turned <= MOST_TURNED;
        if !is_known {
            return None;
        }
        let mut enter = Interval { low: 0.0, high: 0.0 };
        let mut leave = Interval { low: f64::INFINITY, high: f64::INFINITY };
        for axis in 0..3 {
            let [near, far] = slab([low[axis], high[axis]], origin[axis], axes[axis]);
            enter = Interval { low: enter.low.max(near.low), high: enter.high.max(near.high) };
            leave = Interval { low: leave.low.min(far.low), high: leave.high.min(far.high) };
        }
        if enter.high > MOST_DISTANT {
            return None;
        }
        // The squared length of the device's direction d', which has about unit length and is within `turned` of the
        // middle d, is off by no more than that of d by 2 turned + turned². Searches of the checker widen boxes by
        // twice the bend times the longest vector, which is therefore more than the ray is beside.
        let mut line = Line::exact(origin, middle);
        line.bend += 2.5 * turned;
        let (may_hit_box, may_miss_box) = (enter.low <= leave.high, enter.high > leave.low);
        let (mut across, mut along) = (0.0, 0.0);
        if enter.high > 0.0 {
            let start = 0.5 * (enter.low + enter.high);
            let moved = start * middle;
            // The error of the start: two roundings of a product and a sum, and the error of the direction.
            let rounded = PAD * gamma(6) * (origin.abs() + moved.abs()) + DVec3::splat(2.0 * FLUSH);
            across = rounded.length() + PAD * enter.high * turned;
            along = across + enter.high - start;
            line.origin = origin + moved;
        }
        let slack = Slack { across, along, direction: turned };
        Some(Self { line, slack, enter, may_hit_box, may_miss_box })
    }
}

/// The distances at which a ray meets the planes that bound a box along an axis: the nearer and the farther one.
fn slab([low, high]: [f64; 2], origin: f64, direction: Interval) -> [Interval; 2] {
    let sizes =
        [direction.low.abs(), direction.high.abs()].map(|size| size.max(SMALLEST_COMPONENT));
    let is_positive = direction.low >= 0.0;
    if !is_positive && direction.high >= 0.0 {
        // The sign of the direction is unknown. From between the planes one of them lies behind and one ahead.
        let is_between = low < origin && origin < high;
        let nearest = (origin - low).min(high - origin) / sizes[0].max(sizes[1]);
        let everything = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
        return if is_between {
            let behind = Interval { low: f64::NEG_INFINITY, high: 0.0 };
            [behind, Interval { low: nearest * (1.0 - 8.0 * U), high: f64::INFINITY }]
        } else {
            [everything; 2]
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
    let [a, b] = [plane(low), plane(high)];
    let near = Interval { low: a.low.min(b.low), high: a.high.min(b.high) };
    let far = Interval { low: a.low.max(b.low), high: a.high.max(b.high) };
    [near, far]
}
