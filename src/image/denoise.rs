//! What a denoiser sees of a picture: light without colour, and shapes. Both denoisers, on the GPU and on the CPU,
//! start from it.

use super::color::LUMINANCE;
use crate::image::{Image, Layer, LayerSet};

/// How many passes a filter has; each reaches twice as far as the one before.
pub(crate) const PASSES: u32 = 5;

/// A picture lacks a layer without which it cannot be denoised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a picture is denoised by its layers normal, depth, albedo and variance; it has no layer `{missing}`"
)]
pub struct MissingGuide {
    /// The layer.
    pub missing: Layer,
}

/// The layers by which a picture is denoised, beside its colour.
pub const GUIDES: LayerSet = LayerSet::COLOR
    .with(Layer::Normal)
    .with(Layer::Depth)
    .with(Layer::Albedo)
    .with(Layer::Variance);

/// What is filtered, and what it is guided by; each row by row.
#[derive(Clone, Debug)]
pub(crate) struct Guided {
    /// Colour over albedo, and the variance of its luminance.
    pub(crate) lights: Vec<[f32; 4]>,
    /// Normal, zero for a miss, and depth.
    pub(crate) shapes: Vec<[f32; 4]>,
    /// What light is multiplied by.
    pub(crate) albedos: Vec<[f32; 4]>,
}

impl Guided {
    /// Of a picture that has been lit.
    pub(crate) fn of(image: &Image) -> Result<Self, MissingGuide> {
        let missing = |missing| move || MissingGuide { missing };
        let normals = image.normal().ok_or_else(missing(Layer::Normal))?;
        let depths = image.depth().ok_or_else(missing(Layer::Depth))?;
        let albedos = image.albedo().ok_or_else(missing(Layer::Albedo))?;
        let variances = image.variance().ok_or_else(missing(Layer::Variance))?;
        // Where there is no colour to divide by, light is what is seen.
        let albedos: Vec<[f32; 4]> = albedos
            .iter()
            .map(|rgb| {
                let [r, g, b] = rgb.map(|c| if c < 0.01 { 1.0 } else { c });
                [r, g, b, 0.0]
            })
            .collect();
        let [red, green, blue] = LUMINANCE.map(|weight| weight as f32);
        let lights = image.color().iter().zip(&albedos).zip(variances);
        let shapes = normals.iter().zip(depths);
        Ok(Self {
            lights: lights
                .map(|(([r, g, b], [x, y, z, _]), variance)| {
                    let albedo = red * x + green * y + blue * z;
                    [r / x, g / y, b / z, variance / (albedo * albedo)]
                })
                .collect(),
            shapes: shapes
                .map(|([x, y, z], depth)| {
                    [*x, *y, *z, if depth.is_finite() { *depth } else { 0.0 }]
                })
                .collect(),
            albedos,
        })
    }

    /// The picture's colour, of filtered light.
    pub(crate) fn colors(&self, lights: impl Iterator<Item = [f32; 4]>) -> Vec<[f32; 3]> {
        lights
            .zip(&self.albedos)
            .map(|([r, g, b, _], [x, y, z, _])| [r * x, g * y, b * z])
            .collect()
    }
}
