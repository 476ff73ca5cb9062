//! The check of the denoiser: the results that its five passes may have. The WGSL twin is
//! `shaders/primary/denoise.wgsl`.
//!
//! Light is known as an interval for each channel. A pass makes weighted means of 25 pixels. A weight is an interval,
//! because it follows from lights, and from an exponential that WGSL rounds by several ULP. A mean of v with weights w is
//!
//! b + Σ w (v − b) / Σ w
//!
//! for any b. If b is the light of the pixel in the middle, the differences v − b are small where weights are not. So
//! the interval of the mean grows by the uncertainty of weights times these differences, and not times the light. The
//! roundings of the sums and of the quotient are added. A decision that intervals leave open, such as whether a miss
//! has no noise, may have either outcome.

use super::certificate::channel_name;
use super::rounding::{DIVIDE, FLUSH, Interval, PAD, SQRT, U, gamma};
use crate::image::Image;
use crate::image::color::LUMINANCE;
use crate::image::denoise::{Guides, MissingGuide, PASSES, REACH};
use crate::parallel;
use crate::recording::pixel_at;
use crate::verify::certificate::Outcome;

/// The largest number of violations that are kept. All are counted.
const KEPT: usize = 100;

/// The variance below which light counts as free of noise, `NO_NOISE` in the kernel.
const NO_NOISE: f64 = 1e-8;

/// Roundings of a sum of 25 products of weights and light, of the sum of weights, and of the quotient.
const OF_MEANS: u32 = 60;

/// Roundings of a sum of 25 products of two squares of weights and a variance, of the square of the sum of weights, and of
/// the quotient.
const OF_VARIANCES: u32 = 80;

/// Weights up to this are too small, beside the weight 0.14 of the pixel in the middle, to compute their intervals.
const NO_WEIGHT: f64 = 1e-20;

/// Maximum change if 25 products are flushed to zero.
const MOST_FLUSHED: f64 = 25.0 * FLUSH;

/// The widest interval that decides a pixel, relative to the light, or to a hundredth of white if that is more.
const WIDEST: f64 = 0.05;

/// Red, green and blue, and the variance of their luminance.
pub(super) type Light = [Interval; 4];

/// A pixel that no conforming device may compute.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct DenoiseViolation {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// Index of the channel, from 0: red, green or blue.
    pub channel: usize,
    /// The light of the denoised picture.
    pub found: f32,
    /// The legal light.
    pub legal: Interval,
}

/// Whether a device denoised a picture as a conforming WGSL implementation may.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize))]
#[non_exhaustive]
pub struct DenoiseCertificate {
    /// The number of pixels.
    pub pixels: u64,
    /// The number of pixels whose bounds are too wide to decide them.
    pub undecided: u64,
    /// The number of pixels that are not legal.
    pub violation_count: u64,
    /// The first violations, in the order of pixels.
    pub violations: Vec<DenoiseViolation>,
}

impl DenoiseCertificate {
    /// The outcome of the picture.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        Outcome::of(self.violation_count > 0, self.undecided, self.pixels)
    }
}

#[cfg(feature = "run-file")]
impl serde::Serialize for DenoiseViolation {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl std::fmt::Display for DenoiseViolation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { pixel: [i, j], channel, found, legal: Interval { low, high } } = self;
        let name = channel_name(*channel);
        write!(f, "pixel ({i}, {j}): {name} is {found:e}, but {low:e} to {high:e} are legal")
    }
}

