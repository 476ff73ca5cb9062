//! The perspective camera: every ray starts at the eye.

use glam::{DVec2, DVec3};

use super::{
    Camera, CameraError, CameraKind, CameraVectors, Pose, checked_aspect, checked_fov, checked_half_extent,
    checked_length, checked_margin, checked_range, framing, stereo_lengths,
};
use crate::geometry::math::MAX_LENGTH;
use crate::geometry::ray::Ray;
use crate::geometry::subject::Subject;

/// A pinhole camera.
///
/// The ray of the relative location (x, y) starts at the eye and has the direction `(x·hx + shift)·u + y·hy·v −
/// distance·w`, where (hx, hy) is the half extent of the view plane, `distance` is its distance from the eye, and
/// `shift` is the distance of its middle to the right. `shift` is zero except for one eye of a stereo pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinholeCamera {
    pub(super) pose: Pose,
    distance: f64,
    pub(super) half_extent: DVec2,
    shift: f64,
}

impl PinholeCamera {
    /// The default vertical field of view: 30 degrees.
    pub const DEFAULT_FOV_RADIANS: f64 = std::f64::consts::FRAC_PI_6;

    /// A camera with every parameter given, in scene units.
    ///
    /// # Errors
    /// Returns an error if the distance or a half extent is not a length greater than zero.
    pub fn new(pose: Pose, distance: f64, half_extent: impl Into<DVec2>) -> Result<Self, CameraError> {
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
    pub fn with_vertical_fov(pose: Pose, fov_radians: f64, aspect: f64) -> Result<Self, CameraError> {
        Self::new(pose, 1.0, tangents(fov_radians, aspect)?)
    }

    /// A camera that looks along −z with y up, as molecule viewers do, and sees the whole subject, which is a box or
    /// [the spheres of a scene](crate::Scene::subject).
    ///
    /// # Errors
    /// Returns an error if the aspect ratio is not greater than zero, or the eye would have to stand too far away.
    pub fn framing_from_the_front<'a>(subject: impl Into<Subject<'a>>, aspect: f64) -> Result<Self, CameraError> {
        let pose = Pose::looking_along(DVec3::ZERO, Pose::DEFAULT_DIRECTION, DVec3::Y)?;
        let margin = framing::DEFAULT_MARGIN;
        Self::framing(subject, pose, Self::DEFAULT_FOV_RADIANS, aspect, margin)
    }

    /// A camera that keeps the orientation of `pose` and moves so that the picture of the subject, a box or
    /// [the spheres of a scene](crate::Scene::subject), lies in the middle of the film and leaves `margin` free on the
    /// two sides that it comes closest to, as a fraction of the film's width or height.
    ///
    /// # Errors
    /// Returns the same errors as [`PinholeCamera::with_vertical_fov`], and an error if the margin is not from 0 to
    /// 0.45, or the eye would have to stand too far away.
    pub fn framing<'a>(
        subject: impl Into<Subject<'a>>,
        pose: Pose,
        fov_radians: f64,
        aspect: f64,
        margin: f64,
    ) -> Result<Self, CameraError> {
        let (subject, margin) = (subject.into(), checked_margin(margin)?);
        let tangents = tangents(fov_radians, aspect)?;
        let eye = framing::perspective_eye(&subject, &pose.basis(), tangents, margin);
        Self::new(pose.framing(&subject.bounds(), eye)?, 1.0, tangents)
    }

    /// The cameras of the left and of the right eye, `separation` apart along u. Both look along −w. Their view planes
    /// are shifted so that a point at the depth `convergence` along −w has the same location in both pictures, and
    /// seems to lie in the screen. An infinite `convergence` shifts nothing.
    ///
    /// These are asymmetric frusta (P. Bourke, *Calculating stereo pairs*, 1999): turning the cameras inwards would
    /// also move objects up and down in the picture.
    ///
    /// # Errors
    /// Returns an error if a length is out of range.
    pub fn stereo_pair(&self, separation: f64, convergence: f64) -> Result<[Self; 2], CameraError> {
        let (separation, convergence) = stereo_lengths(separation, convergence)?;
        let eye = |aside: f64| {
            let shift = self.shift - aside * (self.distance / convergence);
            checked_range("shift of the view plane", shift, [-MAX_LENGTH, MAX_LENGTH])?;
            Ok(Self { pose: self.pose.moved(aside * self.pose.basis().u())?, shift, ..*self })
        };
        Ok([eye(-0.5 * separation)?, eye(0.5 * separation)?])
    }

    /// The camera with the same rays and the view plane at another distance.
    pub(super) fn with_distance(&self, distance: f64) -> Result<Self, CameraError> {
        let scale = distance / self.distance;
        let shift = self.shift * scale;
        let camera = Self::new(self.pose, distance, self.half_extent * scale)?;
        Ok(Self { shift, ..camera })
    }

    /// The camera with a narrower field of view, which enlarges the picture about its middle.
    pub(super) fn zoomed(self, zoom: Option<f64>) -> Result<Self, CameraError> {
        let Some(zoom) = zoom else { return Ok(self) };
        let half_extent = checked_half_extent(self.half_extent / checked_length("`zoom`", zoom)?)?;
        Ok(Self { half_extent, ..self })
    }
}

/// The half extent of the view plane at distance 1.
fn tangents(fov_radians: f64, aspect: f64) -> Result<DVec2, CameraError> {
    checked_fov(fov_radians)?;
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
        // The vector is at least `distance` long, so never zero.
        Ray { origin: self.pose.origin(), direction: toward / toward.length() }
    }

    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2> {
        let (aside, depth) = self.pose.seen(point_in_world);
        // No ray hits the eye itself or a point behind it.
        let in_plane = aside * (self.distance / depth) - DVec2::new(self.shift, 0.0);
        let location = in_plane / self.half_extent;
        (depth > 0.0 && location.is_finite()).then_some(location)
    }

    fn vectors(&self) -> CameraVectors {
        let basis = self.pose.basis();
        let forward = self.shift * basis.u() - self.distance * basis.w();
        CameraVectors { forward, ..self.pose.vectors(self.half_extent, [0.0; 3]) }
    }
}
