//! The check of sines and cosines, and of cameras whose rays are computed from angles. The WGSL twins are
//! `shaders/math/trigonometry.wgsl`, `camera/panorama.wgsl` and `fisheye.wgsl`.

use std::f64::consts::{FRAC_PI_4, PI};

use glam::{DVec2, DVec3};

use crate::verify::camera::{CameraModel, CameraRay, DeviceVector, Location, Unit};
use crate::verify::rounding::{DIVIDE, FLUSH, PAD, U, error_of_length, gamma};
use crate::verify::sphere::Line;

/// The error of `sin_cos_eighth`, apart from the error of its angle. The angle is at most
/// an eighth of a turn plus rounding.
///
/// Both series consist of one term and a remainder, which is a fenced sum. The last term of the cosine's remainder
/// passes through 5 roundings of the square, one of its coefficient, 5 products and 4 sums. The magnitudes of all terms
/// add up to at most cosh(pi/4) - 1 < 0.326. Then there is one sum, of at most 1, and the truncation error, which is
/// the next term: (pi/4)^12/12!. The sine's remainder, sinh(pi/4) - pi/4 < 0.084, and its truncation error,
/// (pi/4)^11/11! < 1.8e-9, are smaller.
pub(super) const EIGHTH_ERROR: f64 = gamma(15) * 0.326 + U + 1.2e-10;

/// The exact sine and cosine of an angle. A device's values belong to an angle that may differ by `turned`, and each
/// has an additional error. The two errors are separate because a rotation preserves length.
#[derive(Clone, Copy, Debug)]
pub(super) struct SinCos {
    pub(super) sin: f64,
    pub(super) cos: f64,
    pub(super) error: f64,
    /// The largest difference of the angle.
    pub(super) turned: f64,
}

impl SinCos {
    /// Sine and cosine of a number of half turns. A device's number may differ by `error`.
    pub(super) fn of_half_turns(half_turns: f64, error: f64) -> Self {
        let (sin, cos) = (PI * half_turns).sin_cos();
        // The part beyond a quarter turn is exact. It is multiplied by a rounded constant.
        let turned = PAD * (PI * error + gamma(2) * FRAC_PI_4);
        Self { sin, cos, error: PAD * EIGHTH_ERROR + 4.0 * FLUSH, turned }
    }
}

/// The same constant as in `shaders/camera/fisheye.wgsl`.
const SMALLEST_SPOT: f64 = 1.0 / (1_u64 << 40) as f64;

/// The sum a p + b q on a device, where each factor has an error bound.
fn sum_of_products([(a, a_error), (b, b_error)]: [(f64, f64); 2], p: DeviceVector, q: DeviceVector) -> DeviceVector {
    let product = |factor: f64, error: f64, v: DeviceVector| {
        let size = (factor.abs() + error) * v.size();
        (factor.abs() * v.error + error * v.size(), size)
    };
    let ((p_error, p_size), (q_error, q_size)) = (product(a, a_error, p), product(b, b_error, q));
    DeviceVector {
        exact: a * p.exact + b * q.exact,
        error: PAD * (p_error + q_error + gamma(2) * (p_size + q_size)) + 4.0 * FLUSH,
    }
}

fn given(exact: DVec3) -> DeviceVector {
    DeviceVector { exact, error: DVec3::ZERO }
}

impl CameraModel {
    pub(super) fn panorama(&self, Location { exact, error }: Location) -> CameraRay {
        let [aside, straight, left] = self.numbers;
        let longitude = SinCos::of_half_turns(exact.x, error.x);
        let latitude = SinCos::of_half_turns(0.5 * exact.y, 0.5 * error.y);
        let (right, up, forward) = (given(self.right), given(self.up), given(self.forward));
        let SinCos { sin, cos, error, .. } = longitude;
        let heading = sum_of_products([(sin, error), (cos, error)], right, forward);
        let tangent = sum_of_products([(cos, error), (-sin, error)], right, forward);
        let SinCos { sin, cos, error, .. } = latitude;
        let ahead = sum_of_products([(cos, error), (sin, error)], heading, up);
        let toward = sum_of_products([(straight, 0.0), (-left, 0.0)], ahead, tangent);
        let mut start = sum_of_products([(1.0, 0.0), (aside, 0.0)], given(self.origin), tangent);
        start.error += PAD * aside.abs() * longitude.turned;
        ray(start, toward, longitude.turned + latitude.turned, [true, false])
    }

    pub(super) fn fisheye(&self, location: Location) -> CameraRay {
        let [first, second, half_angle] = self.numbers;
        let scale = DVec2::new(first, second);
        let spot = location.exact * scale;
        let spot_error = location.error * scale.abs();
        let spot_error = PAD * (spot_error + U * (spot.abs() + spot_error)) + FLUSH;
        let radius = spot.length();
        let nonzero = radius.max(SMALLEST_SPOT);
        let radius_error = PAD * spot_error.length() + error_of_length(nonzero);

        let part = radius.min(1.0) * half_angle;
        // Locations beyond the disk use the ray at its edge.
        let [least, most] = [radius - radius_error, radius + radius_error].map(|r| r.min(1.0));
        let part_error = half_angle.abs() * (most - least);
        let part_error = PAD * (part_error + U * (part.abs() + part_error)) + FLUSH;
        let angle = SinCos::of_half_turns(part, part_error);

        let side = spot / nonzero;
        let least = (nonzero - radius_error).max(0.5 * SMALLEST_SPOT);
        let side_error = (spot_error + side.abs() * radius_error) / least;
        let side_error = PAD * (side_error + DIVIDE * (side.abs() + side_error)) + FLUSH;
        let sides = [(side.x, side_error.x), (side.y, side_error.y)];
        let aside = sum_of_products(sides, given(self.right), given(self.up));
        let SinCos { sin, cos, error, turned } = angle;
        let toward = sum_of_products([(sin, error), (cos, error)], aside, given(self.forward));
        let may_be = [radius - radius_error <= 1.0, radius + radius_error > 1.0];
        ray(given(self.origin), toward, turned, may_be)
    }
}

/// A ray that starts at the camera, and may be rotated by an additional angle.
fn ray(start: DeviceVector, toward: DeviceVector, turned: f64, [may_be_seen, may_be_unseen]: [bool; 2]) -> CameraRay {
    let Unit { direction, direction_error, .. } = Unit::of(toward);
    CameraRay {
        origin_error: start.error,
        direction_error: direction_error + PAD * turned,
        may_be_seen,
        may_be_unseen,
        ..CameraRay::exact(Line::exact(start.exact, direction))
    }
}