/// Judges the result of a device that denoised a picture.
///
/// # Errors
/// Returns an error if the noisy picture lacks one of [the layers](crate::image::denoise::GUIDES) that denoising needs.
pub fn certify(noisy: &Image, denoised: &Image) -> Result<DenoiseCertificate, MissingGuide> {
    let Guides { lights, shapes, albedos } = Guides::of(noisy)?;
    let exact = |x: &f32| Interval { low: f64::from(*x), high: f64::from(*x) };
    let lights: Vec<Light> = lights.iter().map(|light| light.each_ref().map(exact)).collect();
    let guides = shapes.iter().zip(&albedos).map(|(shape, [r, g, b, _])| LegalGuide {
        shape: shape.map(f64::from),
        errors: [0.0; 2],
        is_miss: Some(shape[..3].iter().all(|c| *c == 0.0)),
        albedo: [r, g, b].map(exact),
    });
    let guides: Vec<LegalGuide> = guides.collect();
    let all = 0..lights.len();
    let lights = filtered(&guides, [noisy.width(), noisy.height()], lights, &all);
    let mut certificate = DenoiseCertificate::default();
    for (index, (light, guide)) in lights.iter().zip(&guides).enumerate() {
        // If the picture has another size, pixels that it lacks are not legal.
        let found = denoised.color().get(index).copied().unwrap_or([f32::NAN; 3]);
        let legal: [Interval; 3] = std::array::from_fn(|i| product(light[i], guide.albedo[i]));
        certificate.pixels += 1;
        // A bound that is NaN does not decide the pixel.
        let is_vague =
            |Interval { low, high }: &Interval| low.is_nan() || high.is_nan() || high - low > WIDEST * high.max(0.01);
        let is_excluded = |channel: &usize| {
            let (Interval { low, high }, found) = (legal[*channel], f64::from(found[*channel]));
            found.is_nan() || found < low || found > high
        };
        match (0..3).find(is_excluded) {
            Some(channel) => {
                certificate.violation_count += 1;
                if certificate.violations.len() < KEPT {
                    let pixel = pixel_at(index, noisy.width());
                    let (found, legal) = (found[channel], legal[channel]);
                    certificate.violations.push(DenoiseViolation { pixel, channel, found, legal });
                }
            }
            None => certificate.undecided += u64::from(legal.iter().any(is_vague)),
        }
    }
    Ok(certificate)
}

/// The product of light and albedo in f32. Albedo is positive.
pub(super) fn product(light: Interval, albedo: Interval) -> Interval {
    let low = light.low * if light.low < 0.0 { albedo.high } else { albedo.low };
    let high = light.high * if light.high < 0.0 { albedo.low } else { albedo.high };
    Interval { low: low - PAD * U * low.abs() - FLUSH, high: high + PAD * U * high.abs() + FLUSH }
}

/// What guides the filter at a pixel.
#[derive(Clone, Debug)]
pub(super) struct LegalGuide {
    /// Normal and depth, which are zero for a miss.
    pub(super) shape: [f64; 4],
    /// The bounds of the errors of the normal and of the depth.
    pub(super) errors: [f64; 2],
    /// Whether the pixel shows no surface; `None` if it may show several things.
    pub(super) is_miss: Option<bool>,
    /// The albedo by which light is divided.
    pub(super) albedo: [Interval; 3],
}

/// The pixels of a picture that are at most `reach` pixels away from some others, along each axis.
pub(super) fn near([width, height]: [u32; 2], indices: impl Iterator<Item = usize>, reach: u32) -> Vec<bool> {
    let [width, height, reach] = [width, height, reach].map(|side| side as usize);
    let mut rows = vec![false; width * height];
    for index in indices {
        let [i, j] = [index % width, index / width];
        rows[j * width + i.saturating_sub(reach)..j * width + (i + reach + 1).min(width)].fill(true);
    }
    let mut all = vec![false; width * height];
    for i in 0..width {
        let mut mark = |rows_in_turn: &mut dyn Iterator<Item = usize>| {
            let mut last = None;
            for j in rows_in_turn {
                if rows[j * width + i] {
                    last = Some(j);
                }
                all[j * width + i] |= last.is_some_and(|last: usize| last.abs_diff(j) <= reach);
            }
        };
        mark(&mut (0..height));
        mark(&mut (0..height).rev());
    }
    all
}

/// The light that the passes may give to some pixels of a picture, given that of all pixels within their reach.
pub(super) fn filtered(
    guides: &[LegalGuide],
    size: [u32; 2],
    mut lights: Vec<Light>,
    indices: &(impl Iterator<Item = usize> + Clone),
) -> Vec<Light> {
    let filter = Filter { guides, size: size.map(i64::from) };
    for pass in 0..PASSES {
        // The reach of the passes after this one.
        let wanted = near(size, indices.clone(), REACH - 2 * ((2 << pass) - 1));
        lights = parallel::map(lights.len(), |index| match wanted[index] {
            true => filter.filtered(&lights, index, 1 << pass),
            false => lights[index],
        });
    }
    lights
}

struct Filter<'a> {
    guides: &'a [LegalGuide],
    size: [i64; 2],
}

