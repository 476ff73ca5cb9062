//! The panorama camera, which sees all directions. Longitude runs across the picture and latitude up it.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::{Camera, CameraError, CameraKind, CameraVectors, Pose, stereo_lengths};
use crate::geometry::ray::Ray;

/// An equirectangular camera of 360 degrees by 180. On a film twice as wide as high, pixels in the middle are square.
///
/// The ray of the relative location (x, y) has the longitude λ = πx, which is 0 forwards along −w and positive to the
/// right, and the latitude φ = πy/2, which is +π/2 along v: the direction cos φ (sin λ·u − cos λ·w) + sin φ·v.
///
/// The rays of one eye of a stereo pair start on a circle around the camera in the plane of u and w (omni-directional
/// stereo: S. Peleg, M. Ben-Ezra and Y. Pritch, *Omnistereo: panoramic stereo imaging*, IEEE PAMI 23, 2001). They are
/// turned inwards, so that the rays of both eyes intersect at the distance of convergence. Straight up and down the
/// picture is distorted, as with every camera of this type.
///
/// The camera is meant to stand inside the scene. From farther away than about ten times the size of the scene, f32 no
/// longer resolves the point where a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanoramaCamera {
    pose: Pose,
    /// The distance from the camera to the right at which rays start, in scene units. Zero for a single eye.
    aside: f64,
    /// Cosine and sine of the angle by which rays are turned to the left.
    inwards: [f64; 2],
}

impl PanoramaCamera {
    /// A camera with one eye.
    #[must_use]
    pub fn new(pose: Pose) -> Self {
        Self { pose, aside: 0.0, inwards: [1.0, 0.0] }
    }

    /// The cameras of the left and of the right eye. Rays start half of `separation` to the left and to the right. Two
    /// rays of the same location intersect at the distance `convergence`, which may be infinite.
    ///
    /// # Errors
    /// Returns an error if a length is out of range.
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

    /// Returns `None` for one eye of a stereo pair.
    fn location_of(&self, point_in_world: DVec3) -> Option<DVec2> {
        let basis = self.pose.basis();
        let toward = point_in_world - self.pose.origin();
        let [x, y, z] = [basis.u(), basis.v(), -basis.w()].map(|axis| toward.dot(axis));
        let location = DVec2::new(x.atan2(z) / PI, y.atan2(x.hypot(z)) / FRAC_PI_2);
        (self.aside == 0.0 && toward != DVec3::ZERO && location.is_finite()).then_some(location)
    }

    /// `right`, `up` and `forward` are unit vectors. The numbers are the distance to the right at which rays start, and
    /// the cosine and the sine of the angle by which rays are turned to the left.
    fn vectors(&self) -> CameraVectors {
        let [straight, left] = self.inwards;
        self.pose.vectors(DVec2::ONE, [self.aside, straight, left])
    }
}
