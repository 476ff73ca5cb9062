//! The rays of a camera: how far a device's may be from the exact ones. Twin of `shaders/film.wgsl`,
//! `camera_*.wgsl` and `enter.wgsl`.

use glam::DVec3;

use super::line::Line;
use super::recording::UploadedView;
use super::rounding::{DIVIDE, FLUSH, Interval, PAD, SQRT, U, gamma};
use super::sphere::Slack;
use crate::camera::CameraKind;
use crate::film::Film;

/// As in `shaders/enter.wgsl`.
const SMALLEST_COMPONENT: f64 = 1.0 / (1_u64 << 40) as f64;

/// The exact ray of a pixel, before it is moved to the scene's box, and how far a device's may be from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraRay {
    pub(super) line: Line,
    /// From the camera's own origin of this ray to where the line starts.
    distance: f64,
    origin_error: DVec3,
    direction_error: DVec3,
    distance_error: f64,
}

/// The camera's numbers, wide.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraModel {
    kind: CameraKind,
    film: Film,
    origin: DVec3,
    advance: f64,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    scene_min: DVec3,
    scene_max: DVec3,
}

impl CameraModel {
    pub(super) fn new(kind: CameraKind, view: &UploadedView, film: &Film) -> Self {
        let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from));
        Self {
            kind,
            film: *film,
            origin: wide(view.origin),
            advance: view.advance.into(),
            right: wide(view.right),
            up: wide(view.up),
            forward: wide(view.forward),
            scene_min: wide(view.scene_min),
            scene_max: wide(view.scene_max),
        }
    }

    /// The ray through the centre of a pixel.
    pub(super) fn ray(&self, [i, j]: [u32; 2]) -> CameraRay {
        let location = self.film.relative_location(f64::from(i) + 0.5, f64::from(j) + 0.5);
        let aside = location.x * self.right + location.y * self.up;
        // The sum's terms; the location is one quotient of exact numbers.
        let terms = (location.x * self.right).abs() + (location.y * self.up).abs();
        let flush = FLUSH * (4.0 + self.right.abs() + self.up.abs());
        let location_error = (DIVIDE + U * DIVIDE) * terms + flush;
        match self.kind {
            CameraKind::Pinhole => self.pinhole(aside, terms, location_error),
            CameraKind::Orthographic => self.orthographic(aside, terms, location_error),
        }
    }

    /// Of `camera_pinhole.wgsl`.
    fn pinhole(&self, aside: DVec3, terms: DVec3, location_error: DVec3) -> CameraRay {
        let toward = aside + self.forward;
        let toward_error =
            location_error + gamma(3) * (terms + location_error + self.forward.abs()) + 4.0 * FLUSH;
        let length = toward.length();
        // |d(length)| is no longer than the vector's change; three products and their sum, and the root.
        let length_error = PAD * (toward_error.length() + (gamma(3) + SQRT) * length) + FLUSH;
        let shortest = (length - length_error).max(f64::MIN_POSITIVE);
        // One over the length, and a product.
        let direction_error = (toward_error
            + toward.abs() * (length_error / length)
            + (toward.abs() + toward_error) * (DIVIDE + 2.0 * U))
            / shortest
            * PAD
            + FLUSH;
        let along = self.advance * aside;
        let origin_error = self.advance.abs()
            * (location_error + gamma(3) * (terms + location_error))
            + gamma(2) * (self.advance.abs() * (terms + location_error) + self.origin.abs())
            + 4.0 * FLUSH;
        CameraRay {
            line: Line::exact(self.origin + along, toward / length),
            distance: self.advance * length,
            origin_error: PAD * origin_error,
            direction_error,
            distance_error: PAD * (self.advance * (length_error * (1.0 + U) + U * length)) + FLUSH,
        }
    }

    /// Of `camera_orthographic.wgsl`.
    fn orthographic(&self, aside: DVec3, terms: DVec3, location_error: DVec3) -> CameraRay {
        let origin_error =
            location_error + gamma(3) * (terms + location_error + self.origin.abs()) + 4.0 * FLUSH;
        CameraRay {
            line: Line::exact(self.origin + aside, self.forward),
            distance: self.advance,
            origin_error: PAD * origin_error,
            direction_error: DVec3::splat(FLUSH),
            distance_error: FLUSH,
        }
    }

    /// Where a ray of this origin and direction enters and leaves the scene's box, for all origins within the
    /// error.
    fn slabs(&self, ray: &CameraRay, direction: DVec3) -> BoxCrossing {
        let mut crossing = BoxCrossing {
            enter: Interval { low: 0.0, high: 0.0 },
            leave: Interval { low: f64::INFINITY, high: f64::INFINITY },
        };
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
            let (a, b) = (plane(self.scene_min[axis]), plane(self.scene_max[axis]));
            let near = Interval { low: a.low.min(b.low), high: a.high.min(b.high) };
            let far = Interval { low: a.low.max(b.low), high: a.high.max(b.high) };
            crossing.enter.low = crossing.enter.low.max(near.low);
            crossing.enter.high = crossing.enter.high.max(near.high);
            crossing.leave.low = crossing.leave.low.min(far.low);
            crossing.leave.high = crossing.leave.high.min(far.high);
        }
        crossing
    }
}

