//! Direct light.

use crate::image::color::LinearRgb;

/// Lights, shadows, ambient light, and what helps to see shape. Surfaces that are not emissive are Lambert's, with the
/// lobe of their material where it has one.
#[derive(Clone, Debug, PartialEq)]
pub struct Studio {
    /// Light from everywhere.
    pub ambient: LinearRgb,
    /// How much of it arrives; without, all of it.
    pub occlusion: Option<Occlusion>,
    /// Whether lights cast shadows. Spheres that are not opaque cast none.
    pub has_shadows: bool,
    /// How many surfaces that are not opaque are seen behind each other: 1 to 64.
    pub max_surfaces: u32,
    /// Colour fades with distance.
    pub depth_cue: Option<DepthCue>,
    /// Lines where one sphere ends and another begins.
    pub outline: Option<Outline>,
}

impl Default for Studio {
    /// Shadows, some ambient light, and no more.
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

/// Ambient occlusion: the share of cosine-weighted directions in which no opaque sphere is near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occlusion {
    /// How far away a sphere may be and still count, in scene units; `None` is any distance.
    pub radius: Option<f64>,
    /// How many directions for each sample of a pixel: 1 to 1024.
    pub samples: u32,
}

impl Default for Occlusion {
    /// At any distance, four directions.
    fn default() -> Self {
        Self { radius: None, samples: 4 }
    }
}

/// Colour fades linearly with the distance along the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthCue {
    /// Where it begins, in scene units.
    pub near: f64,
    /// Where nothing else is left, in scene units; greater than `near`.
    pub far: f64,
    /// What it fades to.
    pub color: LinearRgb,
}

/// Lines at edges of the data layers: between spheres where the depth jumps or the normal turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    /// In pixels: 0.5 to 64.
    pub width: f32,
    /// Of the line.
    pub color: LinearRgb,
    /// The jump in depth that makes a line, in parts of the depth; 0 or more.
    pub depth: f32,
    /// The angle between normals that makes a line, in radians: 0 to π.
    pub angle: f32,
}

impl Default for Outline {
    fn default() -> Self {
        Self { width: 2.0, color: LinearRgb::BLACK, depth: 0.01, angle: 0.6 }
    }
}
