//! Compares a picture with the CPU reference, up to f32 rounding.
//!
//! Ids must be equal, unless the reference itself gives the other id a thousandth of a pixel away. Depth, normal,
//! position and headlight colour must lie within bounds. All bounds follow from one number, the largest displacement of
//! a ray by the kernel's rounding. Flat colours, albedo and misses must be equal to the bit.

use std::fmt::Debug;

use glam::DVec3;
use pinhole::camera::CameraKind;
use pinhole::image::{NO_ID, Pixel};
use pinhole::{Image, Integrator, Shading, cpu, glam};

use super::View;

/// The largest displacement of a pixel's ray by rounding, relative to the lengths involved: four roundings of f32. The
/// chains in the kernels are longer, but their errors do not add up in one direction. In all scenes here, lavapipe
/// stays within 0.36 of the resulting bounds.
const DISPLACEMENT: f64 = 4.0 / (1_u64 << 24) as f64;

/// Within this fraction of a pixel of a silhouette, or of the line where two spheres meet, either id is right.
const NUDGE_PIXELS: f64 = 1e-3;

/// All layers of an image, pixel by pixel, so that a test can change one.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    pub(crate) size: [u32; 2],
    pub(crate) pixels: Vec<Pixel>,
}

impl From<&Image> for Picture {
    fn from(image: &Image) -> Self {
        let pixels = (0..image.color().len()).map(|index| Pixel {
            color: image.color()[index],
            depth: image.depth().unwrap()[index],
            normal: image.normal().unwrap()[index],
            position: image.position().unwrap()[index],
            albedo: image.albedo().unwrap()[index],
            id: image.id().unwrap()[index],
        });
        Self { size: [image.width(), image.height()], pixels: pixels.collect() }
    }
}

/// The result of a comparison.
#[derive(Debug, Default)]
pub(crate) struct Comparison {
    /// The number of pixels whose id differs but is right a nudge away.
    pub(crate) ambiguous: usize,
    /// All violations, in the order of pixels.
    pub(crate) violations: Vec<Violation>,
}

/// A difference that exceeds its bound.
#[derive(Debug)]
#[allow(dead_code, reason = "some tests print it alone")]
pub(crate) struct Violation {
    /// `size`, or the name of a layer.
    pub(crate) layer: &'static str,
    pub(crate) pixel: [u32; 2],
    /// The values of the reference and of the result.
    pub(crate) values: [String; 2],
}

impl Violation {
    fn new(layer: &'static str, pixel: [u32; 2], values: [&dyn Debug; 2]) -> Self {
        Self { layer, pixel, values: values.map(|value| format!("{value:?}")) }
    }
}

/// Compares all layers of a result with those of the reference's picture of the same view.
pub(crate) fn compare(view: &View, reference: &Picture, result: &Picture) -> Comparison {
    let mut comparison = Comparison::default();
    if reference.size != result.size {
        let sizes: [&dyn Debug; 2] = [&reference.size, &result.size];
        comparison.violations.push(Violation::new("size", [0; 2], sizes));
        return comparison;
    }
    let [width, height] = reference.size;
    for j in 0..height {
        for i in 0..width {
            let index = (j * width + i) as usize;
            let (expected, found) = (reference.pixels[index], result.pixels[index]);
            if expected.id == found.id {
                comparison.violations.extend(differences(view, [i, j], &expected, &found));
            } else if nudged_ids(view, i, j).contains(&found.id) {
                comparison.ambiguous += 1;
            } else {
                let ids: [&dyn Debug; 2] = [&expected.id, &found.id];
                comparison.violations.push(Violation::new("id", [i, j], ids));
            }
        }
    }
    comparison
}

