//! The orthographic camera: every ray has the same direction.

use glam::{DVec2, DVec3};

use super::{
    Camera, CameraError, CameraKind, CameraVectors, Pose, checked_aspect, checked_half_extent,
    checked_margin, framing,
};
#[cfg(feature = "scene-file")]
use crate::exact;
use crate::geometry::ray::Ray;
use crate::geometry::subject::Subject;

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
        let (middle, half_extent) =
            framing::parallel_extent(&subject, &pose.basis(), aspect, margin);
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
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct OrthographicParameters {
    /// The middle of the view plane; without it, the camera frames the scene.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// The point at which the camera looks.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub look_at: Option<[f64; 3]>,
    /// The direction in which the camera looks, instead of `look_at`.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// The direction that is up in the picture; without it +y, or in a view along y another axis.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub up: Option<[f64; 3]>,
    /// Half width and half height of the view plane.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub half_extent: Option<[f64; 2]>,
    /// The part of the picture that a camera without an eye leaves free beside the scene, from 0 to 0.45.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// How much the picture is enlarged about its middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zoom: Option<f64>,
}

#[cfg(feature = "scene-file")]
impl OrthographicParameters {
    /// The same camera with a position, a direction, a half extent and the direction that is up. Without an `eye` it is
    /// placed so that it sees the whole of the subject.
    ///
    /// # Errors
    /// Returns the same errors as [`OrthographicParameters::camera`].
    pub fn placed(&self, aspect: f64, subject: &Subject<'_>) -> Result<Self, CameraError> {
        use super::pose::{Placement, PoseParameters};

        let (eye, look_at, direction, up) = (self.eye, self.look_at, self.direction, self.up);
        match (PoseParameters { eye, look_at, direction, up }.placement()?, self.half_extent) {
            (Placement::Fixed(..), _) if self.margin.is_some() => {
                Err(CameraError::Parameters { message: super::MARGIN_WITHOUT_FRAMING })
            }
            (Placement::Fixed(_, up), Some(_)) => Ok(Self { up: Some(up), ..*self }),
            (Placement::Framed(pose, direction, up), None) => {
                let margin = self.margin.unwrap_or(super::DEFAULT_MARGIN);
                let framed = OrthographicCamera::framing(*subject, pose, aspect, margin)?;
                Ok(Self {
                    eye: Some(framed.pose.origin().to_array()),
                    direction: Some(direction),
                    up: Some(up),
                    half_extent: Some(framed.half_extent.to_array()),
                    margin: None,
                    ..*self
                })
            }
            (Placement::Fixed(..), None) => {
                Err(CameraError::Parameters { message: "an `eye` needs a `half_extent`" })
            }
            (Placement::Framed(..), Some(_)) => Err(CameraError::Parameters {
                message: "`half_extent` needs an `eye`; to frame the whole scene leave both out",
            }),
        }
    }

    /// The camera for a film of the given aspect ratio. Without an `eye` it is placed so that it sees the whole of the
    /// subject.
    ///
    /// # Errors
    /// Returns an error if a value is out of range, or values exclude each other.
    pub fn camera(
        &self,
        aspect: f64,
        subject: &Subject<'_>,
    ) -> Result<OrthographicCamera, CameraError> {
        use super::pose::{Placement, PoseParameters};

        let placed = self.placed(aspect, subject)?;
        let Self { eye, look_at, direction, up, .. } = placed;
        let placement = PoseParameters { eye, look_at, direction, up }.placement()?;
        let (Placement::Fixed(pose, _) | Placement::Framed(pose, ..)) = placement;
        let zoom = self.zoom.map_or(Ok(1.0), |zoom| super::checked_length("`zoom`", zoom))?;
        let half_extent = DVec2::from(placed.half_extent.unwrap_or_default());
        OrthographicCamera::new(pose, half_extent / zoom)
    }
}
