//! The orthographic camera: every ray has the same direction.

use glam::{DVec2, DVec3};

use super::{
    Camera, CameraError, CameraKind, CameraVectors, Pose, checked_aspect, checked_half_extent,
    framing,
};
#[cfg(feature = "scene-file")]
use crate::exact;
use crate::geometry::bounds::Bounds;
use crate::geometry::ray::Ray;

/// An orthographic camera.
///
/// The ray of the relative location (x, y) starts at `origin + x·u·hx + y·v·hy` and has the direction
/// −w, where (hx, hy) is the half extent of the view plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrthographicCamera {
    pose: Pose,
    half_extent: DVec2,
}

impl OrthographicCamera {
    /// A camera with every parameter given, in scene units.
    ///
    /// # Errors
    /// Returns an error if a half extent is not a length greater than zero.
    pub fn new(pose: Pose, half_extent: impl Into<DVec2>) -> Result<Self, CameraError> {
        Ok(Self { pose, half_extent: checked_half_extent(half_extent)? })
    }

    /// A camera with the orientation of `pose`, moved and widened so that it sees the whole box on a film of the given
    /// aspect ratio (width over height).
    ///
    /// # Errors
    /// Returns an error if the aspect ratio is not greater than zero, or the camera would be too far away or too wide.
    pub fn framing(bounds: &Bounds, pose: Pose, aspect: f64) -> Result<Self, CameraError> {
        let basis = pose.basis();
        let (half_extent, distance) =
            framing::parallel_extent(bounds, &basis, checked_aspect(aspect)?);
        let pose = pose.framing(bounds, distance)?;
        Self::new(pose, half_extent)
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
        let basis = self.pose.basis();
        let aside = point_in_world - self.pose.origin();
        let location = DVec2::new(aside.dot(basis.u()), aside.dot(basis.v())) / self.half_extent;
        location.is_finite().then_some(location)
    }

    fn vectors(&self) -> CameraVectors {
        let basis = self.pose.basis();
        CameraVectors {
            origin: self.pose.origin(),
            right: basis.u() * self.half_extent.x,
            up: basis.v() * self.half_extent.y,
            forward: -basis.w(),
            numbers: [0.0; 3],
        }
    }
}

/// The table `[camera.orthographic]` of a scene file.
#[cfg(feature = "scene-file")]
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OrthographicParameters {
    /// The middle of the view plane; without it, the camera frames the scene.
    #[serde(deserialize_with = "exact::optional_array")]
    pub eye: Option<[f64; 3]>,
    /// The point at which the camera looks.
    #[serde(deserialize_with = "exact::optional_array")]
    pub look_at: Option<[f64; 3]>,
    /// The direction in which the camera looks, instead of `look_at`.
    #[serde(deserialize_with = "exact::optional_array")]
    pub direction: Option<[f64; 3]>,
    /// The direction that is up in the picture.
    #[serde(deserialize_with = "exact::array")]
    pub up: [f64; 3],
    /// Half width and half height of the view plane.
    #[serde(deserialize_with = "exact::optional_array")]
    pub half_extent: Option<[f64; 2]>,
}

#[cfg(feature = "scene-file")]
impl Default for OrthographicParameters {
    fn default() -> Self {
        Self { eye: None, look_at: None, direction: None, up: [0.0, 1.0, 0.0], half_extent: None }
    }
}

#[cfg(feature = "scene-file")]
impl OrthographicParameters {
    /// The camera for a film of the given aspect ratio. Without an `eye` it is placed so that it sees the whole of
    /// `bounds`.
    ///
    /// # Errors
    /// Returns an error if a value is out of range, or values exclude each other.
    pub fn camera(&self, aspect: f64, bounds: &Bounds) -> Result<OrthographicCamera, CameraError> {
        use super::pose::{Placement, PoseParameters};

        let (eye, look_at, direction, up) = (self.eye, self.look_at, self.direction, self.up);
        match (PoseParameters { eye, look_at, direction, up }.placement()?, self.half_extent) {
            (Placement::Fixed(pose), Some(half_extent)) => {
                OrthographicCamera::new(pose, half_extent)
            }
            (Placement::Framed(pose), None) => OrthographicCamera::framing(bounds, pose, aspect),
            (Placement::Fixed(_), None) => {
                Err(CameraError::Parameters { message: "an `eye` needs a `half_extent`" })
            }
            (Placement::Framed(_), Some(_)) => Err(CameraError::Parameters {
                message: "`half_extent` needs an `eye`; to frame the whole scene leave both out",
            }),
        }
    }
}
