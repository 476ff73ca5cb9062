//! The sky: light from infinitely far away.

use std::sync::Arc;

use glam::DVec3;

use crate::image::color::LinearRgb;
use crate::light::environment::Environment;

/// The sky, which surrounds the scene infinitely far away. Up is +y.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize, serde::Deserialize))]
pub struct Sky {
    /// The radiance of the sky.
    pub light: SkyLight,
    /// Whether the camera sees the sky; if not, it sees the background instead.
    pub is_visible: bool,
}

/// The radiance of a sky.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SkyLight {
    /// The same radiance in all directions; black for no light.
    Constant(LinearRgb),
    /// Interpolated linearly in the direction's height y.
    Gradient {
        /// Radiance from straight up.
        zenith: LinearRgb,
        /// Radiance from the horizon, where y is 0.
        horizon: LinearRgb,
        /// Radiance from straight down.
        nadir: LinearRgb,
    },
    /// An image of all directions. Run files have its numbers as arrays.
    #[cfg_attr(feature = "run-file", serde(skip))]
    Image {
        /// The image.
        environment: Arc<Environment>,
        /// The factor by which the radiance of the image is multiplied: 0 to 10⁶.
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
    /// The radiance from a direction, which must have unit length.
    #[must_use]
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        let wide = |c: &LinearRgb| DVec3::from(c.to_array().map(f64::from));
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
