//! How a scene is lit, and how light is followed: lights, sky and ground, and the two ways of making a
//! picture of them.
//!
//! [`Integrator::Studio`] is direct and quick: lights with shadows, ambient occlusion, opacity, outlines, depth
//! cueing. [`Integrator::Path`] follows light as it is scattered. Both take many samples a pixel, addressed by
//! (pixel, sample, dimension), so that a picture depends on scene, size, samples and seed alone.
//!
//! # Units
//! A surface of colour c that faces a directional light of `strength` 1 has radiance c. Radiances are in the same
//! unit: a sky of radiance 1 all around makes a white Lambert surface white.

use crate::color::LinearRgb;
use crate::denoise;
use crate::filter::PixelFilter;
use crate::image::LayerSet;
use crate::outline;

mod check;
pub mod emitters;
pub mod energy;
mod ground;
mod light;
mod sky;
mod studio;

#[cfg(feature = "scene-file")]
pub(crate) use check::BRIGHTEST;
pub use check::LightingError;
pub use emitters::Emitters;
pub use ground::Ground;
pub use light::{Light, LightFrame, LightKind};
pub use sky::{Sky, SkyLight};
pub use studio::{DepthCue, Occlusion, Outline, Studio};

/// All that a lit picture depends on beside scene, camera and film.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    /// How light is followed.
    pub integrator: Integrator,
    /// How many samples, where in a pixel, and which.
    pub sampling: Sampling,
    /// Lights that are no spheres of the scene. They are not seen themselves, but for a sun.
    pub lights: Vec<Light>,
    /// What is around everything. Only paths are lit by it.
    pub sky: Sky,
    /// A plane below everything.
    pub ground: Option<Ground>,
    /// What is seen where there is nothing, unless the sky is.
    pub background: LinearRgb,
    /// Whether there is nothing to be seen where there is nothing: the colour then is multiplied by alpha.
    pub is_transparent: bool,
    /// Whether noise is filtered, by shapes and colours; see [`crate::denoise`].
    pub is_denoised: bool,
}

/// How light is followed.
#[derive(Clone, Debug, PartialEq)]
pub enum Integrator {
    /// Directly from lights to surfaces.
    Studio(Studio),
    /// As it is scattered.
    Path(PathTracing),
}

/// How paths are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathTracing {
    /// How many surfaces a path meets at most, counted with those that let it through: 1 to 64.
    pub max_depth: u32,
    /// From which surface on, counted from 0, paths that carry little end by chance (Russian roulette).
    pub roulette_from: u32,
    /// How lights that can be met by chance are looked for.
    pub light_sampling: LightSampling,
}

impl Default for PathTracing {
    /// Eight surfaces, roulette from the fourth, multiple importance sampling.
    fn default() -> Self {
        Self { max_depth: 8, roulette_from: 3, light_sampling: LightSampling::default() }
    }
}

/// How emissive spheres, a sun and an image of a sky are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "scene-file", derive(serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum LightSampling {
    /// By chance alone, by rays that surfaces scatter.
    Chance,
    /// By rays towards them from every surface that is not glass.
    Direct,
    /// By both, weighted by the balance heuristic (Veach and Guibas 1995).
    #[default]
    Multiple,
}

/// Samples and where they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Of each pixel: 1 to 2²⁴.
    pub samples: u32,
    /// Another seed gives other noise.
    pub seed: u32,
    /// How samples around a pixel's centre are weighted.
    pub filter: PixelFilter,
}

impl Sampling {
    /// The most samples of a pixel, 2²⁴.
    pub const MAX_SAMPLES: u32 = 1 << 24;
}

impl Default for Sampling {
    fn default() -> Self {
        Self { samples: 16, seed: 0, filter: PixelFilter::default() }
    }
}

impl Default for Lighting {
    /// A studio with a key light and a fill light at the camera, soft ambient light, over white.
    fn default() -> Self {
        Self {
            integrator: Integrator::Studio(Studio::default()),
            sampling: Sampling::default(),
            lights: Light::key_and_fill().to_vec(),
            sky: Sky::default(),
            ground: None,
            background: LinearRgb::WHITE,
            is_transparent: false,
            is_denoised: false,
        }
    }
}

impl Lighting {
    /// The layers that making a picture needs beside those that are wanted.
    pub(crate) fn layers_for(&self, wanted: LayerSet) -> LayerSet {
        let lines = self.studio().and_then(|studio| studio.outline);
        let for_lines = lines.map_or(LayerSet::COLOR, |_| outline::LAYERS);
        let for_noise = if self.is_denoised { denoise::GUIDES } else { LayerSet::COLOR };
        wanted.iter().chain(for_lines.iter()).chain(for_noise.iter()).collect()
    }

    /// The studio's parameters, if it is one.
    #[must_use]
    pub fn studio(&self) -> Option<&Studio> {
        match &self.integrator {
            Integrator::Studio(studio) => Some(studio),
            Integrator::Path(_) => None,
        }
    }
}
