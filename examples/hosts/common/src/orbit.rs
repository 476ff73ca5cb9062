//! A camera that orbits about the origin.

use glam::dcamera::rh::{proj::directx, view};
use glam::{DMat4, DVec3};
use pinhole::camera::{DepthOrder, HostCamera, PinholeCamera, Pose};

use crate::Outcome;

/// The position of a camera that looks at the origin, with +y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    azimuth: f64,
    elevation: f64,
    distance: f64,
}

impl Default for Orbit {
    fn default() -> Self {
        Self { azimuth: 0.5, elevation: 0.35, distance: 13.0 }
    }
}

impl Orbit {
    /// The vertical field of view, in radians.
    const FOV: f64 = 0.6;
    /// The distance of the near plane.
    const NEAR: f64 = 0.1;

    /// Turns the camera by a drag of the mouse, in pixels.
    pub fn drag(&mut self, [right, down]: [f64; 2]) {
        self.azimuth -= 0.01 * right;
        self.elevation = (self.elevation + 0.01 * down).clamp(-1.5, 1.5);
    }

    /// Moves the camera by notches of the mouse wheel, nearer if positive.
    pub fn zoom(&mut self, notches: f64) {
        self.distance = (self.distance * (-0.1 * notches).exp()).clamp(1.0, 200.0);
    }

    fn eye(&self) -> DVec3 {
        let (sine, cosine) = self.elevation.sin_cos();
        let (x, z) = self.azimuth.sin_cos();
        self.distance * DVec3::new(cosine * x, sine, cosine * z)
    }

    /// The camera, for a host without matrices.
    pub fn camera(&self, aspect: f64) -> Outcome<PinholeCamera> {
        let pose = Pose::looking_at(self.eye(), DVec3::ZERO, DVec3::Y)?;
        Ok(PinholeCamera::with_vertical_fov(pose, Self::FOV, aspect)?)
    }

    /// The view matrix and the projection matrix for a host that rasterizes. Depth is 1 at the near plane and 0
    /// at infinity.
    pub fn matrices(&self, aspect: f64) -> [DMat4; 2] {
        let view = view::look_at_mat4(self.eye(), DVec3::ZERO, DVec3::Y);
        [view, directx::perspective_infinite_reverse(Self::FOV, aspect, Self::NEAR)]
    }

    /// The camera with these matrices.
    pub fn host_camera(&self, aspect: f64) -> Outcome<HostCamera> {
        let [view, projection] = self.matrices(aspect);
        Ok(HostCamera::new(view, projection, DepthOrder::NearIsOne)?)
    }
}
