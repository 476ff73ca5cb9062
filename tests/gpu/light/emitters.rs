//! Tests of scenes whose table of emissive spheres has several layers.

use libtest_mimic::Trial;
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::cpu::{self, SearchStructure};
use pinhole::glam::DVec3;
use pinhole::gpu::Headless;
use pinhole::light::{Ground, Sky, SkyLight};
use pinhole::scene::material::SurfaceProperties;
use pinhole::{Film, LayerSet, LinearRgb, Material, RenderSettings, Scene};

use super::agree_with;
use super::scenes::LitView;
use crate::trial;

pub(super) fn trials() -> Vec<Trial> {
    vec![trial("light::emitters_beyond_one_layer_are_sampled", several_layers)]
}

/// A ceiling of lamps, of which the first layer of the table holds 1,398,101, above a matt ground.
fn several_layers(_: &'static Headless) {
    const COLUMNS: usize = 1250;
    let lamps: Vec<[f64; 4]> = (0..1200 * COLUMNS)
        .map(|i| {
            let (row, column) = ((i / COLUMNS) as f64, (i % COLUMNS) as f64);
            // The lamps of the last rows, which are in the second layer, are larger and give most of the light.
            let radius = if row < 1120.0 { 0.002 } else { 0.008 };
            [0.02 * column - 12.5, 2.0, 0.02 * row - 12.0, radius]
        })
        .collect();
    let surface = SurfaceProperties {
        material: Material::Emissive { strength: 400.0 },
        ..SurfaceProperties::default()
    };
    let scene = Scene::from_f64(&lamps, LinearRgb::WHITE).unwrap().with_surface(surface);
    let pose = Pose::looking_at([0.0, 1.0, 4.0], [0.0, 0.0, 11.0], [0.0, 1.0, 0.0]).unwrap();
    let mut settings = RenderSettings::path();
    settings.lights = Vec::new();
    settings.sky = Sky { light: SkyLight::Constant(LinearRgb::BLACK), is_visible: true };
    let (point, normal, color) = (DVec3::ZERO, DVec3::Y, LinearRgb::WHITE);
    settings.ground = Some(Ground { point, normal, color, is_shadow_catcher: false });
    settings.sampling.samples = 16;
    let view = LitView {
        scene,
        camera: Box::new(PinholeCamera::with_vertical_fov(pose, 0.6, 1.0).unwrap()),
        film: Film::new(24, 24).unwrap(),
        settings,
    };
    let tree = SearchStructure::new(&view.scene).unwrap();
    let wanted = cpu::render(&tree, &view.seen(), &view.settings, LayerSet::ALL).unwrap();
    let mean = wanted.color().iter().map(|c| f64::from(c[1])).sum::<f64>() / 576.0;
    assert!(mean > 0.01, "{mean}");
    agree_with(&view, &wanted).unwrap();
}
