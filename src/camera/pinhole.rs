//! The perspective camera: every ray starts at the eye.

use glam::{DVec2, DVec3};

#[cfg(feature = "scene-file")]
use super::StereoParameters;
use super::{
    Camera, CameraError, CameraKind, CameraVectors, Pose, checked_aspect, checked_half_extent,
    checked_length, framing, stereo_lengths,
};
#[cfg(feature = "scene-file")]
use crate::exact;
use crate::geometry::bounds::Bounds;
use crate::geometry::math::MAX_LENGTH;
use crate::geometry::ray::Ray;

/// A pinhole camera.
///
/// The ray of the relative location (x, y) starts at the eye and has the direction `(x·hx + shift)·u + y·hy·v −
/// distance·w`, where (hx, hy) is the half extent of the view plane, `distance` is its distance from the eye, and
/// `shift` is how far its middle lies to the right. `shift` is zero except for one eye of a stereo pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinholeCamera {
    pose: Pose,
    distance: f64,
    half_extent: DVec2,
    shift: f64,
}

impl PinholeCamera {
    /// The vertical field of view if none is given: 30 degrees.
    pub const DEFAULT_FOV_RADIANS: f64 = std::f64::consts::FRAC_PI_6;

    /// A camera with every parameter given, in scene units.
    ///
    /// # Errors
    /// Returns an error if the distance or a half extent is not a length greater than zero.
    pub fn new(
        pose: Pose,
        distance: f64,
        half_extent: impl Into<DVec2>,
    ) -> Result<Self, CameraError> {
        Ok(Self {
            pose,
            distance: checked_length("view-plane distance", distance)?,
            half_extent: checked_half_extent(half_extent)?,
            shift: 0.0,
        })
    }

    /// A camera with a vertical field of view, for a film of the given aspect ratio (width over
    /// height).
    ///
    /// # Errors
    /// Returns an error if the angle is not between 0 and π, or the aspect ratio is not greater than zero.
    pub fn with_vertical_fov(
        pose: Pose,
        fov_radians: f64,
        aspect: f64,
    ) -> Result<Self, CameraError> {
        Self::new(pose, 1.0, tangents(fov_radians, aspect)?)
    }

    /// A camera that looks along −z with y up, as molecule viewers do, and sees the whole box.
    ///
    /// # Errors
    /// Returns an error if the aspect ratio is not greater than zero, or the eye would have to stand too far away.
    pub fn framing_from_the_front(bounds: &Bounds, aspect: f64) -> Result<Self, CameraError> {
        let pose = Pose::looking_along(DVec3::ZERO, Pose::DEFAULT_DIRECTION, DVec3::Y)?;
        Self::framing(bounds, pose, Self::DEFAULT_FOV_RADIANS, aspect)
    }

    /// A camera that keeps the orientation of `pose` and moves so that it sees the whole box.
    ///
    /// # Errors
    /// The same errors as [`PinholeCamera::with_vertical_fov`], and an error if the eye would have to stand too far
    /// away.
    pub fn framing(
        bounds: &Bounds,
        pose: Pose,
        fov_radians: f64,
        aspect: f64,
    ) -> Result<Self, CameraError> {
        let tangents = tangents(fov_radians, aspect)?;
        let basis = pose.basis();
        let distance = framing::perspective_distance(bounds, &basis, tangents);
        let pose = pose.framing(bounds, distance)?;
        Self::new(pose, 1.0, tangents)
    }

    /// The cameras of the left and of the right eye, `separation` apart along u. Both look along −w. Their view planes
    /// are shifted so that a point at the depth `convergence` along −w has the same location in both pictures, and
    /// seems to lie in the screen. An infinite `convergence` shifts nothing.
    ///
    /// These are asymmetric frusta (P. Bourke, *Calculating stereo pairs*, 1999): turning the cameras inwards instead
    /// would also move objects up and down in the picture.
    ///
    /// # Errors
    /// Returns an error if a length is out of range.
    pub fn stereo_pair(&self, separation: f64, convergence: f64) -> Result<[Self; 2], CameraError> {
        let (separation, convergence) = stereo_lengths(separation, convergence)?;
        let eye = |aside: f64| {
            let shift = self.shift - aside * (self.distance / convergence);
            if !(-MAX_LENGTH..=MAX_LENGTH).contains(&shift) {
                let (parameter, low, high) = ("shift of the view plane", -MAX_LENGTH, MAX_LENGTH);
                return Err(CameraError::Range { parameter, value: shift, low, high });
            }
            Ok(Self { pose: self.pose.moved(aside * self.pose.basis().u())?, shift, ..*self })
        };
        Ok([eye(-0.5 * separation)?, eye(0.5 * separation)?])
    }

    pub(super) fn pose(&self) -> Pose {
        self.pose
    }

    /// The same rays, described by a view plane at another distance.
    pub(super) fn with_distance(&self, distance: f64) -> Result<Self, CameraError> {
        let scale = distance / self.distance;
        let shift = self.shift * scale;
        let camera = Self::new(self.pose, distance, self.half_extent * scale)?;
        Ok(Self { shift, ..camera })
    }

    pub(super) fn half_extent(&self) -> DVec2 {
        self.half_extent
    }
}

