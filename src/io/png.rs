//! Writes 8-bit sRGB PNG.

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::color::to_srgb8;
use crate::image::Image;

/// The picture as a PNG file; colours beyond [0, 1] are clamped.
///
/// # Errors
/// If the picture cannot be encoded, which for sizes that PNG allows does not happen.
pub fn encode(picture: &Image) -> Result<Vec<u8>, PngError> {
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive)
        .write_image(
            &srgb8(picture.color()),
            picture.width(),
            picture.height(),
            ExtendedColorType::Rgb8,
        )
        .map_err(|error| PngError { message: error.to_string() })?;
    Ok(bytes)
}

/// The encoder's reason.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the picture cannot be written as PNG: {message}")]
pub struct PngError {
    message: String,
}

#[cfg(feature = "parallel")]
fn srgb8(color: &[[f32; 3]]) -> Vec<u8> {
    use rayon::prelude::*;
    color.par_iter().flat_map_iter(|rgb| to_srgb8(*rgb)).collect()
}

#[cfg(not(feature = "parallel"))]
fn srgb8(color: &[[f32; 3]]) -> Vec<u8> {
    color.iter().flat_map(|rgb| to_srgb8(*rgb)).collect()
}
