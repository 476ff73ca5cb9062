//! Writes pictures as PNG files in sRGB.

use png::{BitDepth, ColorType, Compression, Filter, PixelDimensions, SrgbRenderingIntent, Unit};

use crate::annotate::Annotations;
use pinhole::image::color::{to_srgb8, to_srgb16};
use pinhole::image::encoding::{Bits, Encoding};
use pinhole::image::{Image, Layer};
use pinhole::internals::parallel::for_each;

/// The keyword of the text that holds a picture's certificate.
pub const CERTIFICATE: &str = "pinhole-certificate";

/// Number of pixels that a thread converts at a time.
const CHUNK: usize = 1 << 14;

/// Encodes a picture as a PNG file in sRGB with 8 or 16 bits per channel: RGB, or RGBA if the encoding is transparent.
/// The exposure and the tone curve are applied to the colours, which are then clamped to [0, 1]. Both leave [the
/// background](Encoding::background) unchanged.
///
/// PNG stores colours that are not premultiplied, so the colours of a transparent picture are first divided by alpha.
/// They are black where alpha is zero.
///
/// # Errors
/// Returns an error if the picture lacks one of [the layers that the encoding needs](Encoding::layers), or if the
/// encoder fails, which does not happen for sizes that PNG allows.
pub fn encode(picture: &Image, encoding: &Encoding) -> Result<Vec<u8>, PngError> {
    encode_samples(picture, encoding, &samples(picture, encoding)?)
}

/// Encodes a picture as [`encode`] does, and draws annotations over it, which exposure and tone curve do not change.
///
/// # Errors
/// Returns the same errors as [`encode`].
pub fn encode_annotated(picture: &Image, encoding: &Encoding, annotations: &Annotations) -> Result<Vec<u8>, PngError> {
    encode_samples(picture, encoding, &samples_annotated(picture, encoding, annotations)?)
}

/// The samples of a picture that [`encode`] would compress: RGB or, if the encoding is transparent, RGBA, row by row
/// from the top, each of one byte, or of two with the high byte first.
///
/// # Errors
/// Returns an error if the picture lacks one of [the layers that the encoding needs](Encoding::layers).
pub fn samples(picture: &Image, encoding: &Encoding) -> Result<Vec<u8>, PngError> {
    let alpha = match encoding.layers().contains(Layer::Alpha) {
        true => Some(picture.alpha().ok_or(PngError::MissingAlpha)?),
        false => None,
    };
    let pixels = Pixels { color: picture.color(), alpha, encoding };
    Ok(match encoding.bits {
        Bits::Eight => pixels.samples(to_srgb8, |alpha| [(255.0 * unit(alpha)).round() as u8]),
        Bits::Sixteen => {
            let big_endian = |sample: u16| sample.to_be_bytes();
            let alpha_sample = |alpha| big_endian((65535.0 * unit(alpha)).round() as u16);
            let rgb = |rgb| {
                let [[a, b], [c, d], [e, f]] = to_srgb16(rgb).map(big_endian);
                [a, b, c, d, e, f]
            };
            pixels.samples(rgb, alpha_sample)
        }
    })
}

/// The samples of a picture that [`encode_annotated`] would compress, for movies: RGB or, if the encoding is
/// transparent, RGBA, row by row from the top, each of one byte, or of two with the high byte first.
///
/// # Errors
/// Returns an error if the picture lacks one of [the layers that the encoding needs](Encoding::layers).
pub fn samples_annotated(picture: &Image, encoding: &Encoding, annotations: &Annotations) -> Result<Vec<u8>, PngError> {
    let mut samples = samples(picture, encoding)?;
    annotations.draw_over([picture.width(), picture.height()], encoding, &mut samples);
    Ok(samples)
}

fn encode_samples(image: &Image, encoding: &Encoding, samples: &[u8]) -> Result<Vec<u8>, PngError> {
    let size = [image.width(), image.height()];
    write(size, kind(encoding), encoding.dots_per_inch(), None, samples)
}

/// Encodes samples that [`samples`] returned for the same encoding as a PNG file, which carries a certificate as a text.
///
/// # Errors
/// Returns an error if the samples are not those of a picture of this size, or if the certificate is not ASCII.
pub fn encode_certified(
    size: [u32; 2],
    encoding: &Encoding,
    samples: &[u8],
    certificate: &str,
) -> Result<Vec<u8>, PngError> {
    write(size, kind(encoding), encoding.dots_per_inch(), Some(certificate), samples)
}

fn kind(encoding: &Encoding) -> (ColorType, BitDepth) {
    let color = if encoding.transparent { ColorType::Rgba } else { ColorType::Rgb };
    match encoding.bits {
        Bits::Eight => (color, BitDepth::Eight),
        Bits::Sixteen => (color, BitDepth::Sixteen),
    }
}

/// Encodes sRGB bytes as a PNG file. `size` is the width and height; `rgb` has three bytes per pixel, row by row from
/// the top.
///
/// # Errors
/// Returns an error if `rgb` does not have three bytes per pixel.
pub fn encode_rgb8(size: [u32; 2], rgb: &[u8]) -> Result<Vec<u8>, PngError> {
    write(size, (ColorType::Rgb, BitDepth::Eight), None, None, rgb)
}