/// The half extent of the view plane at distance 1.
fn tangents(fov_radians: f64, aspect: f64) -> Result<DVec2, CameraError> {
    if !(fov_radians > 0.0 && fov_radians < std::f64::consts::PI) {
        return Err(CameraError::FieldOfView { radians: fov_radians });
    }
    let half_height = (fov_radians / 2.0).tan();
    Ok(DVec2::new(half_height * checked_aspect(aspect)?, half_height))
}

impl Camera for PinholeCamera {
    fn kind(&self) -> CameraKind {
        CameraKind::Pinhole
    }

    fn ray_in_world(&self, location: DVec2) -> Ray {
        let basis = self.pose.basis();
        let toward = location.x * basis.u() * self.half_extent.x
            + self.shift * basis.u()
            + location.y * basis.v() * self.half_extent.y
            - self.distance * basis.w();
        // At least `distance` long, so never zero.
        Ray { origin: self.pose.origin(), direction: toward / toward.length() }
    }

    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2> {
        let basis = self.pose.basis();
        let toward = point_in_world - self.pose.origin();
        let depth = -toward.dot(basis.w());
        // No ray hits the eye itself or a point behind it.
        let aside = DVec2::new(toward.dot(basis.u()), toward.dot(basis.v()));
        let in_plane = aside * (self.distance / depth) - DVec2::new(self.shift, 0.0);
        let location = in_plane / self.half_extent;
        (depth > 0.0 && location.is_finite()).then_some(location)
    }

    fn vectors(&self) -> CameraVectors {
        let basis = self.pose.basis();
        CameraVectors {
            origin: self.pose.origin(),
            right: basis.u() * self.half_extent.x,
            up: basis.v() * self.half_extent.y,
            forward: self.shift * basis.u() - self.distance * basis.w(),
            numbers: [0.0; 3],
        }
    }
}

/// The table `[camera.pinhole]` of a scene file.
#[cfg(feature = "scene-file")]
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PinholeParameters {
    /// Position of the camera; without it, the camera frames the scene.
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
    /// Distance of the view plane from the eye.
    pub distance: Option<f64>,
    /// Half width and half height of the view plane.
    #[serde(deserialize_with = "exact::optional_array")]
    pub half_extent: Option<[f64; 2]>,
    /// Vertical field of view in degrees, instead of `distance` and `half_extent`.
    pub vertical_fov: Option<f64>,
    /// Parameters of a stereo pair, if there are two eyes.
    pub stereo: Option<StereoParameters>,
}

#[cfg(feature = "scene-file")]
impl Default for PinholeParameters {
    fn default() -> Self {
        Self {
            eye: None,
            look_at: None,
            direction: None,
            up: [0.0, 1.0, 0.0],
            distance: None,
            half_extent: None,
            vertical_fov: None,
            stereo: None,
        }
    }
}

#[cfg(feature = "scene-file")]
impl PinholeParameters {
    /// The camera for a film of the given aspect ratio. Without an `eye` it is placed so that it sees the whole of
    /// `bounds`. For two eyes, this is the camera halfway between them.
    ///
    /// # Errors
    /// Returns an error if a value is out of range, or values exclude each other.
    pub fn camera(&self, aspect: f64, bounds: &Bounds) -> Result<PinholeCamera, CameraError> {
        use super::pose::{Placement, PoseParameters};

        let (eye, look_at, direction, up) = (self.eye, self.look_at, self.direction, self.up);
        let placement = PoseParameters { eye, look_at, direction, up }.placement()?;
        let fov = self.vertical_fov.map_or(PinholeCamera::DEFAULT_FOV_RADIANS, f64::to_radians);
        match (placement, self.half_extent, self.distance) {
            (_, Some(_), _) if self.vertical_fov.is_some() => Err(CameraError::Parameters {
                message: "`vertical_fov` and `half_extent` exclude each other; keep one",
            }),
            (Placement::Fixed(pose), Some(half_extent), distance) => {
                PinholeCamera::new(pose, distance.unwrap_or(1.0), half_extent)
            }
            (_, None, Some(_)) => Err(CameraError::Parameters {
                message: "`distance` needs a `half_extent`; a field of view needs neither",
            }),
            (Placement::Framed(_), Some(_), _) => Err(CameraError::Parameters {
                message: "`half_extent` needs an `eye`; to frame the whole scene give `vertical_fov`",
            }),
            (Placement::Fixed(pose), None, None) => {
                PinholeCamera::with_vertical_fov(pose, fov, aspect)
            }
            (Placement::Framed(pose), None, None) => {
                PinholeCamera::framing(bounds, pose, fov, aspect)
            }
        }
    }

    /// The cameras of the left and of the right eye; `None` without `stereo`.
    ///
    /// # Errors
    /// The same errors as [`PinholeParameters::camera`].
    pub fn stereo_pair(
        &self,
        aspect: f64,
        bounds: &Bounds,
    ) -> Result<Option<[PinholeCamera; 2]>, CameraError> {
        let pair = |stereo: StereoParameters| {
            self.camera(aspect, bounds)?.stereo_pair(stereo.separation, stereo.convergence)
        };
        self.stereo.map(pair).transpose()
    }
}
