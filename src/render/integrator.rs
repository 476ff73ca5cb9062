//! The ways in which rays become colours.

use super::studio::Studio;
use crate::image::color::LinearRgb;
use crate::light::codes;

/// How rays become colours.
#[derive(Clone, Debug, PartialEq)]
pub enum Integrator {
    /// By what the ray through a pixel's centre meets first, without lights.
    Primary(Shading),
    /// Directly from lights to surfaces.
    Studio(Studio),
    /// Along paths, as light is scattered.
    Path(PathTracing),
}

impl Default for Integrator {
    /// Primary rays, with the light at the eye.
    fn default() -> Self {
        Self::Primary(Shading::default())
    }
}

impl Integrator {
    /// The name in files and flags.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Primary(_) => "primary",
            Self::Studio(_) => "studio",
            Self::Path(_) => "path",
        }
    }

    /// Whether the picture is of primary rays, and so not lit.
    #[must_use]
    pub const fn is_primary(&self) -> bool {
        matches!(self, Self::Primary(_))
    }
}

/// How the surface that a primary ray meets is coloured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "scene-file", derive(serde::Deserialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Shading {
    /// The sphere's own colour, everywhere.
    Flat,
    /// Lambert's cosine law with the light at the eye: the colour times the cosine of the angle
    /// between the ray and the normal.
    #[default]
    Headlight,
}

impl Shading {
    /// The name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Headlight => "headlight",
        }
    }
}

/// How primary rays become colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimarySettings {
    /// How surfaces are coloured.
    pub shading: Shading,
    /// The colour where no sphere is hit: the background, or black where the picture is transparent.
    pub background: LinearRgb,
}

impl Default for PrimarySettings {
    /// That of [`RenderSettings::default`](super::RenderSettings::default): headlight over white.
    fn default() -> Self {
        Self { shading: Shading::default(), background: LinearRgb::WHITE }
    }
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

impl LightSampling {
    /// The number that a device has.
    pub(crate) const fn code(self) -> u32 {
        match self {
            Self::Chance => codes::sampling::CHANCE,
            Self::Direct => codes::sampling::DIRECT,
            Self::Multiple => codes::sampling::MULTIPLE,
        }
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
