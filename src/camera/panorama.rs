//! The camera that sees all directions: longitude across the picture, latitude up it.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

#[cfg(feature = "scene-file")]
use super::StereoParameters;
use super::{Camera, CameraError, CameraKind, CameraVectors, Pose, stereo_lengths};
#[cfg(feature = "scene-file")]
use crate::exact;
#[cfg(feature = "scene-file")]
use crate::geometry::bounds::Bounds;
use crate::geometry::ray::Ray;

/// An equirectangular camera: 360 degrees by 180. A film twice as wide as high has square pixels in the middle.
///
/// The ray of the relative location (x, y) has the longitude λ = πx, which is 0 forwards along −w and positive to the
/// right, and the latitude φ = πy/2, which is +π/2 along v: the direction cos φ (sin λ·u − cos λ·w) + sin φ·v.
///
/// For one of two eyes it starts aside of the camera, on a circle in the plane of u and w (omni-directional stereo:
/// S. Peleg, M. Ben-Ezra and Y. Pritch, *Omnistereo: panoramic stereo imaging*, IEEE PAMI 23, 2001), and is turned
/// inwards so that the rays of both eyes meet at the distance of convergence. Straight up and down, where there is no
/// aside, the picture is as twisted as with any such camera.
///
/// It is for the middle of things: f32 no longer tells where a ray meets a scene from beyond some ten times its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanoramaCamera {
    pose: Pose,
    /// How far to the right of the camera rays start.
    aside: f64,
    /// Cosine and sine of how far they are turned to the left.
    inwards: [f64; 2],
}

impl PanoramaCamera {
    /// A camera with one eye.
    #[must_use]
    pub fn new(pose: Pose) -> Self {
        Self { pose, aside: 0.0, inwards: [1.0, 0.0] }
    }

    /// The cameras of the left and of the right eye, whose rays start half of `separation` aside and of which two of
    /// the same location meet at the distance `convergence`, which may be infinite.
    ///
    /// # Errors
    /// If a length is out of range.
    pub fn stereo_pair(&self, separation: f64, convergence: f64) -> Result<[Self; 2], CameraError> {
        let (separation, convergence) = stereo_lengths(separation, convergence)?;
        let eye = |aside: f64| {
            let (sin, cos) = (aside / convergence).atan().sin_cos();
            Self { aside, inwards: [cos, sin], ..*self }
        };
        Ok([eye(-0.5 * separation), eye(0.5 * separation)])
    }
}

impl Camera for PanoramaCamera {
    fn kind(&self) -> CameraKind {
        CameraKind::Panorama
    }

    fn ray_in_world(&self, location: DVec2) -> Ray {
        let basis = self.pose.basis();
        let (sin, cos) = (PI * location.x).sin_cos();
        let heading = sin * basis.u() - cos * basis.w();
        let tangent = cos * basis.u() + sin * basis.w();
        let (climb, level) = (FRAC_PI_2 * location.y).sin_cos();
        let [straight, left] = self.inwards;
        let toward = straight * (level * heading + climb * basis.v()) - left * tangent;
        let origin = self.pose.origin() + self.aside * tangent;
        Ray { origin, direction: toward / toward.length() }
    }

    /// Of one eye of two nothing is said.
    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2> {
        let basis = self.pose.basis();
        let toward = point_in_world - self.pose.origin();
        let [x, y, z] = [basis.u(), basis.v(), -basis.w()].map(|axis| toward.dot(axis));
        let location = DVec2::new(x.atan2(z) / PI, y.atan2(x.hypot(z)) / FRAC_PI_2);
        (self.aside == 0.0 && toward != DVec3::ZERO && location.is_finite()).then_some(location)
    }

    /// `right`, `up` and `forward` are unit vectors. The numbers are how far to the right rays start, and the cosine
    /// and sine of how far they are turned to the left.
    fn vectors(&self) -> CameraVectors {
        let (basis, [straight, left]) = (self.pose.basis(), self.inwards);
        CameraVectors {
            origin: self.pose.origin(),
            right: basis.u(),
            up: basis.v(),
            forward: -basis.w(),
            numbers: [self.aside, straight, left],
        }
    }
}

/// The table `[camera.panorama]` of a scene file.
#[cfg(feature = "scene-file")]
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PanoramaParameters {
    /// Where the camera is; without it, in the middle of the scene.
    #[serde(deserialize_with = "exact::optional_array")]
    pub eye: Option<[f64; 3]>,
    /// The point in the middle of the picture.
    #[serde(deserialize_with = "exact::optional_array")]
    pub look_at: Option<[f64; 3]>,
    /// The direction in the middle of the picture, instead of `look_at`.
    #[serde(deserialize_with = "exact::optional_array")]
    pub direction: Option<[f64; 3]>,
    /// Which way is up.
    #[serde(deserialize_with = "exact::array")]
    pub up: [f64; 3],
    /// Two eyes instead of one.
    pub stereo: Option<StereoParameters>,
}

#[cfg(feature = "scene-file")]
impl Default for PanoramaParameters {
    fn default() -> Self {
        Self { eye: None, look_at: None, direction: None, up: [0.0, 1.0, 0.0], stereo: None }
    }
}

#[cfg(feature = "scene-file")]
impl PanoramaParameters {
    /// The camera, for a box in whose middle it stands if it has no place. Of two eyes, that in the middle.
    ///
    /// # Errors
    /// If a value is out of range, or values exclude each other.
    pub fn camera(&self, _aspect: f64, bounds: &Bounds) -> Result<PanoramaCamera, CameraError> {
        use super::pose::{Placement, PoseParameters};

        let (eye, look_at, direction, up) = (self.eye, self.look_at, self.direction, self.up);
        match (PoseParameters { eye, look_at, direction, up }).placement()? {
            Placement::Fixed(pose) => Ok(PanoramaCamera::new(pose)),
            Placement::Framed(pose) => Ok(PanoramaCamera::new(pose.framing(bounds, 0.0)?)),
        }
    }

    /// Left and right eye, if there are two.
    ///
    /// # Errors
    /// As [`PanoramaParameters::camera`].
    pub fn stereo_pair(
        &self,
        aspect: f64,
        bounds: &Bounds,
    ) -> Result<Option<[PanoramaCamera; 2]>, CameraError> {
        let pair = |stereo: StereoParameters| {
            self.camera(aspect, bounds)?.stereo_pair(stereo.separation, stereo.convergence)
        };
        self.stereo.map(pair).transpose()
    }
}
