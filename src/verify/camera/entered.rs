//! The point where a camera's ray enters the scene's box, and bounds of a device's error. For results whose ray was not
//! recorded, all rays that a device may compute for a pixel. The WGSL twin is `shaders/scene/enter.wgsl`.

use glam::DVec3;

use crate::recording::TracedRay;
use crate::verify::camera::{CameraModel, CameraRay, around};
use crate::verify::certificate::{AXES, Mismatch, legal_is};
use crate::verify::hit::{Candidates, LegalHits};
use crate::verify::rounding::{DIVIDE, FLUSH, Interval, PAD, U, gamma};
use crate::verify::sphere::{Line, Slack};

/// The smallest magnitude of a direction's component, as in `shaders/scene/enter.wgsl`.
pub(crate) const SMALLEST_COMPONENT: f64 = 1.0 / (1_u64 << 40) as f64;

impl CameraModel {
    /// A ray's entry and exit at the scene's box, for all origins within their error bounds and all directions within
    /// `turned`, each axis by itself.
    fn slabs(&self, ray: &CameraRay, direction: DVec3, turned: DVec3) -> BoxCrossing {
        let mut crossing = BoxCrossing::UNBOUNDED;
        for axis in 0..3 {
            let (d, error) = (direction[axis], turned[axis]);
            let least = (d.abs() - error).max(SMALLEST_COMPONENT);
            let most = (d.abs() + error).max(SMALLEST_COMPONENT);
            let crossed = |sign: f64| {
                // The reciprocal of the component.
                let inverses = [sign / least, sign / most];
                let plane = |plane: f64| {
                    let away = plane - ray.line.origin[axis];
                    // Errors of the difference, the reciprocal of the direction and their product, with the three terms in
                    // any order.
                    let moved = ray.origin_error[axis] * (1.0 + 5.0 * U) + U * away.abs();
                    let error = moved / least + (DIVIDE + 3.0 * U) * away.abs() / least;
                    let [one, other] = inverses.map(|inverse| away * inverse);
                    Interval::between(one, other, PAD * error + FLUSH / least + FLUSH)
                };
                SlabCrossing::between(plane(self.scene_min[axis]), plane(self.scene_max[axis]))
            };
            // A small component may have either sign, which is the same for both planes.
            let sign = if d < 0.0 { -1.0 } else { 1.0 };
            let is_open = error > 0.0 && d.abs() <= error;
            let found = crossed(sign);
            crossing.cut(if is_open { found.or(crossed(-sign)) } else { found });
        }
        crossing
    }
}

/// The intervals in which a ray enters and leaves the scene's box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxCrossing {
    pub(crate) enter: Interval,
    pub(crate) leave: Interval,
}

/// The intervals in which a ray crosses the nearer and the farther of two parallel planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlabCrossing {
    pub(crate) near: Interval,
    pub(crate) far: Interval,
}

impl SlabCrossing {
    /// The crossings of two planes, in either order.
    pub(crate) fn between(a: Interval, b: Interval) -> Self {
        Self {
            near: Interval { low: a.low.min(b.low), high: a.high.min(b.high) },
            far: Interval { low: a.low.max(b.low), high: a.high.max(b.high) },
        }
    }

    /// The union of two crossings.
    pub(crate) fn or(self, other: Self) -> Self {
        Self { near: self.near.union(other.near), far: self.far.union(other.far) }
    }
}

impl BoxCrossing {
    /// The crossing of an unbounded box.
    pub(crate) const UNBOUNDED: Self =
        Self { enter: Interval::ZERO, leave: Interval { low: f64::INFINITY, high: f64::INFINITY } };

    /// Intersects the crossing with the slab between two parallel planes.
    pub(crate) fn cut(&mut self, SlabCrossing { near, far }: SlabCrossing) {
        self.enter.low = self.enter.low.max(near.low);
        self.enter.high = self.enter.high.max(near.high);
        self.leave.low = self.leave.low.min(far.low);
        self.leave.high = self.leave.high.min(far.high);
    }
}

/// The legal start of a device's ray, for the direction that the device recorded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EnteredRay {
    exact: CameraRay,
    recorded_direction: DVec3,
    /// Distance at which the ray enters the box.
    pub(crate) enter: Interval,
    pub(crate) direction: [Interval; 3],
    /// Whether the device may find that a ray exists and hits the box, and whether it may find the opposite.
    pub(crate) may_hit_box: bool,
    pub(crate) may_miss_box: bool,
}

impl CameraRay {
    /// The legal rays for the direction that the device recorded, or for the exact direction if it traced nothing.
    pub(crate) fn entered(&self, model: &CameraModel, direction: DVec3) -> EnteredRay {
        let BoxCrossing { enter, leave } = model.slabs(self, direction, DVec3::ZERO);
        EnteredRay {
            exact: *self,
            recorded_direction: direction,
            enter,
            direction: around(self.line.direction, self.direction_error),
            may_hit_box: self.may_be_seen && enter.low <= leave.high,
            may_miss_box: self.may_be_unseen || enter.high > leave.low,
        }
    }
}

impl EnteredRay {
    /// Judges the start of the device's ray. The start and its distance from the camera must agree on where the ray
    /// enters the box.
    pub(crate) fn check_start(&self, ray: &TracedRay) -> Result<(), Mismatch> {
        let mut enter = self.enter;
        for (axis, name) in AXES.iter().enumerate() {
            let found = ray.origin[axis];
            let name = format_args!("the origin's {name}");
            legal_is("camera", name, found, self.origin(axis, enter))?;
            enter = enter.intersection(self.enter_by(axis, found.into()));
        }
        legal_is("camera", "the origin's distance", ray.distance, self.distance(enter))
    }

