//! The check of the sums of a pixel's samples. The WGSL twins are `shaders/path/accumulate.wgsl` and
//! `path/film_sums.wgsl`.

use super::expected::{Expected, Mismatch};
use super::judge::Judged;
use super::recording::{PathState, RecordedFilm, slot};
use super::stage::LitStage;
use crate::image::color::LUMINANCE;
use crate::verify::number::{Number, Vector};

/// The stage and the name of a number, for reports.
type Name = (LitStage, &'static str);

const COLOR: Name = (LitStage::Accumulate, "the sum of colors");
const ALPHA: Name = (LitStage::Accumulate, "the sum of opacities");
const ALBEDO: Name = (LitStage::Accumulate, "the sum of the first surfaces' colors");
const SQUARE: Name = (LitStage::Accumulate, "the sum of squared luminances");
const REST: Name = (LitStage::Accumulate, "the rounding error of a sum");

/// Judges the sums of the pixel with this index: that of a sample with a color, and those before it.
pub(in crate::verify) fn check(
    color: Vector,
    state: &PathState,
    film: &RecordedFilm,
    index: usize,
) -> Result<Judged, Mismatch> {
    let [before, after] = [&film.before, &film.after].map(|sums| Sums::new(sums[index]));
    let mut expected = Expected::default();
    let light = color.dot(Vector(LUMINANCE.map(Number::constant)));
    let Vector([r, g, b]) = color;
    for (channel, more) in [r, g, b, light.squared()].into_iter().enumerate() {
        let name = if channel < 3 { COLOR } else { SQUARE };
        let (sum, found) = (before.value(channel), after.value[channel]);
        let size = size_of(sum) + size_of(more);
        expected.number_of(name, found, sum + more, size)?;
        // The sum is fenced and stored, so it is now known exactly, and with it how the kernel finds what was rounded.
        let value = Number::recorded(found);
        let part = (value - sum).fence();
        let lost = (sum - (value - part).fence()).fence() + (more - part).fence();
        let rest = Number::recorded(before.rest[channel]) + lost.fence();
        expected.number_of(REST, after.rest[channel], rest, size)?;
    }
    let alpha = Number::recorded(before.alpha) + Number::recorded(state.number(slot::RADIANCE));
    expected.number(ALPHA, after.alpha, alpha)?;
    // Surfaces have few colours, so that chance does not spread the roundings of their sums.
    let measured = expected.deviations.len();
    let albedo = Vector::recorded(before.albedo) + Vector::recorded(state.vector(slot::FIRST));
    expected.vector(ALBEDO, after.albedo, albedo)?;
    expected.deviations.truncate(measured);
    Ok(expected.into())
}

/// The largest magnitude of a number.
fn size_of(number: Number) -> f64 {
    let legal = number.interval();
    legal.high.abs().max(legal.low.abs())
}

/// The sums of a pixel.
struct Sums {
    /// Colour and squared luminance.
    value: [f32; 4],
    /// What rounding left out of `value`.
    rest: [f32; 4],
    alpha: f32,
    albedo: [f32; 3],
}

impl Sums {
    fn new(bits: [[u32; 4]; 3]) -> Self {
        let [[r, g, b, alpha], rest, [x, y, z, square]] = bits.map(|four| four.map(f32::from_bits));
        Self { value: [r, g, b, square], rest, alpha, albedo: [x, y, z] }
    }

    fn value(&self, channel: usize) -> Number {
        Number::recorded(self.value[channel])
    }
}
