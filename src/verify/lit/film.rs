//! The check of a sample's camera ray, and of the sums of a pixel's samples. The WGSL twins are `shaders/path/start.wgsl`,
//! `filter.wgsl`, `film_sample.wgsl`, `accumulate.wgsl` and `film_sums.wgsl`.

use glam::{DVec2, DVec3};

use crate::camera::film::{Film, YAxis};
use crate::camera::sampling::{pair, pixel_seed, unit};
use crate::image::NO_ID;
use crate::image::color::LUMINANCE;
use crate::recording::lit::{LitInputs, NO_EMITTER, PathState, RecordedFilm, flag, slot};
use crate::verify::camera::{CameraModel, Location};
use crate::verify::lit::certificate::{Address, LitStage};
use crate::verify::lit::judge::{Judge, Mismatch, Name, StageResult, along_choices};
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::Interval;

const ORIGIN: Name = (LitStage::Start, "the ray's origin");
const DIRECTION: Name = (LitStage::Start, "the ray's direction");
const DISTANCE: Name = (LitStage::Start, "the ray's distance from the camera");
const FLAGS: Name = (LitStage::Start, "the path's flags");
const NOTHING: Name = (LitStage::Start, "the initial state");

/// Judges the state of a path before anything is traced.
pub(crate) fn judge_start(
    inputs: &LitInputs,
    model: &CameraModel,
    Address { pixel, sample, .. }: Address,
    found: &PathState,
) -> Result<StageResult, Mismatch> {
    along_choices(|choices| {
        let mut judge = Judge::default();
        let lighting = &inputs.lighting;
        let seed = pixel_seed(pixel, lighting.seed);
        let location = location(&inputs.film, &lighting.filter_table, pixel, pair(seed, sample, 0));
        let ray = model.ray_through_lens(location, DVec2::from(pair(seed, sample, 1).map(unit)));
        let is_seen = choices.decide(match (ray.may_be_seen, ray.may_be_unseen) {
            (true, true) => None,
            (is_seen, _) => Some(is_seen),
        });
        let alive = if is_seen { flag::ALIVE } else { 0 };
        judge.bits(FLAGS, found.flags(), alive | flag::FULL)?;
        let around =
            |exact: DVec3, error: DVec3| Vector([0, 1, 2].map(|axis| Number::around(exact[axis], error[axis])));
        let size = inputs.uploaded.scene_max.iter().fold(0.0, |size: f64, x| size.max(f64::from(x.abs())));
        let origin = around(ray.line.origin, ray.origin_error);
        judge.vector_of(ORIGIN, found.vector(slot::ORIGIN), origin, size)?;
        let direction = around(ray.line.direction, ray.direction_error);
        judge.vector(DIRECTION, found.vector(slot::DIRECTION), direction)?;
        let distance = Number::around(ray.distance, ray.distance_error);
        judge.number(DISTANCE, found.number(slot::FIRST), distance)?;

        let is_shown = !is_seen && lighting.flags & flag::TRANSPARENT == 0;
        let radiance = if is_shown { lighting.background } else { [0.0; 3] };
        let one = 1.0_f32.to_bits();
        let mut slots = [[0; 4]; PathState::SLOTS];
        slots[slot::ORIGIN] = found.slots[slot::ORIGIN];
        let [x, y, z, _] = found.slots[slot::DIRECTION];
        slots[slot::DIRECTION] = [x, y, z, 0];
        slots[slot::DEPARTURE] = [NO_ID, 0, 0, NO_EMITTER];
        slots[slot::THROUGHPUT] = [one; 4];
        let [r, g, b] = radiance.map(f32::to_bits);
        slots[slot::RADIANCE] = [r, g, b, 0];
        slots[slot::SHADOW] = [0, 0, one, 0];
        slots[slot::FIRST] = [0, 0, 0, found.bits(slot::FIRST)];
        let legal = PathState { slots };
        // A studio writes the other slots only once there is a surface.
        let written = if inputs.is_studio() { slot::NORMAL } else { PathState::SLOTS };
        (0..written).try_for_each(|which| judge.same(NOTHING, [&legal, found], which))?;
        Ok(judge)
    })
}

