//! All rays that a device may compute for a pixel, for checking results whose ray was not recorded.

use super::entered::{BoxCrossing, Crossed, SMALLEST_COMPONENT};
use super::{CameraModel, CameraRay};
use crate::verify::line::Line;
use crate::verify::rounding::{DIVIDE, FLUSH, Interval, PAD, U, gamma};
use crate::verify::sphere::Slack;

/// The exact ray of a pixel, starting where a device's ray may first enter the scene's box, and bounds of the
/// difference of a device's ray.
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct AnyRay {
    pub(in crate::verify) line: Line,
    pub(in crate::verify) slack: Slack,
    /// The slack for distances from the camera, which do not depend on where a ray enters the box, apart from rounding.
    pub(in crate::verify) slack_of_distance: Slack,
    /// The number that a device may add to a distance along the line to get the distance from the camera.
    pub(in crate::verify) distance: Interval,
    /// Legal intervals of the direction's components.
    pub(in crate::verify) direction: [Interval; 3],
    /// Whether a device may find that a ray exists and hits the box, and whether it may find the opposite.
    pub(in crate::verify) may_hit_box: bool,
    pub(in crate::verify) may_miss_box: bool,
}

impl CameraRay {
    /// The legal rays for every direction that the device may have computed.
    pub(in crate::verify) fn any(&self, model: &CameraModel) -> AnyRay {
        let BoxCrossing { enter, leave } = model.slabs_of_any(self);
        let Line { origin, direction, bend } = self.line;
        let turned = self.direction_error.length();
        let along = enter.high * (direction.abs() + self.direction_error);
        // As for `EnteredRay`: a product and a sum.
        let moved = self.origin_error
            + gamma(4) * along
            + U * (origin.abs() + along + self.origin_error)
            + 4.0 * FLUSH;
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
            slack_of_distance: Slack { along, ..slack },
            line: Line { origin: origin + enter.low * direction, direction, bend },
            slack,
            distance: Interval::around(distance, distance_error),
            direction: [0, 1, 2]
                .map(|axis| Interval::around(direction[axis], self.direction_error[axis])),
            may_hit_box: self.may_be_seen && enter.low <= leave.high,
            may_miss_box: self.may_be_unseen || enter.high > leave.low,
        }
    }
}

impl CameraModel {
    /// Where a ray enters and leaves the scene's box, for all origins and directions within their error bounds.
    fn slabs_of_any(&self, ray: &CameraRay) -> BoxCrossing {
        let mut crossing = BoxCrossing::default();
        for axis in 0..3 {
            let (d, error) = (ray.line.direction[axis], ray.direction_error[axis]);
            let least = (d.abs() - error).max(SMALLEST_COMPONENT);
            let most = (d.abs() + error).max(SMALLEST_COMPONENT);
            let crossed = |sign: f64| {
                // The reciprocal of the component.
                let inverses = [1.0 / least, 1.0 / most].map(|inverse| inverse.copysign(sign));
                let plane = |plane: f64| {
                    let away = plane - ray.line.origin[axis];
                    let moved = ray.origin_error[axis] * (1.0 + 5.0 * U) + U * away.abs();
                    let error = moved / least + (DIVIDE + 3.0 * U) * away.abs() / least;
                    let [one, other] = inverses.map(|inverse| away * inverse);
                    let error = PAD * error + FLUSH / least + FLUSH;
                    Interval { low: one.min(other) - error, high: one.max(other) + error }
                };
                Crossed::between(plane(self.scene_min[axis]), plane(self.scene_max[axis]))
            };
            // A small component may have either sign, which is the same for both planes.
            let is_open = d.abs() <= error;
            let found = crossed(d);
            crossing.cut(if is_open { found.or(crossed(-d)) } else { found });
        }
        crossing
    }
}
