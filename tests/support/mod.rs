//! Helpers that the CPU and the GPU tests share.
#![allow(dead_code, reason = "each test program uses some of it")]

pub(crate) mod appearances;
pub(crate) mod compare;
pub(crate) mod cones;
pub(crate) mod effort;
pub(crate) mod hosts;
pub(crate) mod legal_cameras;
pub(crate) mod legal_device;
pub(crate) mod maps;
pub(crate) mod random_light;
pub(crate) mod spheres;
mod view;

use pinhole::{Integrator, LinearRgb, RenderSettings, Scene, Shading, Sphere};

pub(crate) use view::View;

/// Settings for primary rays with a shading and a background.
pub(crate) fn shaded(shading: Shading, background: LinearRgb) -> RenderSettings {
    let integrator = Integrator::Primary(shading);
    RenderSettings { integrator, background, ..RenderSettings::default() }
}

/// The spheres of a scene, one by one, so that a test can change them.
pub(crate) fn spheres_of(scene: &Scene) -> Vec<Sphere> {
    let one = |(id, s): (u32, &[f32; 4])| {
        let [x, y, z, radius] = s.map(f64::from);
        let center = scene.origin() + pinhole::glam::DVec3::new(x, y, z);
        let mut sphere = Sphere::new(center.to_array(), radius, scene.color(id));
        sphere.surface = scene.surface(id);
        sphere
    };
    (0..).zip(scene.spheres()).map(one).collect()
}
