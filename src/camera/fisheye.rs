//! The fisheye camera. Its picture is a disk, and the distance from the middle is the angle from the direction of view.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::{Camera, CameraError, CameraKind, CameraVectors, Pose, checked_aspect};
use crate::geometry::ray::Ray;

/// An equidistant fisheye camera.
///
/// The picture is the largest disk that fits on the film. Its diameter is the shorter side of the film. A location at r
/// times the radius of the disk has a ray at the angle r·angle/2 from the direction of view, tilted towards that
/// location. Outside the disk there are no rays.
///
/// The camera is meant to stand inside the scene. From farther away than about ten times the size of the scene, f32 no
/// longer resolves the point where a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FisheyeCamera {
    pose: Pose,
    half_angle: f64,
    /// Half width and half height of the film, as multiples of the radius of the disk.
    scale: DVec2,
}

impl FisheyeCamera {
    /// The default angle across the whole disk: 180 degrees.
    pub const DEFAULT_ANGLE_RADIANS: f64 = std::f64::consts::PI;

    /// A camera whose disk spans `angle_radians`, on a film of the given aspect ratio (width over height).
    ///
    /// # Errors
    /// Returns an error if the angle is not greater than 0 and at most 2π, or the aspect ratio is not greater than
    /// zero.
    pub fn new(pose: Pose, angle_radians: f64, aspect: f64) -> Result<Self, CameraError> {
        if !(angle_radians > 0.0 && angle_radians <= TAU) {
            let (parameter, value) = ("`angle` in degrees", angle_radians.to_degrees());
            return Err(CameraError::Range { parameter, value, low: 0.0, high: 360.0 });
        }
        let aspect = checked_aspect(aspect)?;
        let scale = DVec2::new(aspect.max(1.0), (1.0 / aspect).max(1.0));
        Ok(Self { pose, half_angle: 0.5 * angle_radians, scale })
    }
}

impl Camera for FisheyeCamera {
    fn kind(&self) -> CameraKind {
        CameraKind::Fisheye
    }

    /// Returns the ray at the nearest point of the edge if `location` is outside the disk.
    fn ray_in_world(&self, location: DVec2) -> Ray {
        let basis = self.pose.basis();
        let spot = location * self.scale;
        let side = spot.normalize_or_zero();
        let (sin, cos) = (self.half_angle * spot.length().min(1.0)).sin_cos();
        let toward = sin * (side.x * basis.u() + side.y * basis.v()) - cos * basis.w();
        Ray { origin: self.pose.origin(), direction: toward / toward.length() }
    }

    fn sees(&self, location: DVec2) -> bool {
        (location * self.scale).length() <= 1.0
    }

    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2> {
        let (across, ahead) = self.pose.seen(point_in_world);
        let r = across.length().atan2(ahead) / self.half_angle;
        // Exactly behind the camera, the direction across the view is undefined. At the eye, there is no direction at
        // all.
        let is_defined = ahead > 0.0 || across != DVec2::ZERO;
        (is_defined && r <= 1.0).then(|| across.normalize_or_zero() * r / self.scale)
    }

    /// `right`, `up` and `forward` are unit vectors. The numbers are half the width and half the height of the film as
    /// multiples of the radius of the disk, and half of `angle` divided by π.
    fn vectors(&self) -> CameraVectors {
        let [x, y] = self.scale.to_array();
        self.pose.vectors(DVec2::ONE, [x, y, self.half_angle / std::f64::consts::PI])
    }
}
