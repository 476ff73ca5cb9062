//! The orthographic camera: every ray has the same direction.

use glam::{DVec2, DVec3};

use super::{
    Camera, CameraError, CameraKind, CameraVectors, Pose, checked_aspect, checked_half_extent, checked_margin, framing,
};
use crate::geometry::ray::Ray;
use crate::geometry::subject::Subject;

/// An orthographic camera.
///
/// The ray of the relative location (x, y) starts at `origin + x·u·hx + y·v·hy` and has the direction
/// −w, where (hx, hy) is the half extent of the view plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrthographicCamera {
    pub(super) pose: Pose,
    pub(super) half_extent: DVec2,
}

impl OrthographicCamera {
    /// A camera with every parameter given, in scene units.
    ///
    /// # Errors
    /// Returns an error if a half extent is not a length greater than zero.
    pub fn new(pose: Pose, half_extent: impl Into<DVec2>) -> Result<Self, CameraError> {
        Ok(Self { pose, half_extent: checked_half_extent(half_extent)? })
    }

    /// A camera with the orientation of `pose`, moved and widened so that the picture of the subject, a box or
    /// [the spheres of a scene](crate::Scene::subject), lies in the middle of a film of the given aspect ratio (width
    /// over height) and leaves `margin` free on the two sides that it comes closest to, as a fraction of the film's
    /// width or height.
    ///
    /// # Errors
    /// Returns an error if the aspect ratio is not greater than zero, the margin is not from 0 to 0.45, or the camera
    /// would be too far away or too wide.
    pub fn framing<'a>(
        subject: impl Into<Subject<'a>>,
        pose: Pose,
        aspect: f64,
        margin: f64,
    ) -> Result<Self, CameraError> {
        let (subject, aspect) = (subject.into(), checked_aspect(aspect)?);
        let margin = checked_margin(margin)?;
        let (middle, half_extent) = framing::parallel_extent(&subject, &pose.basis(), aspect, margin);
        Self::new(pose.framing(&subject.bounds(), middle)?, half_extent)
    }
}

impl Camera for OrthographicCamera {
    fn kind(&self) -> CameraKind {
        CameraKind::Orthographic
    }

    fn ray_in_world(&self, location: DVec2) -> Ray {
        let basis = self.pose.basis();
        Ray {
            origin: self.pose.origin()
                + location.x * basis.u() * self.half_extent.x
                + location.y * basis.v() * self.half_extent.y,
            direction: -basis.w(),
        }
    }

    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2> {
        let location = self.pose.seen(point_in_world).0 / self.half_extent;
        location.is_finite().then_some(location)
    }

    fn vectors(&self) -> CameraVectors {
        self.pose.vectors(self.half_extent, [0.0; 3])
    }
}
