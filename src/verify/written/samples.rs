//! Samples of a picture as they stand in a file, and those that are legal.

use super::color::LegalColor;
use crate::image::color::{to_srgb8, to_srgb16};
use crate::image::encoding::{Bits, Encoding};
use crate::render::PrimarySettings;

/// Why a picture cannot be judged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WrittenError {
    /// The picture is not as large as the view.
    #[error("the picture is {}x{} pixels, but the view is {}x{}", found[0], found[1], view[0], view[1])]
    Size {
        /// Width and height of the picture.
        found: [u32; 2],
        /// Width and height of the view.
        view: [u32; 2],
    },
    /// There are too few or too many samples.
    #[error("the picture has {found} samples; {expected} are expected")]
    Count {
        /// The number of samples.
        found: usize,
        /// The number of samples of such a picture.
        expected: usize,
    },
}

/// The samples of a picture as they stand in its file, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub enum Samples<'a> {
    /// Samples of a PNG in sRGB: RGB, or RGBA if the encoding is transparent, each of one byte or of two with the
    /// higher first, as the encoding's bits say.
    Encoded(&'a [u8]),
    /// Linear light: red, green, blue and alpha of each pixel, as in OpenEXR.
    Linear(&'a [[f32; 4]]),
}

/// A picture as it stands in its file.
#[derive(Clone, Copy, Debug)]
pub struct WrittenPicture<'a> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The samples.
    pub samples: Samples<'a>,
    /// How the picture was encoded.
    pub encoding: &'a Encoding,
}

impl WrittenPicture<'_> {
    /// The number of bytes of a sample, and of channels of a pixel.
    fn layout(&self) -> [usize; 2] {
        let bytes = self.encoding.bits().bytes();
        match self.samples {
            Samples::Encoded(_) => [bytes, if self.encoding.transparent() { 4 } else { 3 }],
            Samples::Linear(_) => [1, 4],
        }
    }

    pub(super) fn check(&self, view: [u32; 2]) -> Result<(), WrittenError> {
        let size = self.size;
        if size != view {
            return Err(WrittenError::Size { found: size, view });
        }
        let pixels = size[0] as usize * size[1] as usize;
        let (found, expected) = match self.samples {
            Samples::Encoded(bytes) => {
                (bytes.len(), pixels * self.layout().iter().product::<usize>())
            }
            Samples::Linear(samples) => (samples.len(), pixels),
        };
        if found == expected { Ok(()) } else { Err(WrittenError::Count { found, expected }) }
    }

    /// Red, green and blue of each pixel as they stand in the file, such that white is 1.
    ///
    /// # Errors
    /// Returns an error if there are too few or too many samples.
    pub fn colors(&self) -> Result<Vec<[f64; 3]>, WrittenError> {
        self.check(self.size)?;
        let [_, channels] = self.layout();
        let white = match self.samples {
            Samples::Linear(_) => 1.0,
            Samples::Encoded(_) => f64::from(self.encoding.bits().white()),
        };
        let color = |index| {
            let [r, g, b, _] = self.at(index, channels);
            [r, g, b].map(|sample| sample / white)
        };
        Ok((0..self.size[0] as usize * self.size[1] as usize).map(color).collect())
    }

    /// The samples of a pixel.
    pub(super) fn at(&self, index: usize, channels: usize) -> [f64; 4] {
        let mut found = [0.0; 4];
        match self.samples {
            Samples::Linear(samples) => found = samples[index].map(f64::from),
            Samples::Encoded(bytes) => {
                let [size, _] = self.layout();
                let pixel = &bytes[index * size * channels..][..size * channels];
                for (found, sample) in found.iter_mut().zip(pixel.chunks_exact(size)) {
                    *found = sample.iter().fold(0.0, |sum, byte| 256.0 * sum + f64::from(*byte));
                }
            }
        }
        found
    }
}

/// The legal samples of a pixel for one answer: the least and the greatest of each channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LegalSample([[f64; 2]; 4]);

impl LegalSample {
    /// Compares a pixel with its legal samples: `None` if one of them holds it. Otherwise the first channel that is not
    /// legal in the one that holds the most channels, and what is legal there.
    pub(super) fn judge(legal: &[Self], found: &[f64; 4]) -> Option<(usize, [f64; 2])> {
        let outside = |Self(channels): &Self| {
            channels
                .iter()
                .zip(found)
                .position(|([low, high], found)| !(low <= found && found <= high))
        };
        if legal.iter().any(|legal| outside(legal).is_none()) {
            return None;
        }
        let nearest = legal.iter().filter_map(|legal| Some((outside(legal)?, legal)));
        // Without a legal answer, which does not happen, nothing is legal.
        let (channel, Self(channels)) =
            nearest.max_by_key(|(channel, _)| *channel).unwrap_or((0, &Self([[f64::NAN; 2]; 4])));
        Some((channel, channels[channel]))
    }
}

/// How legal colours become legal samples.
pub(super) struct Mapping<'a> {
    picture: &'a WrittenPicture<'a>,
    primary: &'a PrimarySettings,
}

impl<'a> Mapping<'a> {
    pub(super) fn new(picture: &'a WrittenPicture<'a>, primary: &'a PrimarySettings) -> Self {
        Self { picture, primary }
    }

    pub(super) fn channels(&self) -> usize {
        self.picture.layout()[1]
    }

    /// The legal samples for legal colours.
    pub(super) fn samples(&self, legal: &LegalColor) -> LegalSample {
        let alpha = if legal.is_hit || !self.primary.is_transparent { 1.0 } else { 0.0 };
        let WrittenPicture { samples, encoding, .. } = self.picture;
        let mut channels = [[0.0; 2]; 4];
        let Samples::Encoded(_) = samples else {
            for (channel, color) in channels.iter_mut().zip(legal.color) {
                *channel = [color.low, color.high];
            }
            channels[3] = [if encoding.transparent() { alpha } else { 1.0 }; 2];
            return LegalSample(channels);
        };
        let [low, high] = self.displayed(legal).map(|ends| encode(encoding.bits(), ends));
        for channel in 0..3 {
            channels[channel] = [low[channel], high[channel]];
        }
        if encoding.transparent() {
            channels[3] = [alpha * f64::from(encoding.bits().white()); 2];
        }
        LegalSample(channels)
    }

    /// The least and the greatest light of a display for legal colours.
    fn displayed(&self, legal: &LegalColor) -> [[f32; 3]; 2] {
        let encoding = self.picture.encoding;
        let ends = [legal.color.map(|c| down(c.low)), legal.color.map(|c| up(c.high))];
        if !legal.is_hit && (encoding.transparent() || encoding.kept_background().is_some()) {
            // The background passes through unchanged, and is black where it is transparent.
            return ends;
        }
        encoding.display_range(ends)
    }
}

/// Encodes light of a display as the writers do; brighter light never gives a smaller sample.
fn encode(bits: Bits, light: [f32; 3]) -> [f64; 3] {
    match bits {
        Bits::Eight => to_srgb8(light).map(f64::from),
        Bits::Sixteen => to_srgb16(light).map(f64::from),
    }
}

/// The greatest f32 that is not above a number.
fn down(value: f64) -> f32 {
    let near = value as f32;
    if f64::from(near) > value { near.next_down() } else { near }
}

/// The least f32 that is not below a number.
fn up(value: f64) -> f32 {
    let near = value as f32;
    if f64::from(near) < value { near.next_up() } else { near }
}
