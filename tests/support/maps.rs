//! Environment maps, and directions in them.

use std::f64::consts::{PI, TAU};

use pinhole::glam::DVec3;
use pinhole::light::environment::Environment;

/// The rotation of a map that is not turned.
pub(crate) const AS_IT_IS: [f32; 2] = [1.0, 0.0];

/// Texels whose brightness varies over five orders of magnitude, some black, and a black row if there are three.
pub(crate) fn random_map(seed: u64, [width, height]: [u32; 2]) -> Environment {
    let mut random = fastrand::Rng::with_seed(seed);
    let texels = (0..width * height).map(|i| {
        let is_black = random.u32(..8) == 0 || (i / width == 1 && height > 2);
        let brightness = if is_black && i > 0 { 0.0 } else { 10_f32.powf(5.0 * random.f32() - 3.0) };
        [0; 3].map(|_: i32| brightness * random.f32())
    });
    Environment::new(width, height, texels.collect()).unwrap()
}

/// The direction at fractions of the way around, from the left edge of the map, and of the way from up to down.
pub(crate) fn direction(around: f64, down: f64) -> DVec3 {
    let ((sine, cosine), (radius, y)) = ((TAU * (around - 0.5)).sin_cos(), (PI * down).sin_cos());
    DVec3::new(radius * sine, y, -radius * cosine)
}
