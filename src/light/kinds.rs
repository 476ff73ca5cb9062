//! Lights that are no spheres of the scene.

use glam::DVec3;

use crate::camera::{Camera, CameraVectors};
use crate::geometry::math::unit;
use crate::image::color::LinearRgb;

/// A light, in the world or at the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// What it is.
    pub kind: LightKind,
    /// In which frame its position or direction is.
    pub frame: LightFrame,
}

/// What a light is. Colours are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// At the eye, shadowless: each surface is lit along the ray that sees it.
    Head {
        /// Of a surface that faces it.
        strength: LinearRgb,
    },
    /// Infinitely far away. With an angular radius it is a sun: shadows are soft, and paths may meet it.
    Directional {
        /// The direction towards it, of any length.
        toward: DVec3,
        /// Of a surface that faces it.
        strength: LinearRgb,
        /// In radians: 0, or 0.001 to π/2.
        angular_radius: f64,
    },
    /// A point; light falls off with the square of the distance.
    Point {
        /// In scene units.
        position: DVec3,
        /// What its strength is at the distance 1.
        intensity: LinearRgb,
    },
    /// A sphere that shines with the same radiance everywhere, which gives soft shadows. It is not seen, and casts
    /// no shadow.
    Sphere {
        /// In scene units.
        center: DVec3,
        /// In scene units.
        radius: f64,
        /// Of every point of its surface.
        radiance: LinearRgb,
    },
}

/// In which frame a light's place or direction is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "scene-file", derive(serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum LightFrame {
    /// The world.
    #[default]
    World,
    /// The camera's: x to the right, y up, z towards the viewer, from the camera's origin.
    Camera,
}

impl Light {
    /// A key light above the viewer's left shoulder, and a weaker one from the right.
    #[must_use]
    pub fn key_and_fill() -> [Self; 2] {
        let at_camera = |toward, strength: f32| Self {
            kind: LightKind::Directional {
                toward,
                strength: LinearRgb::gray(strength),
                angular_radius: 0.0,
            },
            frame: LightFrame::Camera,
        };
        [at_camera(DVec3::new(-0.6, 1.0, 0.9), 0.65), at_camera(DVec3::new(1.0, 0.2, 0.8), 0.15)]
    }

    /// The light in the world, seen by a camera; directions have unit length. `None` for a direction that is none,
    /// which [`RenderSettings::check`](crate::render::RenderSettings::check) refuses.
    #[must_use]
    pub fn in_world(&self, camera: &dyn Camera) -> Option<LightKind> {
        self.in_view(&camera.vectors())
    }

    /// The same, of a camera's vectors.
    pub(crate) fn in_view(&self, vectors: &CameraVectors) -> Option<LightKind> {
        let axes = [vectors.right, vectors.up, -vectors.forward].map(DVec3::normalize_or_zero);
        let turned = |v: DVec3| match self.frame {
            LightFrame::World => v,
            LightFrame::Camera => v.x * axes[0] + v.y * axes[1] + v.z * axes[2],
        };
        let in_world = |v: DVec3| match self.frame {
            LightFrame::World => v,
            LightFrame::Camera => vectors.origin + turned(v),
        };
        Some(match self.kind {
            head @ LightKind::Head { .. } => head,
            LightKind::Directional { toward, strength, angular_radius } => {
                let toward = unit(turned(toward))?;
                LightKind::Directional { toward, strength, angular_radius }
            }
            LightKind::Point { position, intensity } => {
                LightKind::Point { position: in_world(position), intensity }
            }
            LightKind::Sphere { center, radius, radiance } => {
                LightKind::Sphere { center: in_world(center), radius, radiance }
            }
        })
    }
}