impl Filter<'_> {
    /// The light that a pass may give to a pixel.
    fn filtered(&self, lights: &[Light], middle: usize, step: i64) -> Light {
        let light = lights[middle];
        let is_miss = self.guides[middle].is_miss;
        let variance = light[3];
        if is_miss == Some(true) && variance.high <= NO_NOISE {
            return light;
        }
        let mean = self.mean(lights, middle, step);
        if is_miss != Some(false) && variance.low <= NO_NOISE {
            return std::array::from_fn(|i| mean[i].union(light[i]));
        }
        mean
    }

    fn mean(&self, lights: &[Light], middle: usize, step: i64) -> Light {
        let [width, height] = self.size;
        let at = [middle as i64 % width, middle as i64 / width];
        let light = lights[middle];
        let base: [f64; 3] = std::array::from_fn(|i| {
            let middle = 0.5 * (light[i].low + light[i].high);
            if middle.is_finite() { middle } else { 0.0 }
        });
        let mut sums = [Interval::ZERO; 4];
        let mut weights = Interval::ZERO;
        // Sums of the magnitudes of all terms, of which rounding may change a part.
        let mut sizes = [0.0_f64; 3];
        // The least and the greatest light of all pixels that may have a weight, between which each mean lies.
        let mut hull = [Interval { low: f64::INFINITY, high: f64::NEG_INFINITY }; 3];
        for dy in -2..=2_i64 {
            for dx in -2..=2_i64 {
                let (x, y) = (at[0] + dx * step, at[1] + dy * step);
                if !(0..width).contains(&x) || !(0..height).contains(&y) {
                    continue;
                }
                let index = (y * width + x) as usize;
                let other = lights[index];
                let distance = step as f64 * ((dx * dx + dy * dy) as f64).sqrt();
                let same = self.likeness(middle, index, distance.max(1.0));
                let alike = if index == middle {
                    ONE
                } else if same.high <= NO_WEIGHT {
                    ANY
                } else {
                    alike(&light, &other)
                };
                let spline = spline(dx) * spline(dy);
                let relative = PAD * gamma(4);
                let weight = Interval {
                    low: spline * same.low * alike.low * (1.0 - relative) - FLUSH,
                    high: spline * same.high * alike.high * (1.0 + relative) + FLUSH,
                };
                let weight = Interval { low: weight.low.max(0.0), ..weight };
                for channel in 0..3 {
                    let (low, high) = (other[channel].low - base[channel], other[channel].high - base[channel]);
                    sums[channel].low += low * if low < 0.0 { weight.high } else { weight.low };
                    sums[channel].high += high * if high > 0.0 { weight.high } else { weight.low };
                    sizes[channel] += weight.high * other[channel].size();
                    hull[channel] = hull[channel].union(other[channel]);
                }
                sums[3].low += weight.low * weight.low * other[3].low;
                sums[3].high += weight.high * weight.high * other[3].high;
                weights.low += weight.low;
                weights.high += weight.high;
            }
        }
        let rounding = PAD * gamma(OF_MEANS);
        let [red, green, blue] = std::array::from_fn(|i| {
            let Interval { low, high } = sums[i];
            let low = low / if low < 0.0 { weights.low } else { weights.high };
            let high = high / if high > 0.0 { weights.low } else { weights.high };
            let error = (rounding * sizes[i] + MOST_FLUSHED) / weights.low;
            let Interval { low: least, high: most } = hull[i];
            let of_size = rounding * hull[i].size() + MOST_FLUSHED / weights.low;
            // A bound that is NaN gives way to the other one.
            Interval {
                low: (base[i] + low - error).max(least - of_size),
                high: (base[i] + high + error).min(most + of_size),
            }
        });
        let rounding = PAD * gamma(OF_VARIANCES);
        let flushed = MOST_FLUSHED / (weights.low * weights.low);
        let variance = Interval {
            low: sums[3].low / (weights.high * weights.high) * (1.0 - rounding) - flushed,
            high: sums[3].high / (weights.low * weights.low) * (1.0 + rounding) + flushed,
        };
        [red, green, blue, Interval { low: variance.low.max(0.0), ..variance }]
    }

    /// The similarity of two pixels in shape and albedo.
    fn likeness(&self, a: usize, b: usize, distance: f64) -> Interval {
        let [one, other] = [a, b].map(|index| &self.guides[index]);
        if a == b && (one.is_miss.is_none() || one.errors.iter().any(|error| *error > 0.0)) {
            return ITSELF;
        }
        let alike = match (one.is_miss, other.is_miss) {
            (None, _) | (_, None) => MOST_ALIKE,
            (Some(true), Some(true)) => ONE,
            _ => {
                let products: [f64; 3] = std::array::from_fn(|i| one.shape[i] * other.shape[i]);
                // Normals have about unit length.
                let turned = 1.01 * (one.errors[0] + other.errors[0]);
                let error = PAD * gamma(3) * products.iter().map(|p| p.abs()).sum::<f64>() + turned + 4.0 * FLUSH;
                let cosine = products.iter().sum::<f64>();
                // Squares are taken five times: 31 products. Below this, the power is flushed to zero.
                let power = |cosine: f64, relative: f64| cosine.max(0.0).powi(32) * (1.0 + relative);
                let relative = PAD * gamma(31);
                let ([z, off_z], [w, off_w]) = ([one.shape[3], one.errors[1]], [other.shape[3], other.errors[1]]);
                let (jump, moved) = ((z - w).abs(), off_z + off_w);
                // One difference, a product of constants and of a root, and a quotient.
                let depth = |jump: f64, nearest: f64| jump / (0.005 * distance * nearest.max(1e-30));
                let least = depth((jump - moved).max(0.0), (z + off_z).min(w + off_w));
                let most = depth(jump + moved, (z - off_z).min(w - off_w));
                let off = PAD * (gamma(6) + SQRT + DIVIDE);
                let fall = |depth: f64| 1.0 / (1.0 + depth * depth);
                let off_fall = PAD * (gamma(3) + DIVIDE);
                Interval {
                    low: power(cosine - error, -relative) * fall(most * (1.0 + off) + FLUSH) * (1.0 - off_fall) - FLUSH,
                    high: power(cosine + error, relative)
                        * fall((least * (1.0 - off) - FLUSH).max(0.0))
                        * (1.0 + off_fall)
                        + FLUSH,
                }
            }
        };
        let mut tint = Interval::ZERO;
        for (a, b) in one.albedo.iter().zip(&other.albedo) {
            tint.low += (a.low - b.high).max(b.low - a.high).max(0.0).powi(2);
            tint.high += (a.high - b.low).max(b.high - a.low).powi(2);
        }
        let off = PAD * (gamma(8) + DIVIDE);
        let divisor = |tint: f64| 1.0 + 400.0 * tint;
        Interval {
            low: (alike.low / divisor(tint.high) * (1.0 - off) - FLUSH).max(0.0),
            high: alike.high / divisor(tint.low) * (1.0 + off) + FLUSH,
        }
    }
}

