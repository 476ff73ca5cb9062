//! The thin-lens camera, which blurs objects out of focus.

use glam::{DVec2, DVec3};

use super::pose::checked_point;
use super::{Camera, CameraError, CameraKind, CameraVectors, PinholeCamera, checked_length, checked_range};
use crate::geometry::math::{MIN_LENGTH, concentric_disk};
use crate::geometry::ray::Ray;

/// A camera with a thin lens.
///
/// The rays of a relative location start on a disk around the eye, perpendicular to the view. All of them intersect
/// where the pinhole camera's ray hits the plane of focus, which is `focus_distance` away along the view. The lens does
/// not bend the ray through its centre, so that ray is the pinhole camera's.
///
/// If the plane of focus is at f, a point at the distance s from the lens is blurred to a disk. Its diameter in the
/// plane of focus is 2·radius·|s − f|/s. It is called the *circle of confusion* (M. Potmesil and I. Chakravarty,
/// *Synthetic image generation with a lens and aperture camera model*, ACM Transactions on Graphics 1, 1982).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLensCamera {
    /// The pinhole camera through the centre of the lens. Its view plane is the plane of focus.
    pinhole: PinholeCamera,
    aperture_radius: f64,
}

impl ThinLensCamera {
    /// A pinhole camera with a lens in place of the hole. Lengths are in scene units. The distance is measured along
    /// the view.
    ///
    /// # Errors
    /// Returns an error if the distance is not a length greater than zero, or the radius is not a length up to the
    /// distance.
    pub fn new(pinhole: PinholeCamera, aperture_radius: f64, focus_distance: f64) -> Result<Self, CameraError> {
        let high = checked_length("`focus_distance`", focus_distance)?;
        checked_range("`aperture_radius`", aperture_radius, [MIN_LENGTH, high])?;
        Ok(Self { pinhole: pinhole.with_distance(focus_distance)?, aperture_radius })
    }

    /// A thin-lens camera whose plane of focus contains a point.
    ///
    /// # Errors
    /// Returns the same errors as [`ThinLensCamera::new`], and an error if the point does not lie in front of the
    /// camera.
    pub fn focused_on(
        pinhole: PinholeCamera,
        aperture_radius: f64,
        point: impl Into<DVec3>,
    ) -> Result<Self, CameraError> {
        let point = point.into();
        checked_point("`focus_on`", point)?;
        let pose = pinhole.pose;
        let depth = (pose.origin() - point).dot(pose.basis().w());
        let distance = checked_length("distance to `focus_on` along the view", depth)?;
        Self::new(pinhole, aperture_radius, distance)
    }

    /// The aperture radius of a lens with an f-number N = f/D (ISO 517), where f is the focal length in scene units and
    /// D the diameter. The focal length has no other effect, because the field of view is the pinhole camera's.
    ///
    /// # Errors
    /// Returns an error if the focal length is not a length greater than zero, or the f-number not from 2⁻⁵⁶ to 2⁵⁶.
    pub fn aperture_radius(focal_length: f64, f_stop: f64) -> Result<f64, CameraError> {
        Ok(0.5 * checked_length("`focal_length`", focal_length)? / checked_length("`f_stop`", f_stop)?)
    }
}

impl Camera for ThinLensCamera {
    fn kind(&self) -> CameraKind {
        CameraKind::ThinLens
    }

    fn ray_in_world(&self, location: DVec2) -> Ray {
        self.pinhole.ray_in_world(location)
    }

    fn ray_through_lens(&self, location: DVec2, lens: DVec2) -> Ray {
        let CameraVectors { origin, right, up, forward, .. } = self.pinhole.vectors();
        let basis = self.pinhole.pose.basis();
        let on_lens = self.aperture_radius * concentric_disk(lens);
        let offset = on_lens.x * basis.u() + on_lens.y * basis.v();
        // The component along the view is the focus distance, so the vector is never zero.
        let toward = location.x * right + location.y * up + forward - offset;
        Ray { origin: origin + offset, direction: toward / toward.length() }
    }

    fn has_lens(&self) -> bool {
        true
    }

    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2> {
        self.pinhole.location_of(point_in_world)
    }

    /// The vectors of the pinhole camera whose view plane is the plane of focus. The first two numbers are the lens
    /// radius as multiples of the lengths of `right` and of `up`.
    fn vectors(&self) -> CameraVectors {
        let [first, second] = (self.aperture_radius / self.pinhole.half_extent).to_array();
        CameraVectors { numbers: [first, second, 0.0], ..self.pinhole.vectors() }
    }
}
