//! Settings of the studio integrator: direct light.

use std::f32::consts::PI;

use crate::image::color::LinearRgb;

/// Settings of the studio integrator: lights, shadows, ambient light, and aids for seeing shape. Surfaces that are not
/// emissive are shaded as Lambert surfaces, with the glossy lobe of their material if it has one.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize, serde::Deserialize))]
pub struct Studio {
    /// Ambient light, which arrives from all directions.
    pub ambient: LinearRgb,
    /// Ambient occlusion, which reduces ambient light; `None` for no reduction.
    pub occlusion: Option<Occlusion>,
    /// Whether lights cast shadows. Spheres that are not opaque cast no shadows.
    pub has_shadows: bool,
    /// The largest number of translucent surfaces that are visible behind each other: 1 to 64.
    pub max_surfaces: u32,
    /// Fading of colours with distance.
    pub depth_cue: Option<DepthCue>,
    /// Lines where one sphere ends and another begins.
    pub outline: Option<Outline>,
}

impl Default for Studio {
    /// Shadows and some ambient light.
    fn default() -> Self {
        Self {
            ambient: LinearRgb::gray(0.25),
            occlusion: None,
            has_shadows: true,
            max_surfaces: 16,
            depth_cue: None,
            outline: None,
        }
    }
}

/// Ambient occlusion: ambient light is reduced to the share of cosine-weighted directions in which no opaque sphere is
/// near.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize, serde::Deserialize))]
pub struct Occlusion {
    /// The largest distance, in scene units, at which a sphere occludes; `None` for any distance.
    pub radius: Option<f64>,
    /// The number of directions for each sample of a pixel: 1 to 1024.
    pub samples: u32,
}

impl Default for Occlusion {
    /// Four directions, and occlusion at any distance.
    fn default() -> Self {
        Self { radius: None, samples: 4 }
    }
}

/// Depth cueing: colours fade linearly with the distance along the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize, serde::Deserialize))]
pub struct DepthCue {
    /// Distance at which fading begins, in scene units.
    pub near: f64,
    /// Distance at which only `color` is left, in scene units; greater than `near`.
    pub far: f64,
    /// The colour to which others fade.
    pub color: LinearRgb,
}

/// Lines at edges of the data layers: between spheres where the depth jumps or the direction of the normal changes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize, serde::Deserialize))]
pub struct Outline {
    /// Width of the outline in pixels: 0.5 to 64.
    pub width: f32,
    /// Colour of the outline.
    pub color: LinearRgb,
    /// The smallest jump in depth that makes an outline, as a fraction of the depth; 0 or more.
    pub depth: f32,
    /// The smallest angle between normals that makes an outline, in radians: 0 to π.
    pub angle: f32,
}

impl Outline {
    /// Thin dark lines where the depth jumps, and none between surfaces that meet.
    #[must_use]
    pub fn thin() -> Self {
        Self {
            width: 1.2,
            color: LinearRgb::from_srgb8([0x34, 0x3a, 0x46]),
            depth: 0.01,
            angle: PI,
        }
    }
}

impl Default for Outline {
    fn default() -> Self {
        Self { width: 2.0, color: LinearRgb::BLACK, depth: 0.01, angle: 0.6 }
    }
}
