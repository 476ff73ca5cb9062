//! The colours that a conforming device may find for a pixel, and the samples in a file that are legal for them.

use crate::camera::View;
use crate::geometry::math::wide;
use crate::image::color::{to_srgb8, to_srgb16};
use crate::image::encoding::{Bits, Encoding};
use crate::recording::RequestedCamera;
use crate::render::PrimarySettings;
use crate::verify::camera::CameraModel;
use crate::verify::certificate::Verdict;
use crate::verify::checker::Checker;
use crate::verify::hit::LegalHits;
use crate::verify::normals::LegalNormals;
use crate::verify::rounding::{Interval, U, down, up};
use crate::verify::sphere::{exactly, legal_color};
use crate::verify::uploaded::expected_view;

/// Legal colours: the colours of one side of a shape, or the colour of a miss.
#[derive(Clone, Copy, Debug)]
pub(super) struct LegalColor {
    /// Linear red, green and blue.
    pub(super) color: [Interval; 3],
    pub(super) is_hit: bool,
}

pub(super) struct PictureCheck<'a> {
    checker: &'a Checker<'a>,
    model: CameraModel,
    primary: &'a PrimarySettings,
    /// The distance between rays that start at different places along the axis, because their origins are rounded.
    moved: f64,
}

impl<'a> PictureCheck<'a> {
    pub(super) fn new(checker: &'a Checker<'a>, view: &View<'_>, primary: &'a PrimarySettings) -> Self {
        let requested = RequestedCamera::of(view.camera);
        let uploaded = expected_view(&requested, checker.scene.origin(), checker.candidates.bounds());
        let model = CameraModel::new(requested.kind, &uploaded, &view.film);
        // A device may choose another start, up to the size of the box away.
        let moved = 2.0 * U * (wide(uploaded.origin).length() + model.diagonal());
        Self { checker, model, primary, moved }
    }

    /// The legal colours of a pixel. The verdict says whether there is a single legal answer.
    pub(super) fn legal(&self, pixel: [u32; 2]) -> (Verdict, Vec<LegalColor>) {
        let (mut hits, mut colors) = (LegalHits::default(), Vec::new());
        hits.clear();
        if !self.checker.scene.is_empty() {
            self.find(pixel, &mut hits, &mut colors);
        }
        if hits.miss {
            let color = self.primary.background.to_array().map(exactly);
            colors.push(LegalColor { color, is_hit: false });
        }
        (Verdict::of(&hits), colors)
    }

    /// Finds the shapes that may be hit, and their colours.
    fn find(&self, pixel: [u32; 2], hits: &mut LegalHits, colors: &mut Vec<LegalColor>) {
        let ray = self.model.ray(pixel).any(&self.model).moved(self.moved);
        ray.find(&self.checker.candidates, hits);
        let scene = self.checker.scene;
        for hit in &hits.spheres {
            let normals = LegalNormals::new(&ray.line, scene.shared_shapes().shape(hit.id), ray.slack);
            let own = scene.color(hit.id).to_array();
            colors.extend(normals.crossings().map(|normal| LegalColor {
                color: legal_color(self.primary.shading, own, normal, ray.direction),
                is_hit: true,
            }));
        }
    }
}

/// Why a picture cannot be judged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct WrittenError(String);

/// The samples of a picture as they are in its file, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub enum Samples<'a> {
    /// Samples of a PNG in sRGB: RGB, or RGBA if the encoding is transparent, each of one byte or of two with the
    /// higher first, as the encoding's bits say.
    Encoded(&'a [u8]),
    /// Linear light: red, green, blue and alpha of each pixel, as in OpenEXR.
    Linear(&'a [[f32; 4]]),
}

/// A picture as it is in its file.
#[derive(Clone, Copy, Debug)]
pub struct WrittenPicture<'a> {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The samples.
    pub samples: Samples<'a>,
    /// The settings with which the picture was encoded.
    pub encoding: &'a Encoding,
}

