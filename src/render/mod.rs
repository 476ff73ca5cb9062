//! Render settings: the rays that are traced, the lights of the scene, and the background where there is no sphere.
//!
//! [`Integrator::Primary`] traces one ray through the centre of each pixel and colours the surface that it hits first,
//! without lights. [`Integrator::Studio`] is direct and fast. It has lights with shadows, ambient occlusion, opacity,
//! outlines and depth cueing. [`Integrator::Path`] follows light as it is scattered. The last two make pictures with
//! lighting and take many samples for each pixel. Samples are addressed by (pixel, sample, dimension), so that a
//! picture depends only on scene, size, number of samples and seed.
//!
//! # Units
//! A surface of colour c that faces a directional light of `strength` 1 has the radiance c. All radiances are in this
//! unit. So a sky of radiance 1 in all directions makes a white Lambert surface white.

use crate::camera::filter::PixelFilter;
use crate::image::LayerSet;
use crate::image::color::LinearRgb;
use crate::image::denoise;
use crate::light::{Ground, Light, LightFrame, LightKind, Sky};
use crate::range::RangeError;

mod check;
mod integrator;
mod nearest;
mod notes;
mod progress;

pub use crate::image::outline::Outline;
pub use check::BRIGHTEST;
pub use check::SettingsError;
pub use integrator::{DepthCue, Integrator, LightSampling, Occlusion, PathTracing, PrimarySettings, Shading, Studio};
pub use nearest::{NearestPicture, NotOfOneScene};
pub use progress::{Decision, Picture, Progress, Watch};
pub(crate) use progress::{Totals, batch};

/// All settings of a picture apart from the scene and the view.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSettings {
    /// The algorithm that turns rays into colours.
    pub integrator: Integrator,
    /// The number of samples for each pixel, their positions in the pixel, and the random seed. The integrator
    /// `primary` has one sample for each pixel, at its centre.
    pub sampling: Sampling,
    /// Lights that are not spheres of the scene, for pictures with lighting. They are invisible, except for a sun.
    pub lights: Vec<Light>,
    /// The sky around the scene. Only the integrator `path` uses it.
    pub sky: Sky,
    /// A plane below the scene. Only pictures with lighting use it.
    pub ground: Option<Ground>,
    /// The colour where a ray hits nothing, unless the sky is visible.
    pub background: LinearRgb,
    /// Whether pixels are transparent where rays hit nothing. If so, colours are premultiplied by alpha.
    pub is_transparent: bool,
}

/// The number of samples, their positions, the random seed, and the removal of noise.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sampling {
    /// The number of samples for each pixel: 1 to 2²⁴.
    pub samples: u32,
    /// Seed of the random numbers. Another seed gives different noise.
    pub seed: u32,
    /// The filter that places samples around the centre of a pixel.
    pub filter: PixelFilter,
    /// Whether a filter that is guided by shapes and colours removes noise, in pictures with lighting: the module
    /// `image::denoise`.
    pub denoise: bool,
}

impl Sampling {
    /// The largest number of samples for each pixel, 2²⁴.
    pub const MAX_SAMPLES: u32 = 1 << 24;

    /// Checks that the number of samples is in its range.
    ///
    /// # Errors
    /// Returns an error if the number of samples is out of range.
    pub fn check(&self) -> Result<(), RangeError> {
        let most = f64::from(Self::MAX_SAMPLES);
        let range = "from 1 to 16777216";
        RangeError::unless_within("samples", self.samples.into(), [1.0, most], range).map(drop)
    }
}

impl Default for Sampling {
    /// Sixteen samples, as for a picture with lighting.
    fn default() -> Self {
        Self { samples: 16, seed: 0, filter: PixelFilter::default(), denoise: false }
    }
}

impl Default for RenderSettings {
    /// One primary ray through the centre of each pixel. Surfaces are lit from the eye, over white.
    fn default() -> Self {
        Self {
            integrator: Integrator::default(),
            sampling: Sampling { samples: 1, ..Sampling::default() },
            lights: Vec::new(),
            sky: Sky::default(),
            ground: None,
            background: LinearRgb::WHITE,
            is_transparent: false,
        }
    }
}

