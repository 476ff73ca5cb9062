//! What is around everything.

use std::sync::Arc;

use glam::DVec3;

use crate::image::color::LinearRgb;
use crate::light::environment::Environment;

/// The light from infinitely far away, and whether it is seen. Up is +y.
#[derive(Clone, Debug, PartialEq)]
pub struct Sky {
    /// Where light comes from.
    pub light: SkyLight,
    /// Whether the camera sees it, or the background instead.
    pub is_visible: bool,
}

/// The radiance of a sky.
#[derive(Clone, Debug, PartialEq)]
pub enum SkyLight {
    /// The same everywhere; black is none.
    Constant(LinearRgb),
    /// Linear in the direction's height y between the three.
    Gradient {
        /// Straight up.
        zenith: LinearRgb,
        /// Where y is 0.
        horizon: LinearRgb,
        /// Straight down.
        nadir: LinearRgb,
    },
    /// An image all around.
    Image {
        /// The image.
        environment: Arc<Environment>,
        /// What its radiance is multiplied by: 0 to 10⁶.
        strength: f32,
        /// By how many radians it is turned about +y, counter-clockwise from above.
        rotation: f64,
    },
}

impl Default for Sky {
    /// A soft white dome over a grey floor, not seen.
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
    /// The radiance from a direction of unit length.
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
