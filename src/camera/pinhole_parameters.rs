//! The table `[camera.pinhole]` of a scene file.

use super::pose::{Placement, PoseParameters};
use super::{CameraError, DEFAULT_MARGIN, PinholeCamera, StereoParameters};
use crate::exact;
use crate::geometry::subject::Subject;

/// The table `[camera.pinhole]` of a scene file.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct PinholeParameters {
    /// Position of the camera; without it, the camera frames the scene.
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
    /// Distance of the view plane from the eye.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// Half width and half height of the view plane.
    #[serde(deserialize_with = "exact::optional_array", skip_serializing_if = "Option::is_none")]
    pub half_extent: Option<[f64; 2]>,
    /// Vertical field of view in degrees, instead of `distance` and `half_extent`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertical_fov: Option<f64>,
    /// The part of the picture that a camera without an eye leaves free beside the scene, from 0 to 0.45.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// How much the picture is enlarged about its middle, by a narrower field of view.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zoom: Option<f64>,
    /// Parameters of a stereo pair, if there are two eyes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stereo: Option<StereoParameters>,
}

impl PinholeParameters {
    /// The same camera with a position, a direction and the direction that is up. Without an `eye` it is placed so that
    /// it sees the whole of the subject.
    ///
    /// # Errors
    /// Returns the same errors as [`PinholeParameters::camera`].
    pub fn placed(&self, aspect: f64, subject: &Subject<'_>) -> Result<Self, CameraError> {
        let (eye, look_at, direction, up) = (self.eye, self.look_at, self.direction, self.up);
        let placement = PoseParameters { eye, look_at, direction, up }.placement()?;
        let fov = self.fov_radians();
        match (placement, self.half_extent, self.distance) {
            (_, Some(_), _) if self.vertical_fov.is_some() => Err(CameraError::Parameters {
                message: "`vertical_fov` and `half_extent` exclude each other; keep one",
            }),
            (_, None, Some(_)) => Err(CameraError::Parameters {
                message: "`distance` needs a `half_extent`; a field of view needs neither",
            }),
            (Placement::Framed(..), Some(_), _) => Err(CameraError::Parameters {
                message: "`half_extent` needs an `eye`; to frame the whole scene give `vertical_fov`",
            }),
            (Placement::Fixed(..), _, _) if self.margin.is_some() => {
                Err(CameraError::Parameters { message: super::MARGIN_WITHOUT_FRAMING })
            }
            (Placement::Fixed(_, up), _, _) => Ok(Self { up: Some(up), ..*self }),
            (Placement::Framed(pose, direction, up), None, None) => {
                let margin = self.margin.unwrap_or(DEFAULT_MARGIN);
                let framed = PinholeCamera::framing(*subject, pose, fov, aspect, margin)?;
                Ok(Self {
                    eye: Some(framed.pose().origin().to_array()),
                    direction: Some(direction),
                    up: Some(up),
                    margin: None,
                    ..*self
                })
            }
        }
    }

    fn fov_radians(&self) -> f64 {
        self.vertical_fov.map_or(PinholeCamera::DEFAULT_FOV_RADIANS, f64::to_radians)
    }

    /// The camera for a film of the given aspect ratio. Without an `eye` it is placed so that it sees the whole of the
    /// subject. For two eyes, this is the camera halfway between them.
    ///
    /// # Errors
    /// Returns an error if a value is out of range, or values exclude each other.
    pub fn camera(&self, aspect: f64, subject: &Subject<'_>) -> Result<PinholeCamera, CameraError> {
        let Self { eye, look_at, direction, up, .. } = self.placed(aspect, subject)?;
        let placement = PoseParameters { eye, look_at, direction, up }.placement()?;
        let (Placement::Fixed(pose, _) | Placement::Framed(pose, ..)) = placement;
        let camera = match self.half_extent {
            Some(half_extent) => {
                PinholeCamera::new(pose, self.distance.unwrap_or(1.0), half_extent)
            }
            None => PinholeCamera::with_vertical_fov(pose, self.fov_radians(), aspect),
        };
        camera?.zoomed(self.zoom)
    }

    /// The cameras of the left and of the right eye; `None` without `stereo`.
    ///
    /// # Errors
    /// Returns the same errors as [`PinholeParameters::camera`].
    pub fn stereo_pair(
        &self,
        aspect: f64,
        subject: &Subject<'_>,
    ) -> Result<Option<[PinholeCamera; 2]>, CameraError> {
        let pair = |stereo: StereoParameters| {
            self.camera(aspect, subject)?.stereo_pair(stereo.separation, stereo.convergence)
        };
        self.stereo.map(pair).transpose()
    }
}
