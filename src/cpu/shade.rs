//! Shading of primary hits. The WGSL twin is `shaders/primary/shade.wgsl`.

use crate::geometry::ray::{Hit, Ray};
use crate::image::Pixel;
use crate::render::{PrimarySettings, Shading};
use crate::scene::Scene;

/// The pixel of a primary ray that hits a sphere.
#[must_use]
pub fn shade(scene: &Scene, primary: &PrimarySettings, ray: &Ray, hit: &Hit) -> Pixel {
    let surface = scene.color(hit.id).to_array();
    let color = match primary.shading {
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