/// The relative location of a sample, which is near the pixel's centre.
pub(crate) fn location(film: &Film, table: &[f32], pixel: [u32; 2], u: [u32; 2]) -> Location {
    let sign = match film.y_axis() {
        YAxis::Up => -1.0,
        YAxis::Down => 1.0,
    };
    let along = |axis: usize, side: u32, sign: f64| {
        let doubled = 2.0 * f64::from(pixel[axis]) + 1.0 - f64::from(side);
        let sum = Number::known(doubled) + Number::TWO * offset(table, u[axis]);
        let Interval { low, high } = (sum / Number::known(side.into()) * Number::known(sign)).interval();
        (0.5 * (low + high), 0.5 * (high - low) * (1.0 + 1e-12) + 1e-300)
    };
    let (x, x_error) = along(0, film.width(), 1.0);
    let (y, y_error) = along(1, film.height(), sign);
    Location { exact: DVec2::new(x, y), error: DVec2::new(x_error, y_error) }
}

/// The distance from the pixel's centre in pixels.
fn offset(table: &[f32], u: u32) -> Number {
    let entry = |at: u32| Number::recorded(table.get(at as usize).copied().unwrap_or_default());
    let (low, high) = (entry(u >> 24), entry((u >> 24) + 1));
    let fraction = Number::known(f64::from((u >> 8) & 0xffff) / f64::from(1 << 16));
    (low + (fraction * (high - low).fence()).fence()).fence()
}

const COLOR: Name = (LitStage::Accumulate, "the sum of colors");
const ALPHA: Name = (LitStage::Accumulate, "the sum of opacities");
const ALBEDO: Name = (LitStage::Accumulate, "the sum of the first surfaces' colors");
const SQUARE: Name = (LitStage::Accumulate, "the sum of squared luminances");
const REST: Name = (LitStage::Accumulate, "the rounding error of a sum");

/// Judges the sums of the pixel with this index: the sum after a sample with a colour, given the sums before it.
pub(crate) fn check_sums(
    color: Vector,
    state: &PathState,
    film: &RecordedFilm,
    index: usize,
) -> Result<StageResult, Mismatch> {
    let [before, after] = [&film.before, &film.after].map(|sums| Sums::new(sums[index]));
    let mut judge = Judge::default();
    let light = color.dot(Vector(LUMINANCE.map(Number::constant)));
    let Vector([r, g, b]) = color;
    for (channel, more) in [r, g, b, light.squared()].into_iter().enumerate() {
        let name = if channel < 3 { COLOR } else { SQUARE };
        let (sum, found) = (Number::recorded(before.value[channel]), after.value[channel]);
        let size = sum.interval().size() + more.interval().size();
        judge.number_of(name, found, sum + more, size)?;
        // The sum is fenced and stored, so it is now known exactly, and so are the steps that find its rounding error.
        let value = Number::recorded(found);
        let part = (value - sum).fence();
        let lost = (sum - (value - part).fence()).fence() + (more - part).fence();
        let rest = Number::recorded(before.rest[channel]) + lost.fence();
        judge.number_of(REST, after.rest[channel], rest, size)?;
    }
    let alpha = Number::recorded(before.alpha) + Number::recorded(state.number(slot::RADIANCE));
    judge.number(ALPHA, after.alpha, alpha)?;
    // Surfaces have few colours, so chance does not spread the roundings of their sums.
    let measured = judge.deviations.len();
    let albedo = Vector::recorded(before.albedo) + Vector::recorded(state.vector(slot::FIRST));
    judge.vector(ALBEDO, after.albedo, albedo)?;
    judge.deviations.truncate(measured);
    Ok(judge.into())
}

struct Sums {
    /// Colour and squared luminance.
    value: [f32; 4],
    /// The rounding error of `value`.
    rest: [f32; 4],
    alpha: f32,
    albedo: [f32; 3],
}

impl Sums {
    fn new(bits: [[u32; 4]; 3]) -> Self {
        let [[r, g, b, alpha], rest, [x, y, z, square]] = bits.map(|four| four.map(f32::from_bits));
        Self { value: [r, g, b, square], rest, alpha, albedo: [x, y, z] }
    }
}
