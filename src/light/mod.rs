//! Lights, sky and ground, which illuminate a scene. Also two tables that all renderers share: the sampling
//! probabilities of emissive spheres, and the energy that rough surfaces keep.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;

use crate::camera::CameraVectors;
use crate::geometry::math::{unit, wide};
use crate::image::color::LinearRgb;
use environment::Environment;

pub(crate) mod codes;
pub mod emitters;
pub(crate) mod energy;
pub mod environment;

pub use emitters::Emitters;

/// The largest angular radius of a narrow light, in radians: 15°.
const MOST_NARROW: f64 = PI / 12.0;

/// A light, placed in the world or relative to the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The kind of the light and its parameters.
    pub kind: LightKind,
    /// The frame of its position or direction.
    pub frame: LightFrame,
}

/// The kind of a light and its parameters. Colours are linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// A light at the eye without shadows. Each surface is lit along the ray that sees it.
    Head {
        /// Light reflected by a white surface that faces the light.
        strength: LinearRgb,
    },
    /// A light infinitely far away. With an angular radius it is a sun, so that shadows are soft and scattered rays can
    /// hit it.
    Directional {
        /// The direction towards the light, of any length except zero.
        toward: DVec3,
        /// Light reflected by a white surface that faces the light.
        strength: LinearRgb,
        /// Angular radius in radians: 0, or 0.001 to π/2.
        angular_radius: f64,
    },
    /// A point light, whose light falls off with the square of the distance.
    Point {
        /// Position in scene units.
        position: DVec3,
        /// The strength at the distance 1.
        intensity: LinearRgb,
    },
    /// A sphere with the same radiance everywhere, which gives soft shadows. It is invisible and casts no shadow.
    Sphere {
        /// Centre in scene units.
        center: DVec3,
        /// Radius in scene units.
        radius: f64,
        /// Radiance of every point of its surface.
        radiance: LinearRgb,
    },
}

/// The frame of a light's position or direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum LightFrame {
    /// World space.
    #[default]
    World,
    /// Camera space, from the camera's origin: x to the right, y up, z towards the viewer.
    Camera,
}

impl LightKind {
    /// The strength, intensity or radiance of the light.
    pub(crate) const fn color(&self) -> LinearRgb {
        match *self {
            Self::Head { strength } | Self::Directional { strength, .. } => strength,
            Self::Point { intensity, .. } => intensity,
            Self::Sphere { radiance, .. } => radiance,
        }
    }

    /// Returns true if light arrives at each point from directions that are the same everywhere and within 15°, or from
    /// the eye.
    pub(crate) fn is_narrow(&self) -> bool {
        match self {
            Self::Head { .. } => true,
            Self::Directional { angular_radius, .. } => *angular_radius <= MOST_NARROW,
            Self::Point { .. } | Self::Sphere { .. } => false,
        }
    }
}

impl Light {
    /// A key light above the viewer's left shoulder, and a weaker fill light from the right.
    #[must_use]
    pub fn key_and_fill() -> [Self; 2] {
        let at_camera = |toward, strength: f32| Self {
            kind: LightKind::Directional { toward, strength: LinearRgb::gray(strength), angular_radius: 0.0 },
            frame: LightFrame::Camera,
        };
        [at_camera(DVec3::new(-0.6, 1.0, 0.9), 0.65), at_camera(DVec3::new(1.0, 0.2, 0.8), 0.15)]
    }

    /// The light in world space, for the vectors of a camera. Directions have unit length. `None` if a direction is
    /// zero or not finite, which [`RenderSettings::check`](crate::render::RenderSettings::check) reports as an error.
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
            LightKind::Point { position, intensity } => LightKind::Point { position: in_world(position), intensity },
            LightKind::Sphere { center, radius, radiance } => {
                LightKind::Sphere { center: in_world(center), radius, radiance }
            }
        })
    }
}

/// An infinite matt plane. It is visible, and reflects light, only on the side of its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// A point of the plane, in world space.
    pub point: DVec3,
    /// The direction that is above the plane, of any length except zero.
    pub normal: DVec3,
    /// Colour of the plane, each component at most 1.
    pub color: LinearRgb,
    /// Whether only the shadows on the plane are visible, more opaque where they are darker. Only the studio integrator
    /// supports this.
    pub is_shadow_catcher: bool,
}

/// The sky, which surrounds the scene infinitely far away. Up is +y.
#[derive(Clone, Debug, PartialEq)]
pub struct Sky {
    /// The radiance of the sky.
    pub light: SkyLight,
    /// Whether the camera sees the sky. If not, it sees the background instead.
    pub is_visible: bool,
}

/// The radiance of a sky.
#[derive(Clone, Debug, PartialEq)]
pub enum SkyLight {
    /// One radiance in all directions. Black means no light.
    Constant(LinearRgb),
    /// A linear interpolation in the direction's height y.
    Gradient {
        /// Radiance from straight up.
        zenith: LinearRgb,
        /// Radiance from the horizon, where y is 0.
        horizon: LinearRgb,
        /// Radiance from straight down.
        nadir: LinearRgb,
    },
    /// An image of all directions.
    Image {
        /// The image.
        environment: Arc<Environment>,
        /// The factor that multiplies the radiance of the image, from 0 to 10⁶.
        strength: f32,
        /// The rotation of the image about +y in radians, counter-clockwise seen from above.
        rotation: f64,
    },
}

impl Default for Sky {
    /// A soft white dome over a grey floor, invisible to the camera.
    fn default() -> Self {
        Self {
            light: SkyLight::Gradient {
                zenith: LinearRgb::WHITE,
                horizon: LinearRgb::gray(0.8),
                nadir: LinearRgb::gray(0.4),
            },
            is_visible: false,
        }
    }
}

impl SkyLight {
    /// True if an image of the sky gives light.
    pub(crate) fn has_lit_image(&self) -> bool {
        matches!(self, Self::Image { environment, strength, .. } if *strength > 0.0 && environment.has_light())
    }

    /// The radiance from a direction, which must have unit length.
    #[must_use]
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        let wide = |c: &LinearRgb| wide(c.to_array());
        match self {
            Self::Constant(radiance) => wide(radiance),
            Self::Gradient { zenith, horizon, nadir } => {
                let end = if direction.y >= 0.0 { zenith } else { nadir };
                wide(horizon).lerp(wide(end), direction.y.abs())
            }
            Self::Image { environment, strength, rotation } => {
                let rotation = Environment::rotation(*rotation);
                f64::from(*strength) * DVec3::from(environment.radiance(direction, rotation))
            }
        }
    }
}
