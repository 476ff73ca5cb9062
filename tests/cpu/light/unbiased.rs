//! However light is looked for, as much of it is found.

use std::sync::Arc;

use pinhole::camera::{PinholeCamera, Pose};
use pinhole::glam::DVec3;
use pinhole::light::{Ground, Light, LightFrame, LightKind, Sky, SkyLight};
use pinhole::render::{Integrator, LightSampling, PathTracing};
use pinhole::{Environment, Film, Image, Material, RenderSettings, Scene, Sphere};

use super::{Shot, blocks, gray, paths, rgb, standard_errors};
use crate::support::effort::{effort, tries};

/// Lobes, metal, glass, what lets light pass, and emissive spheres, of which one lets light pass, one is partly
/// inside another sphere, and one is where another is.
fn spheres() -> Vec<Sphere> {
    let sphere =
        |x: f64, y: f64, z: f64, r: f64, color: [f32; 3]| Sphere::new([x, y, z], r, rgb(color));
    let glossy = Material::Lambert { specular: 0.4, roughness: 0.4 };
    let lamp = |strength| Material::Emissive { strength };
    vec![
        sphere(-1.0, 0.7, 0.0, 0.7, [0.8, 0.3, 0.3]).with_material(glossy),
        sphere(0.6, 0.6, 0.2, 0.6, [0.9, 0.8, 0.4])
            .with_material(Material::Conductor { roughness: 0.5 }),
        sphere(-0.1, 0.3, 1.1, 0.3, [0.4, 0.8, 0.9]).with_opacity(0.6),
        sphere(0.9, 0.25, 1.2, 0.25, [0.9, 0.9, 1.0]).with_material(Material::Dielectric {
            ior: 1.5,
            roughness: 0.3,
            attenuation_distance: Some(0.5),
        }),
        sphere(-0.2, 1.6, 0.6, 0.3, [1.0, 0.7, 0.4]).with_material(lamp(4.0)),
        sphere(1.5, 1.4, 0.2, 0.4, [0.5, 0.7, 1.0]).with_material(lamp(2.0)).with_opacity(0.5),
        sphere(-1.0, 0.3, 0.75, 0.25, [0.7, 1.0, 0.7]).with_material(lamp(1.5)),
        sphere(-1.0, 0.3, 0.75, 0.25, [1.0, 0.7, 0.7]).with_material(lamp(3.0)),
    ]
}

fn lighting(samples: u32, light_sampling: LightSampling, seed: u32) -> RenderSettings {
    let sun = LightKind::Directional {
        toward: DVec3::new(1.0, 1.0, 0.5),
        strength: gray(0.6),
        angular_radius: 0.35,
    };
    let point = LightKind::Point { position: DVec3::new(-2.0, 2.0, 2.0), intensity: gray(1.0) };
    let mut texels = vec![[0.2, 0.3, 0.5]; 32];
    texels[10] = [4.0, 3.0, 2.0];
    texels[21] = [0.0; 3];
    let environment = Arc::new(Environment::new(8, 4, texels).unwrap());
    let base = paths(samples, light_sampling);
    let tracing = PathTracing { max_depth: 6, roulette_from: 2, light_sampling };
    RenderSettings {
        integrator: Integrator::Path(tracing),
        sampling: pinhole::render::Sampling { seed, ..base.sampling },
        lights: [sun, point].map(|kind| Light { kind, frame: LightFrame::World }).into(),
        sky: Sky {
            light: SkyLight::Image { environment, strength: 0.75, rotation: 0.6 },
            is_visible: true,
        },
        ground: Some(Ground {
            point: DVec3::ZERO,
            normal: DVec3::Y,
            color: gray(0.6),
            is_shadow_catcher: false,
        }),
        ..base
    }
}

/// From the front and above, so that all of the picture is ground and spheres.
fn shot() -> Shot {
    let pose = Pose::looking_at([0.3, 6.0, 9.0], [0.2, 0.5, 0.4], [0.0, 1.0, 0.0]).unwrap();
    Shot {
        scene: Scene::new(&spheres()).unwrap(),
        camera: Box::new(PinholeCamera::with_vertical_fov(pose, 0.3, 1.0).unwrap()),
        film: Film::new(32, 32).unwrap(),
    }
}

fn luminances(image: &Image) -> Vec<f64> {
    let luminance = |[r, g, b]: &[f64; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    blocks(image, 4).iter().map(luminance).collect()
}

#[test]
fn chance_and_search_find_the_same_light() {
    let shot = shot();
    // A seed of its own each, or what they have in common would not count.
    let ways = [
        (LightSampling::Chance, 8192, 1),
        (LightSampling::Direct, 2048, 2),
        (LightSampling::Multiple, 2048, 3),
    ];
    let images = ways.map(|(way, samples, seed)| {
        let image = shot.render(&lighting(tries(samples), way, seed));
        (luminances(&image), standard_errors(&image, 4))
    });
    for (a, b) in [(0, 1), (0, 2), (1, 2)] {
        for block in 0..16 {
            let [(light, error), (other, other_error)] =
                [a, b].map(|way| (images[way].0[block], images[way].1[block]));
            let bound = 4.0 * error.hypot(other_error);
            let difference = light - other;
            let ways = (ways[a].0, ways[b].0);
            assert!(difference.abs() < bound, "{ways:?}, {block}: {light}, {other} ± {bound}");
            // Or nothing would be told. Noise falls with the root of the number of samples.
            assert!(bound < 0.04 * light / effort().sqrt(), "{ways:?}, {block}: {light} ± {bound}");
        }
    }
}

/// Russian roulette changes nothing but noise.
#[test]
fn paths_that_end_by_chance_lose_nothing() {
    let shot = shot();
    let render = |roulette_from, seed| {
        let mut lighting = lighting(tries(1024), LightSampling::Multiple, seed);
        let Integrator::Path(tracing) = &mut lighting.integrator else { panic!() };
        tracing.roulette_from = roulette_from;
        let image = shot.render(&lighting);
        (luminances(&image), standard_errors(&image, 4))
    };
    let (early, never) = (render(0, 8), render(u32::MAX, 9));
    for block in 0..16 {
        let bound = 4.0 * early.1[block].hypot(never.1[block]);
        let difference = (early.0[block] - never.0[block]).abs();
        assert!(difference < bound, "{block}: {difference}, {bound}");
    }
}
