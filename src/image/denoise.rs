//! The input of a denoiser, on the GPU and on the CPU: light divided by surface colour, and the shapes that guide the
//! filter.

use super::color::LUMINANCE;
use crate::image::{Image, Layer, LayerSet};

/// The number of passes of the filter. Each reaches twice as far as the previous one.
pub(crate) const PASSES: u32 = 5;

/// The largest distance in pixels, along each axis, from which the filter mixes light into a pixel.
pub const REACH: u32 = 2 * ((1 << PASSES) - 1);

/// An error for a picture that lacks a layer that denoising needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("denoising needs the layers normal, depth, albedo and variance; the picture has no layer `{missing}`")]
pub struct MissingGuide {
    /// The missing layer.
    pub missing: Layer,
}

/// The layers that guide the denoiser, and the colour that it filters.
pub const GUIDES: LayerSet =
    LayerSet::COLOR.with(Layer::Normal).with(Layer::Depth).with(Layer::Albedo).with(Layer::Variance);

/// The smallest albedo by which light is divided.
const LEAST_ALBEDO: f32 = 0.01;

/// The divisors of a pixel's colour channels, which give the light on its surface: the albedo. A channel without
/// surface colour that still shines, as in a highlight, is not divided. A dark one, such as green on a red sphere, is
/// divided by the smallest albedo, so that the light of white neighbours does not bleach it.
fn divisors(albedo: [f32; 3], color: [f32; 3]) -> [f32; 3] {
    let has_color = albedo.iter().any(|c| *c >= LEAST_ALBEDO);
    std::array::from_fn(|i| match albedo[i] {
        c if c >= LEAST_ALBEDO => c,
        _ if has_color && color[i] < LEAST_ALBEDO => LEAST_ALBEDO,
        _ => 1.0,
    })
}

/// The light to be filtered and the layers that guide the filter, row by row from the top.
#[derive(Clone, Debug)]
pub(crate) struct Guides {
    /// Colour divided by albedo, and the variance of its luminance.
    pub(crate) lights: Vec<[f32; 4]>,
    /// Normal and depth. Both are zero for a miss.
    pub(crate) shapes: Vec<[f32; 4]>,
    /// The albedo by which filtered light is multiplied.
    pub(crate) albedos: Vec<[f32; 4]>,
}

impl Guides {
    /// Collects the layers of a picture that has been rendered with light.
    pub(crate) fn of(image: &Image) -> Result<Self, MissingGuide> {
        let missing = |missing| move || MissingGuide { missing };
        let normals = image.normal().ok_or_else(missing(Layer::Normal))?;
        let depths = image.depth().ok_or_else(missing(Layer::Depth))?;
        let albedos = image.albedo().ok_or_else(missing(Layer::Albedo))?;
        let variances = image.variance().ok_or_else(missing(Layer::Variance))?;
        let albedos: Vec<[f32; 4]> = albedos
            .iter()
            .zip(image.color())
            .map(|(albedo, color)| {
                let [r, g, b] = divisors(*albedo, *color);
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
                .map(|([x, y, z], depth)| [*x, *y, *z, if depth.is_finite() { *depth } else { 0.0 }])
                .collect(),
            albedos,
        })
    }

    /// The colours of the picture, which are filtered light multiplied by albedo.
    pub(crate) fn colors(&self, lights: impl Iterator<Item = [f32; 4]>) -> Vec<[f32; 3]> {
        lights.zip(&self.albedos).map(|([r, g, b, _], [x, y, z, _])| [r * x, g * y, b * z]).collect()
    }
}