fn differences(view: &View, pixel: [u32; 2], a: &Pixel, b: &Pixel) -> Vec<Violation> {
    let bounds = bounds(view, pixel, a);
    // Two misses are equal, although the difference of two infinities is NaN.
    let same_depth =
        a.depth.to_bits() == b.depth.to_bits() || (f64::from(a.depth) - f64::from(b.depth)).abs() <= bounds.depth;
    let same_normal = distance(a.normal, b.normal) <= bounds.normal && is_unit_or_zero(b);
    let same_position = distance(a.position, b.position) <= bounds.position;
    let same_albedo = a.albedo.map(f32::to_bits) == b.albedo.map(f32::to_bits);
    let same_color = distance(a.color, b.color) <= bounds.color;
    let layers: [(bool, &'static str, [&dyn Debug; 2]); 5] = [
        (same_depth, "depth", [&a.depth, &b.depth]),
        (same_normal, "normal", [&a.normal, &b.normal]),
        (same_position, "position", [&a.position, &b.position]),
        (same_albedo, "albedo", [&a.albedo, &b.albedo]),
        (same_color, "color", [&a.color, &b.color]),
    ];
    let different = layers.into_iter().filter(|(is_same, ..)| !is_same);
    different.map(|(_, layer, values)| Violation::new(layer, pixel, values)).collect()
}

/// The largest allowed difference of each layer from the reference.
struct PixelBounds {
    depth: f64,
    normal: f64,
    position: f64,
    color: f64,
}

fn bounds(view: &View, [i, j]: [u32; 2], reference: &Pixel) -> PixelBounds {
    if reference.id == NO_ID {
        return PixelBounds { depth: 0.0, normal: 0.0, position: 0.0, color: 0.0 };
    }
    let location = view.film.relative_location(f64::from(i) + 0.5, f64::from(j) + 0.5);
    let ray = view.camera.ray_in_world(location);
    let radius = f64::from(view.scene.spheres()[reference.id as usize][3]);
    let normal = DVec3::from(reference.normal.map(f64::from));
    let cosine = normal.dot(ray.direction).abs();

    let depth = f64::from(reference.depth);
    // A fisheye rounds the angle itself, relative to it. At that angle from the view, the error is an arc's length.
    let arc = match view.camera.kind() {
        CameraKind::Fisheye => depth * view.camera.vectors().forward.angle_between(ray.direction),
        _ => 0.0,
    };
    let lengths = (ray.origin - view.scene.origin()).length() + depth + arc + radius;
    let displacement = DISPLACEMENT * lengths;
    // A ray displaced sideways meets the sphere earlier or later. The change is displacement/cosine where the surface
    // faces the ray, and at most the half chord's change at the silhouette, sqrt(2 r d).
    let along = displacement + (displacement / cosine).min((2.0 * radius * displacement).sqrt());
    let normal = (displacement + along) / radius;
    let brightest = view.scene.color(reference.id).to_array().into_iter().fold(0.0, f32::max);
    PixelBounds {
        depth: along,
        normal,
        // The error along the exact ray, and the rounding to f32 in the world.
        position: along + DISPLACEMENT * distance(reference.position, [0.0; 3]),
        color: match view.settings.integrator {
            Integrator::Primary(Shading::Flat) => 0.0,
            _ => f64::from(brightest) * 3.0_f64.sqrt() * (normal + DISPLACEMENT),
        },
    }
}

/// A normal of any legal direction has unit length, up to rounding. That of a miss is zero.
fn is_unit_or_zero(pixel: &Pixel) -> bool {
    let length = distance(pixel.normal, [0.0; 3]);
    let expected = if pixel.id == NO_ID { 0.0 } else { 1.0 };
    (length - expected).abs() <= DISPLACEMENT
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f64 {
    (DVec3::from(a.map(f64::from)) - DVec3::from(b.map(f64::from))).length()
}

/// The reference's ids at eight points around the pixel's centre.
fn nudged_ids(view: &View, i: u32, j: u32) -> [u32; 8] {
    std::array::from_fn(|k| {
        let (sin, cos) = (k as f64 * std::f64::consts::FRAC_PI_4).sin_cos();
        let location = view
            .film
            .relative_location(f64::from(i) + 0.5 + NUDGE_PIXELS * cos, f64::from(j) + 0.5 + NUDGE_PIXELS * sin);
        let ray = view.camera.ray_in_world(location);
        let hit = view.camera.sees(location).then(|| cpu::trace(&view.scene, &ray)).flatten();
        hit.map_or(NO_ID, |hit| hit.id)
    })
}
