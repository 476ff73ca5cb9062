//! Where a camera's ray enters the scene's box, and how far a device's may be from that. Twin of
//! `shaders/scene/enter.wgsl`.

use glam::DVec3;

use super::{CameraModel, CameraRay};
use crate::verify::recording::TracedRay;
use crate::verify::rounding::{DIVIDE, FLUSH, Interval, PAD, U, gamma};
use crate::verify::sphere::Slack;
use crate::verify::violation::ViolationKind;

/// As in `shaders/scene/enter.wgsl`.
pub(super) const SMALLEST_COMPONENT: f64 = 1.0 / (1_u64 << 40) as f64;

impl CameraModel {
    /// Where a ray of this origin and direction enters and leaves the scene's box, for all origins within the
    /// error.
    fn slabs(&self, ray: &CameraRay, direction: DVec3) -> BoxCrossing {
        let mut crossing = BoxCrossing::default();
        for axis in 0..3 {
            let size = direction[axis].abs().max(SMALLEST_COMPONENT);
            let inverse = if direction[axis] < 0.0 { -1.0 / size } else { 1.0 / size };
            let plane = |wall: f64| {
                let away = wall - ray.line.origin[axis];
                // The difference, one over the direction, and their product; any order of the three terms.
                let error = (ray.origin_error[axis] * (1.0 + 5.0 * U) + U * away.abs()) / size
                    + (DIVIDE + 3.0 * U) * (away * inverse).abs();
                Interval::around(away * inverse, PAD * error + FLUSH / size + FLUSH)
            };
            crossing.cut(plane(self.scene_min[axis]), plane(self.scene_max[axis]));
        }
        crossing
    }
}

/// Where a ray enters and leaves the scene's box.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxCrossing {
    pub(super) enter: Interval,
    pub(super) leave: Interval,
}

impl Default for BoxCrossing {
    /// Of a box without walls.
    fn default() -> Self {
        Self {
            enter: Interval { low: 0.0, high: 0.0 },
            leave: Interval { low: f64::INFINITY, high: f64::INFINITY },
        }
    }
}

impl BoxCrossing {
    /// Adds two opposite walls.
    pub(super) fn cut(&mut self, a: Interval, b: Interval) {
        let near = Interval { low: a.low.min(b.low), high: a.high.min(b.high) };
        let far = Interval { low: a.low.max(b.low), high: a.high.max(b.high) };
        self.enter.low = self.enter.low.max(near.low);
        self.enter.high = self.enter.high.max(near.high);
        self.leave.low = self.leave.low.min(far.low);
        self.leave.high = self.leave.high.min(far.high);
    }
}

/// What a ray of a device must be, given the direction that it had.
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct EnteredRay {
    exact: CameraRay,
    direction_had: DVec3,
    /// Where it enters the box.
    pub(in crate::verify) enter: Interval,
    /// Of the direction, component by component.
    pub(in crate::verify) direction: [Interval; 3],
    /// Whether the device may find that there is a ray that meets the box, and that there is none.
    pub(in crate::verify) may_meet_box: bool,
    pub(in crate::verify) may_miss_box: bool,
}

impl CameraRay {
    /// For the direction that the device had; the exact one's, if it traced nothing.
    pub(in crate::verify) fn entered(&self, model: &CameraModel, direction: DVec3) -> EnteredRay {
        let BoxCrossing { enter, leave } = model.slabs(self, direction);
        EnteredRay {
            exact: *self,
            direction_had: direction,
            enter,
            direction: [0, 1, 2].map(|axis| {
                Interval::around(self.line.direction[axis], self.direction_error[axis])
            }),
            may_meet_box: self.may_be_seen && enter.low <= leave.high,
            may_miss_box: self.may_be_unseen || enter.high > leave.low,
        }
    }
}

impl EnteredRay {
    /// Judges where the device's ray starts. That point and its distance from the camera must agree on where the
    /// ray enters the box.
    pub(in crate::verify) fn check_start(&self, ray: &TracedRay) -> Result<(), ViolationKind> {
        let mut enter = self.enter;
        for axis in 0..3 {
            let found = ray.origin[axis];
            let legal = self.origin(axis, enter);
            if !legal.contains(found.into()) {
                return Err(ViolationKind::Origin { axis, found, legal });
            }
            enter = enter.intersection(self.enter_by(axis, found.into()));
        }
        let (found, legal) = (ray.distance, self.distance(enter));
        if !legal.contains(found.into()) {
            return Err(ViolationKind::Distance { found, legal });
        }
        Ok(())
    }

    /// What an entry's component may be off by: a product and a sum; the distance may be multiplied out.
    fn origin_error(&self, axis: usize) -> f64 {
        let (d, start) = (self.direction_had[axis].abs(), self.exact.line.origin[axis].abs());
        let along = self.enter.high * d;
        let before = self.exact.origin_error[axis];
        PAD * (before + gamma(4) * along + U * (start + along + before) + FLUSH * (2.0 + d))
    }

    fn origin(&self, axis: usize, enter: Interval) -> Interval {
        let (d, start) = (self.direction_had[axis], self.exact.line.origin[axis]);
        let (a, b) = (start + enter.low * d, start + enter.high * d);
        let error = self.origin_error(axis);
        Interval { low: a.min(b) - error, high: a.max(b) + error }
    }

    /// Where a ray enters whose origin has this component.
    fn enter_by(&self, axis: usize, found: f64) -> Interval {
        let (d, error) = (self.direction_had[axis], self.origin_error(axis));
        // Of a ray along the others, it says nothing.
        if d.abs() < SMALLEST_COMPONENT {
            return self.enter;
        }
        let away = found - self.exact.line.origin[axis];
        let (a, b) = ((away - error) / d, (away + error) / d);
        Interval { low: a.min(b), high: a.max(b) }
    }

    fn distance(&self, enter: Interval) -> Interval {
        let CameraRay { distance, distance_error, .. } = self.exact;
        let error =
            distance_error + PAD * U * (distance.abs() + distance_error + enter.high) + FLUSH;
        Interval { low: distance + enter.low - error, high: distance + enter.high + error }
    }

    /// By how much the ray of another kernel may differ from this one's.
    pub(in crate::verify) fn slack(&self) -> Slack {
        let turned = self.exact.direction_error.length();
        let moved = self.exact.origin_error.length();
        let rounded = DVec3::from([0, 1, 2].map(|axis| self.origin_error(axis))).length();
        Slack {
            // Two rays, each off by so much.
            across: 2.0 * (moved + rounded + self.enter.high * turned),
            // It may enter the box elsewhere; but all of the box's wall is outside of all spheres, and only
            // on which side of a sphere's wall it starts depends on this.
            along: self.enter.high - self.enter.low + 2.0 * moved,
            direction: 2.0 * turned,
        }
    }
}
