//! Integrators: the algorithms that turn rays into colours, and their settings.

use crate::geometry::math::{MAX_LENGTH, MIN_LENGTH};
use crate::image::color::LinearRgb;
use crate::image::outline::Outline;
use crate::light::codes;
use crate::range::RangeError;

/// The algorithm that turns rays into colours.
#[derive(Clone, Debug, PartialEq)]
pub enum Integrator {
    /// Colours the surface that the ray through a pixel's centre hits first. Uses no lights.
    Primary(Shading),
    /// Direct light from lights to surfaces, with aids for seeing shape.
    Studio(Studio),
    /// Path tracing, which follows light as surfaces scatter it.
    Path(PathTracing),
}

impl Default for Integrator {
    /// Primary rays, with surfaces lit from the eye.
    fn default() -> Self {
        Self::Primary(Shading::default())
    }
}

impl Integrator {
    /// The name in scene files and flags.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Primary(_) => "primary",
            Self::Studio(_) => "studio",
            Self::Path(_) => "path",
        }
    }

    /// Returns true if the integrator traces primary rays only, so that the picture has no lighting.
    #[must_use]
    pub const fn is_primary(&self) -> bool {
        matches!(self, Self::Primary(_))
    }
}

/// The shading of the surface that a primary ray hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shading {
    /// The colour of the sphere, without any shading.
    Flat,
    /// Lambert's cosine law with the light at the eye. The colour is multiplied by the cosine of the angle between the
    /// ray and the normal.
    #[default]
    Headlight,
}

impl Shading {
    /// The name in scene files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Headlight => "headlight",
        }
    }
}

/// Settings that turn primary rays into colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimarySettings {
    /// The shading of surfaces.
    pub shading: Shading,
    /// The colour where no sphere is hit. It is the background, or black if the picture is transparent.
    pub background: LinearRgb,
    /// Whether pixels without a sphere get the alpha 0, in targets that have alpha.
    pub is_transparent: bool,
}

impl Default for PrimarySettings {
    /// The settings of [`RenderSettings::default`](super::RenderSettings::default): headlight over white.
    fn default() -> Self {
        Self { shading: Shading::default(), background: LinearRgb::WHITE, is_transparent: false }
    }
}

/// Settings of the path integrator.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PathTracing {
    /// The largest number of surfaces that a path hits, including those that it passes through: 1 to 64.
    pub max_depth: u32,
    /// The first surface, counted from 0, at which paths that carry little light may end at random (Russian roulette).
    pub roulette_from: u32,
    /// The sampling method of lights that scattered rays can hit.
    pub light_sampling: LightSampling,
}

impl Default for PathTracing {
    /// Eight surfaces, Russian roulette from the fourth, and multiple importance sampling.
    fn default() -> Self {
        Self { max_depth: 8, roulette_from: 3, light_sampling: LightSampling::default() }
    }
}

impl PathTracing {
    /// Checks that every number is in its range.
    ///
    /// # Errors
    /// Returns an error if a number is out of range. The error names the first one.
    pub fn check(&self) -> Result<(), RangeError> {
        let within = RangeError::unless_within;
        within("max_depth", self.max_depth.into(), [1.0, 64.0], "from 1 to 64").map(drop)
    }
}

impl LightSampling {
    /// The code of the method on a device.
    pub(crate) const fn code(self) -> u32 {
        match self {
            Self::Chance => codes::sampling::CHANCE,
            Self::Direct => codes::sampling::DIRECT,
            Self::Multiple => codes::sampling::MULTIPLE,
        }
    }
}

/// The sampling method of emissive spheres, a sun and the image of a sky.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum LightSampling {
    /// Only by scattered rays that happen to hit a light.
    Chance,
    /// Only by rays towards lights, from every surface that is not glass.
    Direct,
    /// By both, weighted with the balance heuristic (Veach and Guibas 1995).
    #[default]
    Multiple,
}

