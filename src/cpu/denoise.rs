//! An edge-avoiding denoising filter, in f64. Its WGSL twin, `shaders/primary/denoise.wgsl`, cites the sources.

use crate::image::Image;
use crate::image::denoise::{Guides, MissingGuide, PASSES};
use crate::parallel;

/// Below this variance, light has no noise. A miss below it is background, and stays as it is.
const NO_NOISE: f64 = 1e-8;

/// Reduces the noise of a picture by averaging light among pixels of similar shape and colour.
///
/// # Errors
/// Returns an error if the picture lacks one of the layers [`crate::image::denoise::GUIDES`].
pub fn denoise(image: &Image) -> Result<Image, MissingGuide> {
    let guides = Guides::of(image)?;
    let size = [image.width() as i64, image.height() as i64];
    let mut lights: Vec<[f64; 4]> = guides.lights.iter().map(|v| v.map(f64::from)).collect();
    for pass in 0..PASSES {
        lights = parallel::map(lights.len(), |index| {
            let at = [index as i64 % size[0], index as i64 / size[0]];
            filtered(&guides, &lights, size, at, 1 << pass)
        });
    }
    let mut quiet = image.clone();
    let colors = guides.colors(lights.into_iter().map(|v| v.map(|x| x as f32)));
    quiet.color_mut().copy_from_slice(&colors);
    Ok(quiet)
}

fn filtered(guides: &Guides, lights: &[[f64; 4]], [width, height]: [i64; 2], [i, j]: [i64; 2], step: i64) -> [f64; 4] {
    let middle = (j * width + i) as usize;
    let light = lights[middle];
    let is_miss = guides.shapes[middle][..3].iter().all(|c| *c == 0.0);
    if is_miss && light[3] <= NO_NOISE {
        return light;
    }
    let mut sum = [0.0; 4];
    let mut weights = 0.0;
    for dy in -2..=2_i64 {
        for dx in -2..=2_i64 {
            let (x, y) = (i + dx * step, j + dy * step);
            if !(0..width).contains(&x) || !(0..height).contains(&y) {
                continue;
            }
            let index = (y * width + x) as usize;
            let other = lights[index];
            let distance = step as f64 * ((dx * dx + dy * dy) as f64).sqrt();
            let change = luminance(other) - luminance(light);
            let noise = 4.0 * (light[3] + other[3]) + NO_NOISE;
            let same = likeness(guides, middle, index, distance.max(1.0));
            let weight = spline(dx) * spline(dy) * same * (-change * change / noise).exp();
            for (sum, light) in sum.iter_mut().zip(&other[..3]) {
                *sum += weight * light;
            }
            sum[3] += weight * weight * other[3];
            weights += weight;
        }
    }
    let [r, g, b, variance] = sum;
    [r / weights, g / weights, b / weights, variance / (weights * weights)]
}

/// The similarity of two pixels in shape and colour, regardless of their light. 1 for equal pixels, near 0 for
/// different ones.
fn likeness(guides: &Guides, a: usize, b: usize, distance: f64) -> f64 {
    let [shape, other] = [a, b].map(|index| guides.shapes[index].map(f64::from));
    let dot = |a: [f64; 4], b: [f64; 4]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let are_misses = dot(shape, shape) == 0.0 && dot(other, other) == 0.0;
    let depth = (shape[3] - other[3]).abs() / (0.005 * distance * shape[3].min(other[3]).max(1e-30));
    let alike = if are_misses { 1.0 } else { dot(shape, other).max(0.0).powi(32) / (1.0 + depth * depth) };
    let tints = [a, b].map(|index| guides.albedos[index].map(f64::from));
    let tint: f64 = (0..3).map(|c| (tints[0][c] - tints[1][c]).powi(2)).sum();
    alike / (1.0 + 400.0 * tint)
}

/// The weight of a B3 spline at a distance from its centre, in steps.
fn spline(distance: i64) -> f64 {
    match distance.abs() {
        0 => 0.375,
        1 => 0.25,
        _ => 0.0625,
    }
}

fn luminance([r, g, b, _]: [f64; 4]) -> f64 {
    crate::image::color::luminance([r, g, b])
}
