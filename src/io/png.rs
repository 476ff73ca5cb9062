//! Writes 8-bit sRGB PNG.

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::color::to_srgb8;
use crate::image::Image;
use crate::parallel::for_each;

/// How many pixels a thread converts at a time.
const CHUNK: usize = 1 << 14;

/// The picture as a PNG file; colours beyond [0, 1] are clamped.
///
/// # Errors
/// If the picture cannot be encoded, which for sizes that PNG allows does not happen.
pub fn encode(picture: &Image) -> Result<Vec<u8>, PngError> {
    encode_rgb8([picture.width(), picture.height()], &srgb8(picture.color()))
}

/// A PNG file of so many pixels, of three bytes each.
pub(crate) fn encode_rgb8([width, height]: [u32; 2], rgb: &[u8]) -> Result<Vec<u8>, PngError> {
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive)
        .write_image(rgb, width, height, ExtendedColorType::Rgb8)
        .map_err(|error| PngError { message: error.to_string() })?;
    Ok(bytes)
}

/// The encoder's reason.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the picture cannot be written as PNG: {message}")]
pub struct PngError {
    message: String,
}

fn srgb8(color: &[[f32; 3]]) -> Vec<u8> {
    let mut bytes = vec![0; 3 * color.len()];
    let rows: Vec<_> = bytes.chunks_mut(3 * CHUNK).zip(color.chunks(CHUNK)).collect();
    for_each(rows, |(bytes, color)| {
        let (mut before, mut encoded) = ([0; 3], to_srgb8([0.0; 3]));
        for (target, rgb) in bytes.chunks_exact_mut(3).zip(color) {
            // Most of many pictures is background.
            let bits = rgb.map(f32::to_bits);
            if bits != before {
                (before, encoded) = (bits, to_srgb8(*rgb));
            }
            target.copy_from_slice(&encoded);
        }
    });
    bytes
}