/// The similarity of a pixel and itself: the 32nd power of the square of a normal of about unit length.
const ITSELF: Interval = Interval { low: 0.9999, high: 1.0001 };

/// The similarity of shapes of which one is not known. Normals are slightly longer than 1 at most.
const MOST_ALIKE: Interval = Interval { low: 0.0, high: 1.001 };

const ONE: Interval = Interval { low: 1.0, high: 1.0 };

/// The interval of all similarities of lights. The exponential of zero may be 3 ULP above 1.
const ANY: Interval = Interval { low: 0.0, high: 1.0 + PAD * U * 3.0 };

/// The similarity of lights, relative to their noise.
fn alike(light: &Light, other: &Light) -> Interval {
    let mut change = Interval::ZERO;
    let mut size = 0.0;
    for (channel, weight) in LUMINANCE.into_iter().enumerate() {
        let (a, b) = (light[channel], other[channel]);
        change.low += weight * (b.low - a.high);
        change.high += weight * (b.high - a.low);
        size += weight * (a.size() + b.size());
    }
    // A difference, a constant that is rounded, a product, and a sum of three.
    let error = PAD * gamma(6) * size + 4.0 * FLUSH;
    let (low, high) = (change.low - error, change.high + error);
    let least = if low > 0.0 { low } else { (-high).max(0.0) };
    let most = high.max(-low);
    let off = PAD * (gamma(6) + DIVIDE);
    let noise = |a: f64, b: f64| 4.0 * (a + b) + NO_NOISE;
    let least = least * least / noise(light[3].high, other[3].high) * (1.0 - off) - FLUSH;
    let most = most * most / noise(light[3].low, other[3].low) * (1.0 + off) + FLUSH;
    // WGSL: an exponential is within 3 + 2 |x| ULP.
    let exp = |x: f64, sign: f64| (-x).exp() * (1.0 + sign * PAD * U * (3.0 + 2.0 * x)) + sign * FLUSH;
    Interval { low: exp(most, -1.0).max(0.0), high: exp(least.max(0.0), 1.0) }
}

/// The weight of a B3 spline at a distance from its centre, in steps.
fn spline(distance: i64) -> f64 {
    match distance.abs() {
        0 => 0.375,
        1 => 0.25,
        _ => 0.0625,
    }
}