impl WrittenPicture<'_> {
    /// The number of bytes of a sample, and of channels of a pixel.
    fn layout(&self) -> [usize; 2] {
        let bytes = self.encoding.bits.bytes();
        match self.samples {
            Samples::Encoded(_) => [bytes, if self.encoding.transparent { 4 } else { 3 }],
            Samples::Linear(_) => [1, 4],
        }
    }

    pub(in crate::verify) fn check(&self, view: [u32; 2]) -> Result<(), WrittenError> {
        let size = self.size;
        if size != view {
            let [[width, height], [across, down]] = [size, view];
            return Err(WrittenError(format!(
                "the picture is {width}x{height} pixels, but the view is {across}x{down}"
            )));
        }
        let pixels = size[0] as usize * size[1] as usize;
        let (found, expected) = match self.samples {
            Samples::Encoded(bytes) => (bytes.len(), pixels * self.layout().iter().product::<usize>()),
            Samples::Linear(samples) => (samples.len(), pixels),
        };
        if found == expected {
            return Ok(());
        }
        Err(WrittenError(format!("the picture has {found} samples; {expected} are expected")))
    }

    /// The first channel of a pixel in which this picture differs from the exact one, with both samples. Samples of 16
    /// bits may be one step off, and linear light as much in such samples, because a f32 has about as many digits.
    pub(in crate::verify) fn difference(&self, exact: &Self, index: usize) -> Option<(usize, [f64; 2])> {
        let [found, exact] = [self.at(index), exact.at(index)];
        let is_same = |channel: usize| match (self.samples, self.encoding.bits) {
            // Samples are whole numbers.
            (Samples::Encoded(_), Bits::Eight) => (found[channel] - exact[channel]).abs() < 1.0,
            (Samples::Encoded(_), Bits::Sixteen) => (found[channel] - exact[channel]).abs() <= 1.0,
            (Samples::Linear(_), _) => is_near(found[channel], exact[channel]),
        };
        let channel = (0..4).find(|channel| !is_same(*channel))?;
        Some((channel, [found[channel], exact[channel]]))
    }

    pub(in crate::verify) fn at(&self, index: usize) -> [f64; 4] {
        let mut found = [0.0; 4];
        match self.samples {
            Samples::Linear(samples) => found = samples[index].map(f64::from),
            Samples::Encoded(bytes) => {
                let [size, channels] = self.layout();
                let pixel = &bytes[index * size * channels..][..size * channels];
                for (found, sample) in found.iter_mut().zip(pixel.chunks_exact(size)) {
                    *found = sample.iter().fold(0.0, |sum, byte| 256.0 * sum + f64::from(*byte));
                }
            }
        }
        found
    }

    /// The legal samples for legal colours. Misses are transparent if the picture is.
    pub(super) fn legal(&self, legal: &LegalColor, is_transparent: bool) -> LegalSample {
        let alpha = if legal.is_hit || !is_transparent { 1.0 } else { 0.0 };
        let Self { samples, encoding, .. } = self;
        let Samples::Encoded(_) = samples else {
            let [r, g, b] = legal.color.map(|color| [color.low, color.high]);
            return LegalSample([r, g, b, [if encoding.transparent { alpha } else { 1.0 }; 2]]);
        };
        let [low, high] = self.displayed(legal).map(|ends| encode(encoding.bits, ends));
        let alpha = if encoding.transparent { alpha * f64::from(encoding.bits.white()) } else { 0.0 };
        LegalSample([[low[0], high[0]], [low[1], high[1]], [low[2], high[2]], [alpha; 2]])
    }

    /// The least and the greatest samples for light and alpha between the ends of intervals. `None` if nothing is known.
    pub(in crate::verify) fn of_light(&self, [r, g, b, alpha]: [Interval; 4]) -> Option<[[f64; 2]; 4]> {
        let color = [r, g, b];
        let Self { samples, encoding, .. } = self;
        if color.iter().chain([&alpha]).any(|c| c.low.is_nan() || c.high.is_nan()) {
            return None;
        }
        let known = |c: Interval| [c.low, c.high];
        let Samples::Encoded(_) = samples else {
            let alpha = if encoding.transparent { known(alpha) } else { [1.0; 2] };
            return Some([known(r), known(g), known(b), alpha]);
        };
        let ends = |color: [Interval; 3]| [color.map(|c| down(c.low)), color.map(|c| up(c.high))];
        let Interval { low: least, high: most } = alpha;
        let light = match encoding.kept_background() {
            Some(background) => {
                // As `Encoding::display_over` computes, with intervals.
                let background = background.to_array().map(f64::from);
                let shares = [(1.0 - most).max(0.0), (1.0 - least).min(1.0)];
                let in_front = |c: usize| {
                    let off = 8.0 * U * (color[c].high.abs() + background[c]);
                    let low = divided(color[c].low - background[c] * shares[1] - off, [most, least]);
                    let high = divided(color[c].high - background[c] * shares[0] + off, [least, most]);
                    Interval { low: low.max(0.0), high: high.max(0.0) }
                };
                let [low, high] = encoding.display_range(ends([0, 1, 2].map(in_front)));
                let over = |shown: f32, alpha: f64, c: usize| {
                    alpha.max(0.0) * f64::from(shown.clamp(0.0, 1.0)) + (1.0 - alpha.max(0.0)) * background[c]
                };
                let around = |c: usize| {
                    let corners = [low[c], high[c]].map(|end| [least, most].map(|alpha| over(end, alpha, c)));
                    let ends = [f64::min as fn(f64, f64) -> f64, f64::max];
                    let [low, high] = ends.map(|f| corners.into_iter().flatten().fold(corners[0][0], f));
                    Interval::around(0.5 * (low + high), 0.5 * (high - low) + 8.0 * U * (1.0 + high.abs()))
                };
                ends([0, 1, 2].map(around))
            }
            None if encoding.transparent => {
                let divided =
                    |c: Interval| Interval { low: divided(c.low, [most, least]), high: divided(c.high, [least, most]) };
                let mut ends = encoding.display_range(ends(color.map(divided)));
                if least <= 0.0 {
                    ends[0] = [0.0; 3];
                }
                ends
            }
            None => encoding.display_range(ends(color)),
        };
        let [low, high] = light.map(|light| encode(encoding.bits, light));
        let white = f64::from(encoding.bits.white());
        let alpha = match encoding.transparent {
            true => [
                (white * least.clamp(0.0, 1.0) - 0.01).max(0.0).round(),
                (white * most.clamp(0.0, 1.0) + 0.01).round().min(white),
            ],
            false => [0.0; 2],
        };
        Some([[low[0], high[0]], [low[1], high[1]], [low[2], high[2]], alpha])
    }

    /// Judges a pixel by its least and greatest samples: whether they decide something, or the first channel that is not
    /// legal.
    pub(in crate::verify) fn judge_range(&self, index: usize, legal: [[f64; 2]; 4]) -> Result<bool, (usize, [f64; 2])> {
        if let Some(violation) = LegalSample::judge(&[LegalSample(legal)], &self.at(index)) {
            return Err(violation);
        }
        let widths = legal.iter().map(|[low, high]| match self.samples {
            Samples::Encoded(_) => (high - low) / f64::from(self.encoding.bits.white()),
            // Light brighter than white is one value.
            Samples::Linear(_) => {
                let [[low, ..], [high, ..]] = [low, high].map(|end| to_srgb16([*end as f32; 3]));
                f64::from(high - low) / 65535.0
            }
        });
        Ok(widths.fold(0.0, f64::max) <= WIDEST)
    }

    /// Writes samples of a pixel into bytes like those of this picture.
    pub(in crate::verify) fn put(&self, bytes: &mut [u8], index: usize, samples: [f64; 4]) {
        let [size, channels] = self.layout();
        let pixel = &mut bytes[index * size * channels..][..size * channels];
        for (bytes, sample) in pixel.chunks_exact_mut(size).zip(samples) {
            bytes.copy_from_slice(&(sample as u16).to_be_bytes()[2 - size..]);
        }
    }

    /// The least and the greatest display light for legal colours.
    fn displayed(&self, legal: &LegalColor) -> [[f32; 3]; 2] {
        let encoding = self.encoding;
        let ends = [legal.color.map(|c| down(c.low)), legal.color.map(|c| up(c.high))];
        if !legal.is_hit && (encoding.transparent || encoding.kept_background().is_some()) {
            // The background passes through unchanged. Where it is transparent, it is black.
            return ends;
        }
        encoding.display_range(ends)
    }
}