/// Where a ray enters and leaves the scene's box.
#[derive(Clone, Copy, Debug)]
struct BoxCrossing {
    enter: Interval,
    leave: Interval,
}

/// What a ray of a device must be, given the direction that it had.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnteredRay {
    /// Of the direction, component by component.
    pub(super) direction: [Interval; 3],
    /// Of the point where the ray enters the box.
    pub(super) origin: [Interval; 3],
    /// From the camera to there.
    pub(super) distance: Interval,
    /// Whether the device may find that the ray meets the box, and that it does not.
    pub(super) may_meet_box: bool,
    pub(super) may_miss_box: bool,
    /// By how much another kernel's ray may differ from this one's.
    pub(super) slack: Slack,
}

impl CameraRay {
    /// For the direction that the device had; the exact one's, if it traced nothing.
    pub(super) fn entered(&self, model: &CameraModel, direction: DVec3) -> EnteredRay {
        let BoxCrossing { enter, leave } = model.slabs(self, direction);
        let may_meet_box = enter.low <= leave.high;
        let axis = |axis: usize| {
            let (d, start) = (direction[axis], self.line.origin[axis]);
            let (a, b) = (enter.low * d, enter.high * d);
            let (low, high) = (start + a.min(b), start + a.max(b));
            let largest = a.abs().max(b.abs());
            // A product and a sum; the distance may be multiplied out.
            let error = self.origin_error[axis]
                + gamma(4) * largest
                + U * (low.abs().max(high.abs()) + self.origin_error[axis])
                + FLUSH * (2.0 + d.abs());
            Interval { low: low - PAD * error, high: high + PAD * error }
        };
        let origin = [0, 1, 2].map(axis);
        let farthest = (self.distance.abs() + self.distance_error) + enter.high;
        let distance = Interval {
            low: self.distance + enter.low - self.distance_error - U * farthest * PAD - FLUSH,
            high: self.distance + enter.high + self.distance_error + U * farthest * PAD + FLUSH,
        };
        // Two rays, each off by so much; across, what rounding the origin adds.
        let rounded = DVec3::from(origin.map(|axis| U * axis.low.abs().max(axis.high.abs())));
        let turned = self.direction_error.length();
        let slack = Slack {
            across: 2.0
                * (self.origin_error.length()
                    + rounded.length()
                    + gamma(4) * enter.high
                    + enter.high * turned),
            along: enter.high - enter.low + 2.0 * self.origin_error.length(),
            direction: 2.0 * turned,
        };
        let direction = [0, 1, 2]
            .map(|axis| Interval::around(self.line.direction[axis], self.direction_error[axis]));
        EnteredRay {
            direction,
            origin,
            distance,
            may_meet_box,
            may_miss_box: enter.high > leave.low,
            slack,
        }
    }
}
