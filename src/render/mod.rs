//! How a picture is made of a scene and a view: which rays are traced, what lights them, and what is seen where
//! there is nothing.
//!
//! [`Integrator::Primary`] traces one ray through the centre of each pixel and colours what it meets first; no lights
//! are needed. [`Integrator::Studio`] is direct and quick: lights with shadows, ambient occlusion, opacity, outlines,
//! depth cueing. [`Integrator::Path`] follows light as it is scattered. The last two, which make lit pictures, take
//! many samples a pixel, addressed by (pixel, sample, dimension), so that a picture depends on scene, size, samples
//! and seed alone.
//!
//! # Units
//! A surface of colour c that faces a directional light of `strength` 1 has radiance c. Radiances are in the same
//! unit: a sky of radiance 1 all around makes a white Lambert surface white.

use crate::camera::filter::PixelFilter;
use crate::image::LayerSet;
use crate::image::color::LinearRgb;
use crate::image::denoise;
use crate::image::outline;
use crate::light::{Ground, Light, Sky};

mod check;
mod integrator;
mod notes;
mod studio;

#[cfg(feature = "scene-file")]
pub(crate) use check::BRIGHTEST;
pub use check::SettingsError;
pub use integrator::{Integrator, LightSampling, PathTracing, PrimarySettings, Shading};
pub use notes::SettingsNote;
pub use studio::{DepthCue, Occlusion, Outline, Studio};

/// All that a picture depends on beside the scene and the view.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSettings {
    /// How rays become colours.
    pub integrator: Integrator,
    /// How many samples each pixel has, where in the pixel they are, and which ones they are. Primary rays are one
    /// for each pixel, through its centre.
    pub sampling: Sampling,
    /// Lights that are no spheres of the scene. They are not seen themselves, except for a sun. Only for lit pictures.
    pub lights: Vec<Light>,
    /// What is around everything. Only paths are lit by it.
    pub sky: Sky,
    /// A plane below everything. Only for lit pictures.
    pub ground: Option<Ground>,
    /// What is seen where there is nothing, unless the sky is seen.
    pub background: LinearRgb,
    /// Whether a pixel is transparent where there is nothing; its colour is then multiplied by alpha.
    pub is_transparent: bool,
    /// Whether noise is filtered, guided by shapes and colours; see [`crate::image::denoise`]. Only for lit pictures.
    pub is_denoised: bool,
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
    /// Sixteen samples of a lit picture.
    fn default() -> Self {
        Self { samples: 16, seed: 0, filter: PixelFilter::default() }
    }
}

impl Default for RenderSettings {
    /// Primary rays, one through the centre of each pixel; surfaces are lit from the eye, over white.
    fn default() -> Self {
        Self {
            integrator: Integrator::default(),
            sampling: Sampling { samples: 1, ..Sampling::default() },
            lights: Vec::new(),
            sky: Sky::default(),
            ground: None,
            background: LinearRgb::WHITE,
            is_transparent: false,
            is_denoised: false,
        }
    }
}

impl RenderSettings {
    /// A studio with a key light and a fill light at the camera, soft ambient light, over white.
    #[must_use]
    pub fn studio() -> Self {
        Self {
            integrator: Integrator::Studio(Studio::default()),
            sampling: Sampling::default(),
            lights: Light::key_and_fill().to_vec(),
            ..Self::default()
        }
    }

    /// Paths, lit by the same two lights and a soft sky that is not seen, over white.
    #[must_use]
    pub fn path() -> Self {
        Self { integrator: Integrator::Path(PathTracing::default()), ..Self::studio() }
    }

    /// The same scene and background by primary rays alone: what is left if lights, samples, sky, ground and
    /// denoising are taken away. A shading that was chosen stays.
    #[must_use]
    pub fn by_primary_rays(&self) -> Self {
        let Self { background, is_transparent, .. } = *self;
        let shading = self.primary().map(|primary| primary.shading).unwrap_or_default();
        Self {
            integrator: Integrator::Primary(shading),
            background,
            is_transparent,
            ..Self::default()
        }
    }

    /// How primary rays become colours; `None` if the picture is lit.
    #[must_use]
    pub fn primary(&self) -> Option<PrimarySettings> {
        match self.integrator {
            Integrator::Primary(shading) => {
                let background =
                    if self.is_transparent { LinearRgb::BLACK } else { self.background };
                Some(PrimarySettings { shading, background })
            }
            Integrator::Studio(_) | Integrator::Path(_) => None,
        }
    }

    /// The studio's parameters, if it is one.
    #[must_use]
    pub fn studio_parameters(&self) -> Option<&Studio> {
        match &self.integrator {
            Integrator::Studio(studio) => Some(studio),
            Integrator::Primary(_) | Integrator::Path(_) => None,
        }
    }

    /// The layers that making a picture needs beside those that are wanted.
    pub(crate) fn layers_for(&self, wanted: LayerSet) -> LayerSet {
        let lines = self.studio_parameters().and_then(|studio| studio.outline);
        let for_lines = lines.map_or(LayerSet::COLOR, |_| outline::LAYERS);
        let for_noise = if self.is_denoised { denoise::GUIDES } else { LayerSet::COLOR };
        wanted.iter().chain(for_lines.iter()).chain(for_noise.iter()).collect()
    }
}
