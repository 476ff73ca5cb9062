//! How hits and misses become colours.

use crate::color::LinearRgb;

/// How a sphere's surface is coloured.
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

/// What a render needs to know beside scene, camera and film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    shading: Shading,
    background: LinearRgb,
}

impl Default for Settings {
    /// Headlight over white.
    fn default() -> Self {
        Self { shading: Shading::default(), background: LinearRgb::WHITE }
    }
}

impl Settings {
    /// The same with another shading.
    #[must_use]
    pub fn with_shading(self, shading: Shading) -> Self {
        Self { shading, ..self }
    }

    /// The same with another background.
    #[must_use]
    pub fn with_background(self, background: LinearRgb) -> Self {
        Self { background, ..self }
    }

    /// How surfaces are coloured.
    #[must_use]
    pub fn shading(&self) -> Shading {
        self.shading
    }

    /// The colour where no sphere is hit.
    #[must_use]
    pub fn background(&self) -> LinearRgb {
        self.background
    }
}