impl RenderSettings {
    /// The studio integrator with a key light and a fill light at the camera, and soft ambient light, over white.
    #[must_use]
    pub fn studio() -> Self {
        Self {
            integrator: Integrator::Studio(Studio::default()),
            sampling: Sampling::default(),
            lights: Light::key_and_fill().to_vec(),
            ..Self::default()
        }
    }

    /// The path integrator with the same two lights and a soft sky that the camera does not see, over white.
    #[must_use]
    pub fn path() -> Self {
        Self { integrator: Integrator::Path(PathTracing::default()), ..Self::studio() }
    }

    /// The picture with several samples per pixel, which smooth its edges. A picture by primary rays becomes one
    /// of the integrator `studio` with the same light: a light at the eye, or for [`Shading::Flat`] only ambient light.
    /// Other settings do not change.
    #[must_use]
    pub fn with_smooth_edges(&self) -> Self {
        let Integrator::Primary(shading) = self.integrator else { return self.clone() };
        let (ambient, head) = match shading {
            Shading::Flat => (LinearRgb::WHITE, LinearRgb::BLACK),
            Shading::Headlight => (LinearRgb::BLACK, LinearRgb::WHITE),
        };
        let studio = Studio { ambient, shadows: false, ..Studio::default() };
        let light = Light { kind: LightKind::Head { strength: head }, frame: LightFrame::World };
        Self {
            integrator: Integrator::Studio(studio),
            sampling: Sampling::default(),
            lights: vec![light],
            ..self.clone()
        }
    }

    /// The background. `None` if the camera sees a sky in its place.
    #[must_use]
    pub fn visible_background(&self) -> Option<LinearRgb> {
        let is_sky = matches!(self.integrator, Integrator::Path(_)) && self.sky.is_visible;
        (!is_sky).then_some(self.background)
    }

    /// Settings with only primary rays and the same background. Lights, samples, sky, ground and denoising return to
    /// their defaults. The shading stays if it was set.
    #[must_use]
    pub fn by_primary_rays(&self) -> Self {
        let Self { background, is_transparent, .. } = *self;
        let shading = self.primary().map(|primary| primary.shading).unwrap_or_default();
        Self { integrator: Integrator::Primary(shading), background, is_transparent, ..Self::default() }
    }

    /// Settings that turn primary rays into colours. `None` for other integrators.
    #[must_use]
    pub fn primary(&self) -> Option<PrimarySettings> {
        match self.integrator {
            Integrator::Primary(shading) => {
                let background = if self.is_transparent { LinearRgb::BLACK } else { self.background };
                Some(PrimarySettings { shading, background, is_transparent: self.is_transparent })
            }
            Integrator::Studio(_) | Integrator::Path(_) => None,
        }
    }

    /// The parameters of the studio integrator. `None` for other integrators.
    #[must_use]
    pub fn studio_parameters(&self) -> Option<&Studio> {
        match &self.integrator {
            Integrator::Studio(studio) => Some(studio),
            Integrator::Primary(_) | Integrator::Path(_) => None,
        }
    }

    /// The settings with or without the removal of noise.
    #[must_use]
    pub fn with_denoise(&self, denoise: bool) -> Self {
        let sampling = Sampling { denoise, ..self.sampling };
        Self { sampling, ..self.clone() }
    }

    /// The settings without denoising and outlines, which read neighbours of pixels. Use them for parts of a film.
    /// After joining the parts, [`cpu::finish`](crate::cpu::finish) or `Headless::finish` completes the picture.
    #[must_use]
    pub fn unfinished(&self) -> Self {
        let mut settings = self.with_denoise(false);
        if let Integrator::Studio(studio) = &mut settings.integrator {
            studio.outline = None;
        }
        settings
    }

    /// The layers that rendering needs, including those that are wanted in the result. Outlines and denoising need data
    /// layers.
    #[must_use]
    pub fn layers_for(&self, wanted: LayerSet) -> LayerSet {
        let lines = self.studio_parameters().and_then(|studio| studio.outline);
        let for_lines = lines.map_or(LayerSet::COLOR, |lines| lines.layers());
        let for_noise = if self.sampling.denoise { denoise::GUIDES } else { LayerSet::COLOR };
        wanted.iter().chain(for_lines.iter()).chain(for_noise.iter()).collect()
    }
}
