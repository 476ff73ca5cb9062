//! From a hit to a pixel. Twin of `shaders/shade.wgsl`.

use crate::image::Pixel;
use crate::ray::{Hit, Ray};
use crate::scene::Scene;
use crate::settings::{Settings, Shading};

/// The pixel of a ray that hit, or missed.
#[must_use]
pub fn shade(scene: &Scene, settings: &Settings, ray: &Ray, hit: Option<&Hit>) -> Pixel {
    let Some(hit) = hit else {
        return Pixel::miss(settings.background().to_array());
    };
    let surface = scene.color(hit.id).to_array();
    let color = match settings.shading() {
        Shading::Flat => surface,
        Shading::Headlight => {
            let cosine = hit.normal.dot(ray.direction).abs();
            surface.map(|c| (f64::from(c) * cosine) as f32)
        }
    };
    Pixel {
        color,
        depth: hit.t as f32,
        normal: hit.normal.as_vec3().to_array(),
        position: ray.at(hit.t).as_vec3().to_array(),
        albedo: surface,
        id: hit.id,
    }
}