/// Encodes sRGB bytes with alpha as a PNG file. `size` is the width and height; `rgba` has four bytes per pixel, row by
/// row from the top. Colours are not premultiplied.
///
/// # Errors
/// Returns an error if `rgba` does not have four bytes per pixel.
pub fn encode_rgba8(size: [u32; 2], rgba: &[u8]) -> Result<Vec<u8>, PngError> {
    write(size, (ColorType::Rgba, BitDepth::Eight), None, None, rgba)
}

fn write(
    size: [u32; 2],
    kind: (ColorType, BitDepth),
    dots_per_inch: Option<f32>,
    certificate: Option<&str>,
    samples: &[u8],
) -> Result<Vec<u8>, PngError> {
    // PNG counts pixels per metre; an inch is 0.0254 m.
    let per_metre = dots_per_inch.map(|dots| (f64::from(dots) / 0.0254).round() as u32);
    let mut bytes = Vec::new();
    let mut writer = begin(&mut bytes, size, kind, per_metre, certificate)?;
    writer.write_image_data(samples)?;
    writer.finish()?;
    Ok(bytes)
}

/// Writes everything that comes before the samples. A writer that is dropped writes the end of the file.
pub(crate) fn begin<'a>(
    bytes: &'a mut Vec<u8>,
    [width, height]: [u32; 2],
    (color, depth): (ColorType, BitDepth),
    per_metre: Option<u32>,
    certificate: Option<&str>,
) -> Result<png::Writer<&'a mut Vec<u8>>, PngError> {
    let mut encoder = png::Encoder::new(bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    encoder.set_pixel_dims(per_metre.map(|count| PixelDimensions { xppu: count, yppu: count, unit: Unit::Meter }));
    if let Some(certificate) = certificate {
        encoder.add_text_chunk(CERTIFICATE.into(), certificate.into())?;
    }
    Ok(encoder.write_header()?)
}

/// An error of encoding a PNG file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PngError {
    /// The picture was rendered without the layer alpha.
    #[error("this encoding needs the layer alpha; ask for it when rendering")]
    MissingAlpha,
    /// The encoder failed.
    #[error("the picture cannot be written as PNG: {message}")]
    Encoder {
        /// The message of the encoder.
        message: String,
    },
}

impl From<png::EncodingError> for PngError {
    fn from(error: png::EncodingError) -> Self {
        Self::Encoder { message: error.to_string() }
    }
}

/// The pixels of a picture, with their encoding.
struct Pixels<'a> {
    color: &'a [[f32; 3]],
    /// Alpha, if the encoding needs it.
    alpha: Option<&'a [f32]>,
    encoding: &'a Encoding,
}

impl Pixels<'_> {
    /// Encodes all pixels: `RGB` bytes for each colour and, if the picture is transparent, `A` bytes for alpha.
    fn samples<const RGB: usize, const A: usize>(
        &self,
        of_color: impl Fn([f32; 3]) -> [u8; RGB] + Sync + Send,
        of_alpha: impl Fn(f32) -> [u8; A] + Sync + Send,
    ) -> Vec<u8> {
        let size = RGB + if self.encoding.transparent { A } else { 0 };
        let mut bytes = vec![0; size * self.color.len()];
        let chunks = bytes.chunks_mut(size * CHUNK).zip(self.color.chunks(CHUNK)).enumerate();
        for_each(chunks.collect(), |(index, (bytes, color))| {
            let start = index * CHUNK;
            let (mut before, mut encoded) = (None, [0; RGB]);
            for (index, (pixel, rgb)) in bytes.chunks_exact_mut(size).zip(color).enumerate() {
                let alpha = self.alpha.map_or(1.0, |alpha| alpha[start + index]);
                // Large areas of many pictures, such as the background, have a single colour.
                let [r, g, b] = rgb.map(f32::to_bits);
                let bits = Some([r, g, b, alpha.to_bits()]);
                if bits != before {
                    (before, encoded) = (bits, of_color(self.shown(*rgb, alpha)));
                }
                let (target, rest) = pixel.split_at_mut(RGB);
                target.copy_from_slice(&encoded);
                if !rest.is_empty() {
                    rest.copy_from_slice(&of_alpha(alpha));
                }
            }
        });
        bytes
    }

    /// Converts a pixel to the linear light that a display shows.
    fn shown(&self, rgb: [f32; 3], alpha: f32) -> [f32; 3] {
        match self.encoding.kept_background() {
            Some(background) => self.encoding.display_over(rgb, alpha, background),
            None if self.encoding.transparent => self.encoding.display(divided(rgb, alpha)),
            None => self.encoding.display(rgb),
        }
    }
}

fn divided(rgb: [f32; 3], alpha: f32) -> [f32; 3] {
    if alpha > 0.0 { rgb.map(|x| x / alpha) } else { [0.0; 3] }
}

fn unit(alpha: f32) -> f32 {
    alpha.clamp(0.0, 1.0)
}