/// The legal samples of a pixel for one answer: the least and the greatest of each channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LegalSample([[f64; 2]; 4]);

impl LegalSample {
    /// Compares a pixel with its legal samples: `None` if one of them contains it. Otherwise returns the first channel
    /// that is not legal in the sample that contains the most channels, and the legal interval there.
    pub(super) fn judge(legal: &[Self], found: &[f64; 4]) -> Option<(usize, [f64; 2])> {
        let outside = |Self(channels): &Self| {
            channels.iter().zip(found).position(|([low, high], found)| !(low <= found && found <= high))
        };
        if legal.iter().any(|legal| outside(legal).is_none()) {
            return None;
        }
        let nearest = legal.iter().filter_map(|legal| Some((outside(legal)?, legal)));
        // If there is no legal answer, which does not happen, nothing is legal.
        let (channel, Self(channels)) =
            nearest.max_by_key(|(channel, _)| *channel).unwrap_or((0, &Self([[f64::NAN; 2]; 4])));
        Some((channel, channels[channel]))
    }
}

/// Whether linear light is as near to the exact light as a step of 16 bits in sRGB, or above white 2⁻¹⁵ of it.
fn is_near(found: f64, exact: f64) -> bool {
    if !(0.0..=1.0).contains(&found) {
        return (found - exact).abs() <= exact.abs() / f64::from(1 << 15);
    }
    let [[found, ..], [exact, ..]] = [found, exact].map(|light| to_srgb16([light as f32; 3]));
    found.abs_diff(exact) <= 1
}

/// The widest interval that decides a pixel, as a share of white: 16 of 256 values.
const WIDEST: f64 = 16.0 / 255.0;

/// A number divided by one of the ends of an interval of alpha: by the first if it is not negative.
fn divided(number: f64, [first, second]: [f64; 2]) -> f64 {
    let alpha = if number >= 0.0 { first } else { second };
    if alpha > 0.0 { number / alpha } else { number * BRIGHT }
}

/// More than any light.
const BRIGHT: f64 = 1e30;

/// Encodes display light as the writers do. Brighter light never gives a smaller sample.
fn encode(bits: Bits, light: [f32; 3]) -> [f64; 3] {
    match bits {
        Bits::Eight => to_srgb8(light).map(f64::from),
        Bits::Sixteen => to_srgb16(light).map(f64::from),
    }
}