    /// The numbers of a legal ray, with their names and bounds.
    pub(crate) fn numbers(&self, ray: &TracedRay) -> impl Iterator<Item = (&'static str, f64, Interval)> {
        let [direction, origin] = [ray.direction, ray.origin].map(|v| v.map(f64::from));
        let axes = (0..3).flat_map(move |axis| {
            [
                ("the direction of a ray", direction[axis], self.direction[axis]),
                ("the start of a ray", origin[axis], self.origin(axis, self.enter)),
            ]
        });
        let distance = ("the distance of a start", f64::from(ray.distance), self.distance(self.enter));
        axes.chain([distance])
    }

    /// The error of a component of the start: of a product and a sum. The distance may be multiplied out.
    fn origin_error(&self, axis: usize) -> f64 {
        let (d, start) = (self.recorded_direction[axis].abs(), self.exact.line.origin[axis].abs());
        let along = self.enter.high * d;
        let before = self.exact.origin_error[axis];
        PAD * (before + gamma(4) * along + U * (start + along + before) + FLUSH * (2.0 + d))
    }

    fn origin(&self, axis: usize, enter: Interval) -> Interval {
        let (d, start) = (self.recorded_direction[axis], self.exact.line.origin[axis]);
        let ends = [enter.low, enter.high].map(|enter| start + enter * d);
        Interval::between(ends[0], ends[1], self.origin_error(axis))
    }

    /// The distances of entry that agree with a component of the ray's start.
    fn enter_by(&self, axis: usize, found: f64) -> Interval {
        let (d, error) = (self.recorded_direction[axis], self.origin_error(axis));
        // For a direction perpendicular to this axis, the component does not determine the distance.
        if d.abs() < SMALLEST_COMPONENT {
            return self.enter;
        }
        let away = found - self.exact.line.origin[axis];
        Interval::between((away - error) / d, (away + error) / d, 0.0)
    }

    fn distance(&self, enter: Interval) -> Interval {
        let CameraRay { distance, distance_error, .. } = self.exact;
        let error = distance_error + PAD * U * (distance.abs() + distance_error + enter.high) + FLUSH;
        Interval { low: distance + enter.low - error, high: distance + enter.high + error }
    }
}

/// The exact ray of a pixel, starting where a device's ray may first enter the scene's box, and bounds of the
/// difference of a device's ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AnyRay {
    /// The distance from the start at the camera to where the ray enters the scene's box.
    pub(crate) enter: Interval,
    pub(crate) line: Line,
    pub(crate) slack: Slack,
    /// The slack for distances from the camera, which do not depend on where a ray enters the box, apart from rounding.
    pub(crate) slack_of_distance: Slack,
    /// The number that a device may add to a distance along the line to get the distance from the camera.
    pub(crate) distance: Interval,
    pub(crate) direction: [Interval; 3],
    /// Whether a device may find that a ray exists and hits the box, and whether it may find the opposite.
    pub(crate) may_hit_box: bool,
    pub(crate) may_miss_box: bool,
}

impl CameraRay {
    /// The legal rays for every direction that the device may have computed.
    pub(crate) fn any(&self, model: &CameraModel) -> AnyRay {
        let BoxCrossing { enter, leave } = model.slabs(self, self.line.direction, self.direction_error);
        let Line { origin, direction, bend } = self.line;
        let turned = self.direction_error.length();
        let along = enter.high * (direction.abs() + self.direction_error);
        // As in `EnteredRay::origin_error`: a product and a sum.
        let moved = self.origin_error + gamma(4) * along + U * (origin.abs() + along + self.origin_error) + 4.0 * FLUSH;
        let across = PAD * (moved.length() + enter.high * turned);
        let slack = Slack { across, along: enter.high - enter.low, direction: PAD * turned };
        let distance = self.distance + enter.low;
        let sum = self.distance.abs() + self.distance_error + enter.high;
        let distance_error = PAD * (self.distance_error + U * sum) + FLUSH;
        // A device's direction may deviate from unit length by as much again.
        let bend = bend + PAD * (2.0 * turned + turned * turned);
        // If the direction does not have unit length, distances from two points of a line differ by this much more.
        let along = (gamma(16) + 2.0 * bend) * slack.along;
        AnyRay {
            enter,
            slack_of_distance: Slack { along, ..slack },
            line: Line { origin: origin + enter.low * direction, direction, bend },
            slack,
            distance: Interval::around(distance, distance_error),
            direction: around(direction, self.direction_error),
            may_hit_box: self.may_be_seen && enter.low <= leave.high,
            may_miss_box: self.may_be_unseen || enter.high > leave.low,
        }
    }
}

impl AnyRay {
    /// The ray with more slack, for devices that start up to this far away.
    pub(crate) fn moved(mut self, moved: f64) -> Self {
        self.slack.across += PAD * moved;
        self.slack.along += PAD * moved;
        self
    }

    /// Finds all legal hits of the ray.
    pub(crate) fn find(&self, candidates: &Candidates, hits: &mut LegalHits) {
        hits.clear();
        if self.may_hit_box {
            hits.find_nearer(candidates, &self.line, self.slack, |_| false);
            hits.miss |= self.may_miss_box;
        }
    }
}
