//! The check of camera rays: bounds of the error of a device's rays. The WGSL twins are `shaders/camera/film.wgsl` and
//! the cameras beside it.

mod entered;
mod linear;
mod round;

use glam::{DVec2, DVec3};

use super::rounding::{DIVIDE, FLUSH, Interval, PAD, U, error_of_length};
use super::sphere::Line;
use crate::camera::CameraKind;
use crate::camera::film::Film;
use crate::geometry::math::wide;
use crate::recording::UploadedView;

pub(super) use entered::{AnyRay, BoxCrossing, EnteredRay, SMALLEST_COMPONENT, SlabCrossing};

/// The centre of the lens. All rays of a recording go through it.
const LENS_CENTER: DVec2 = DVec2::splat(0.5);

/// The exact ray of a pixel, before it is moved to the scene's box, and error bounds for a device's ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraRay {
    pub(super) line: Line,
    /// Distance from the origin of this ray at the camera to the start of the line.
    pub(super) distance: f64,
    pub(super) origin_error: DVec3,
    pub(super) direction_error: DVec3,
    pub(super) distance_error: f64,
    /// Whether the device may find that there is a ray, and whether it may find that there is none.
    pub(super) may_be_seen: bool,
    pub(super) may_be_unseen: bool,
}

impl CameraRay {
    /// A ray that is known exactly, and starts at the camera.
    pub(super) fn exact(line: Line) -> Self {
        Self {
            line,
            distance: 0.0,
            origin_error: DVec3::ZERO,
            direction_error: DVec3::ZERO,
            distance_error: 0.0,
            may_be_seen: true,
            may_be_unseen: false,
        }
    }
}

/// Every ray that a conforming device may compute from exactly these numbers, component by component. The ray is in the
/// scene's frame, before it is moved to the scene's box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegalCameraRay {
    /// Legal values of the start.
    pub origin: [Interval; 3],
    /// Legal values of the direction, which has unit length up to rounding.
    pub direction: [Interval; 3],
    /// Legal distances of the start from the camera.
    pub distance: Interval,
    /// Whether it is legal that there is a ray.
    pub may_be_seen: bool,
    /// Whether it is legal that there is no ray.
    pub may_be_unseen: bool,
}

impl LegalCameraRay {
    /// The legal rays of a relative location and a point of the lens, which is in the unit square; see
    /// [`Camera::ray_through_lens`](crate::camera::Camera::ray_through_lens).
    #[must_use]
    pub fn new(kind: CameraKind, view: &UploadedView, location: [f32; 2], lens: [f32; 2]) -> Self {
        let exact = |point: [f32; 2]| DVec2::from(point.map(f64::from));
        let location = Location { exact: exact(location), error: DVec2::ZERO };
        let model = CameraModel::new(kind, view, &Film::default());
        let ray = model.ray_through_lens(location, exact(lens));
        Self {
            origin: around(ray.line.origin, ray.origin_error),
            direction: around(ray.line.direction, ray.direction_error),
            distance: Interval::around(ray.distance, ray.distance_error),
            may_be_seen: ray.may_be_seen,
            may_be_unseen: ray.may_be_unseen,
        }
    }
}

/// The numbers of a camera and the scene's box, in f64.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraModel {
    kind: CameraKind,
    film: Film,
    origin: DVec3,
    advance: f64,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    numbers: [f64; 3],
    scene_min: DVec3,
    scene_max: DVec3,
}

/// An exact relative location, and the bound of a device's error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Location {
    pub(super) exact: DVec2,
    pub(super) error: DVec2,
}

impl CameraModel {
    pub(super) fn new(kind: CameraKind, view: &UploadedView, film: &Film) -> Self {
        Self {
            kind,
            film: *film,
            origin: wide(view.origin),
            advance: view.advance.into(),
            right: wide(view.right),
            up: wide(view.up),
            forward: wide(view.forward),
            numbers: view.numbers.map(f64::from),
            scene_min: wide(view.scene_min),
            scene_max: wide(view.scene_max),
        }
    }

    /// The length of the diagonal of the scene's box.
    pub(super) fn diagonal(&self) -> f64 {
        (self.scene_max - self.scene_min).length()
    }

    /// The ray through the centre of a pixel and the centre of the lens.
    pub(super) fn ray(&self, [i, j]: [u32; 2]) -> CameraRay {
        // The device computes one quotient of exact numbers.
        let exact = self.film.relative_location(f64::from(i) + 0.5, f64::from(j) + 0.5);
        let location = Location { exact, error: (DIVIDE + U * DIVIDE) * exact.abs() + FLUSH };
        self.ray_through_lens(location, LENS_CENTER)
    }

    /// The ray of a location through a point of the lens, which is in the unit square.
    pub(super) fn ray_through_lens(&self, location: Location, lens: DVec2) -> CameraRay {
        match self.kind {
            CameraKind::Pinhole => self.pinhole(location),
            CameraKind::Orthographic => self.orthographic(location),
            CameraKind::ThinLens => self.thin_lens(location, lens),
            CameraKind::Panorama => self.panorama(location),
            CameraKind::Fisheye => self.fisheye(location),
        }
    }
}

/// The exact value of a vector that a device computed, and the bound of the device's error.
#[derive(Clone, Copy, Debug)]
struct DeviceVector {
    exact: DVec3,
    error: DVec3,
}

impl DeviceVector {
    /// The largest magnitude of each component on a device.
    fn size(&self) -> DVec3 {
        self.exact.abs() + self.error
    }
}

/// A vector that was divided by its length, as in every camera.
#[derive(Clone, Copy, Debug)]
struct Unit {
    direction: DVec3,
    direction_error: DVec3,
    length: f64,
    length_error: f64,
}

impl Unit {
    fn of(toward: DeviceVector) -> Self {
        let DeviceVector { exact, error } = toward;
        let length = exact.length();
        // The length changes by at most the error of the vector. Its own computation adds an error.
        let length_error = PAD * error.length() + error_of_length(length);
        let shortest = (length - length_error).max(f64::MIN_POSITIVE);
        // The errors of a reciprocal of the length and of a product.
        let direction_error =
            (error + exact.abs() * (length_error / length) + toward.size() * (DIVIDE + 2.0 * U)) / shortest * PAD
                + FLUSH;
        Self { direction: exact / length, direction_error, length, length_error }
    }
}

/// The intervals of a vector's components, given their errors.
fn around(exact: DVec3, error: DVec3) -> [Interval; 3] {
    [0, 1, 2].map(|axis| Interval::around(exact[axis], error[axis]))
}