/// Settings of the studio integrator: lights, shadows, ambient light, and aids for seeing shape. Surfaces that are not
/// emissive are shaded as Lambert surfaces, with the glossy lobe of their material if it has one.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Studio {
    /// Ambient light, which arrives from all directions.
    pub ambient: LinearRgb,
    /// Ambient occlusion, which reduces ambient light. `None` for no reduction.
    pub occlusion: Option<Occlusion>,
    /// Whether lights cast shadows. Spheres that are not opaque cast no shadows.
    pub shadows: bool,
    /// True for a picture without chance, and so without noise, where spheres are opaque and have no gloss, there are no
    /// ground, lens or denoising, and lights are at the eye, or infinitely far away with an angular radius of at most 15°.
    /// Other pictures take random rays.
    #[serde(rename = "smooth")]
    pub is_smooth: bool,
    /// True if all pixels of a smooth picture have rays at fixed places, their number being the odd square that is nearest
    /// to that of samples, and not only pixels at edges. Otherwise spheres that are smaller than pixels may be missed.
    #[serde(rename = "dense")]
    pub is_dense: bool,
    /// True if spheres shine through each other and are not lit, as stars. The light of a pixel is the sum over all spheres
    /// of their colour, times their opacity, times the part of the pixel that their disk covers, in linear light. It is
    /// exposed so that one in ten pixels with light is brighter than 1/3, and compressed, so that none is brighter than 1.
    /// Choose a dark background. Lenses have no effect on it. Nothing is random. Pictures in frames of host programs do not
    /// have it: they light spheres.
    pub added_light: bool,
    /// The largest number of translucent surfaces that are visible behind each other: 1 to 64.
    pub max_surfaces: u32,
    /// Fading of colours with distance.
    pub depth_cue: Option<DepthCue>,
    /// Lines at the borders between spheres.
    pub outline: Option<Outline>,
}

impl Default for Studio {
    /// Shadows and some ambient light.
    fn default() -> Self {
        Self {
            ambient: LinearRgb::gray(0.25),
            occlusion: None,
            shadows: true,
            is_smooth: false,
            is_dense: false,
            added_light: false,
            max_surfaces: 16,
            depth_cue: None,
            outline: None,
        }
    }
}

impl Studio {
    /// Checks that every number is in its range.
    ///
    /// # Errors
    /// Returns an error if a number is out of range. The error names the first one.
    pub fn check(&self) -> Result<(), RangeError> {
        let most = self.max_surfaces.into();
        RangeError::unless_within("max_surfaces", most, [1.0, 64.0], "from 1 to 64")?;
        self.occlusion.iter().try_for_each(Occlusion::check)?;
        self.depth_cue.iter().try_for_each(DepthCue::check)?;
        self.outline.iter().try_for_each(Outline::check)
    }
}

/// Ambient occlusion, which reduces ambient light to the share of cosine-weighted directions in which no opaque sphere
/// is near.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Occlusion {
    /// The largest distance, in scene units, at which a sphere occludes. `None` for any distance.
    pub radius: Option<f64>,
    /// The number of directions per sample of a pixel: 1 to 1024.
    pub samples: u32,
}

impl Default for Occlusion {
    /// Four random directions, and occlusion at any distance.
    fn default() -> Self {
        Self { radius: None, samples: 4 }
    }
}

impl Occlusion {
    /// Checks that every number is in its range.
    ///
    /// # Errors
    /// Returns an error if a number is out of range. The error names the first one.
    pub fn check(&self) -> Result<(), RangeError> {
        let within = RangeError::unless_within;
        within("samples", self.samples.into(), [1.0, 1024.0], "from 1 to 1024")?;
        let range = "a length greater than 0, from 2^-56 to 2^56";
        self.radius.map_or(Ok(()), |r| within("radius", r, [MIN_LENGTH, MAX_LENGTH], range).map(drop))
    }
}

/// Depth cueing: colours fade linearly with the distance along the ray.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DepthCue {
    /// Distance at which fading begins, in scene units.
    pub near: f64,
    /// Distance at which only `color` is left, in scene units. It must be greater than `near`.
    pub far: f64,
    /// The colour to which others fade.
    pub color: LinearRgb,
}

impl DepthCue {
    /// Checks that every number is in its range.
    ///
    /// # Errors
    /// Returns an error if a number is out of range. The error names the first one.
    pub fn check(&self) -> Result<(), RangeError> {
        let within = RangeError::unless_within;
        within("near", self.near, [0.0, MAX_LENGTH], "0 or more, and less than 2^56")?;
        within("far", self.far, [self.near.max(MIN_LENGTH), MAX_LENGTH], "more than `near`")?;
        let range = "more than `near`";
        let far = RangeError { parameter: "far", value: self.far, range };
        if self.far > self.near { Ok(()) } else { Err(far) }
    }
}
