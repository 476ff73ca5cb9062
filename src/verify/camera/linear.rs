//! The check of cameras whose rays intersect at one point or are parallel. The WGSL twins are
//! `shaders/camera/pinhole.wgsl`, `orthographic.wgsl`, `thin-lens.wgsl` and `disk.wgsl`.

use std::f64::consts::{FRAC_PI_4, SQRT_2};

use glam::{DVec2, DVec3};

use super::{CameraModel, CameraRay, DeviceVector, Location, Unit};
use crate::geometry::math::concentric_disk;
use crate::verify::camera::round::EIGHTH_ERROR;
use crate::verify::rounding::{DIVIDE, FLUSH, PAD, U, gamma};
use crate::verify::sphere::Line;

/// A point of the view plane, relative to its middle.
struct Aside {
    exact: DVec3,
    /// The magnitudes of the sum's terms, and the error that the error of the location causes.
    terms: DVec3,
    location_error: DVec3,
}

impl CameraModel {
    fn aside(&self, Location { exact, error }: Location) -> Aside {
        let (right, up) = (self.right, self.up);
        Aside {
            exact: exact.x * right + exact.y * up,
            terms: (exact.x * right).abs() + (exact.y * up).abs(),
            location_error: error.x * right.abs() + error.y * up.abs() + 4.0 * FLUSH,
        }
    }

    pub(super) fn pinhole(&self, location: Location) -> CameraRay {
        let Aside { exact: aside, terms, location_error } = self.aside(location);
        let unit = Unit::of(DeviceVector {
            exact: aside + self.forward,
            error: location_error + gamma(3) * (terms + location_error + self.forward.abs()) + 4.0 * FLUSH,
        });
        let along = self.advance * aside;
        let origin_error = self.advance.abs() * (location_error + gamma(3) * (terms + location_error))
            + gamma(2) * (self.advance.abs() * (terms + location_error) + self.origin.abs())
            + 4.0 * FLUSH;
        self.advanced(self.origin + along, origin_error, &unit)
    }

    /// A ray whose start is moved along it by `advance` times the length of the vector.
    fn advanced(&self, origin: DVec3, origin_error: DVec3, unit: &Unit) -> CameraRay {
        let Unit { direction, direction_error, length, length_error } = *unit;
        CameraRay {
            distance: self.advance * length,
            origin_error: PAD * origin_error,
            direction_error,
            distance_error: PAD * (self.advance * (length_error * (1.0 + U) + U * length)) + FLUSH,
            ..CameraRay::exact(Line::exact(origin, direction))
        }
    }

    pub(super) fn orthographic(&self, location: Location) -> CameraRay {
        let Aside { exact: aside, terms, location_error } = self.aside(location);
        let origin_error = location_error + gamma(3) * (terms + location_error + self.origin.abs()) + 4.0 * FLUSH;
        CameraRay {
            distance: self.advance,
            origin_error: PAD * origin_error,
            direction_error: DVec3::splat(FLUSH),
            distance_error: FLUSH,
            ..CameraRay::exact(Line::exact(self.origin + aside, self.forward))
        }
    }

    /// The ray through a point of the lens, which is in the unit square.
    pub(super) fn thin_lens(&self, location: Location, lens: DVec2) -> CameraRay {
        let Aside { exact, terms, location_error } = self.aside(location);
        let error = location_error + gamma(3) * (terms + location_error) + 4.0 * FLUSH;
        let aside = DeviceVector { exact, error };

        let (disk, disk_error) = disk(lens);
        let [first, second, _] = self.numbers;
        let radii = DVec2::new(first, second);
        let on_lens = disk * radii;
        let exact = on_lens.x * self.right + on_lens.y * self.up;
        let off = radii.abs() * disk_error + DVec2::splat(FLUSH);
        let off = off.x * self.right.abs() + off.y * self.up.abs();
        let terms = (on_lens.x * self.right).abs() + (on_lens.y * self.up).abs() + off;
        let offset = DeviceVector { exact, error: off + gamma(3) * terms + 4.0 * FLUSH };

        let unit = Unit::of(DeviceVector {
            exact: aside.exact + self.forward - offset.exact,
            error: aside.error + offset.error + gamma(2) * (aside.size() + self.forward.abs() + offset.size()),
        });
        let (near, far) = (1.0 - self.advance, self.advance);
        let origin = self.origin + far * aside.exact + near * offset.exact;
        // The error of a product; of a difference and a product; of a sum of three terms.
        let (far, near) = (far.abs(), near.abs());
        let origin_error = far * (aside.error + U * aside.size())
            + near * (offset.error + gamma(2) * offset.size())
            + gamma(2) * (self.origin.abs() + far * aside.size() + near * offset.size())
            + 4.0 * FLUSH;
        self.advanced(origin, origin_error, &unit)
    }
}

/// The point of the unit disk for a point of the unit square, and the bound of a device's error along an axis.
fn disk(square: DVec2) -> (DVec2, f64) {
    let radius = (2.0 * square - 1.0).abs().max_element();
    // The centre is exact.
    if radius == 0.0 {
        return (DVec2::ZERO, 0.0);
    }
    // The map moves a point at most twice as far as its argument, also between its two cases: its derivatives are at
    // most 1 + pi/4. The argument is rounded once.
    let moved = 2.0 * SQRT_2 * U * radius;
    // The errors of a quotient of at most 1 and of its product with a constant.
    let turned = FRAC_PI_4 * (DIVIDE + gamma(3));
    let error = moved + radius * (turned + EIGHTH_ERROR + U);
    (concentric_disk(square), PAD * error + 4.0 * FLUSH)
}
