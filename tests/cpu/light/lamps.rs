//! Lights over a plane and a sphere, against irradiance on paper.

use pinhole::glam::DVec3;
use pinhole::light::{Ground, Light, LightFrame, LightKind, Sky, SkyLight};
use pinhole::render::{Integrator, LightSampling, Studio};
use pinhole::{LinearRgb, Material, RenderSettings, Sphere, cpu};

use super::{Shot, blocks, by, gray, paths, rgb, standard_errors, white};

fn ground(color: LinearRgb) -> Ground {
    Ground {
        point: DVec3::ZERO,
        normal: DVec3::new(0.0, 0.0, 2.0),
        color,
        is_shadow_catcher: false,
    }
}

fn light(kind: LightKind) -> Light {
    Light { kind, frame: LightFrame::World }
}

/// Lights alone, with shadows.
fn studio(samples: u32, lights: &[LightKind]) -> RenderSettings {
    let studio = Studio { ambient: LinearRgb::BLACK, ..Studio::default() };
    RenderSettings {
        lights: lights.iter().copied().map(light).collect(),
        ..by(Integrator::Studio(studio), &paths(samples, LightSampling::Multiple))
    }
}

/// Where the ray of a pixel meets the ground.
fn on_ground(shot: &Shot, pixel: [u32; 2]) -> DVec3 {
    let ray = shot.ray(pixel);
    ray.at(-ray.origin.z / ray.direction.z)
}

const LAMP: DVec3 = DVec3::new(3.0, 0.0, 2.5);
const LAMP_RADIUS: f64 = 1.0;

/// A plane of colour 0.5 in the light of a sphere of radiance 2 that is wholly above it: E = π L (R/d)² cos θ, and
/// 0.5 E/π of that is seen.
fn lit_plane(p: DVec3) -> f64 {
    let to_lamp = LAMP - p;
    let d = to_lamp.length();
    0.5 * 2.0 * (LAMP_RADIUS / d).powi(2) * to_lamp.z / d
}

/// The plane from above, and nothing else, but perhaps an emissive sphere beside the picture.
fn plane(spheres: &[Sphere]) -> Shot {
    Shot::new(spheres, [0.0; 3], 1.0, 16)
}

/// What blocks of 4×4 pixels should have.
fn expected(shot: &Shot, of_point: impl Fn(DVec3) -> f64) -> Vec<f64> {
    let block = |b: u32| {
        let pixels = (0..16).map(|k| [b % 4 * 4 + k % 4, b / 4 * 4 + k / 4]);
        pixels.map(|pixel| of_point(on_ground(shot, pixel))).sum::<f64>() / 16.0
    };
    (0..16).map(block).collect()
}

#[test]
fn a_sphere_lamp_over_a_plane() {
    let lamp =
        LightKind::Sphere { center: LAMP, radius: LAMP_RADIUS, radiance: rgb([2.0, 1.0, 0.0]) };
    let in_studio = RenderSettings { ground: Some(ground(gray(0.5))), ..studio(64, &[lamp]) };
    let on_paths = RenderSettings {
        lights: in_studio.lights.clone(),
        ground: in_studio.ground,
        ..paths(64, LightSampling::Chance)
    };
    let shot = plane(&[]);
    for lighting in [in_studio, on_paths] {
        let image = shot.render(&lighting);
        for (found, wanted) in blocks(&image, 4).iter().zip(expected(&shot, lit_plane)) {
            for (found, wanted) in found.iter().zip([wanted, 0.5 * wanted, 0.0]) {
                assert!((found - wanted).abs() <= 2e-3 * wanted, "{found}, not {wanted}");
            }
        }
        assert!(image.alpha().unwrap().iter().all(|alpha| *alpha == 1.0));
        assert!(image.albedo().unwrap().iter().all(|albedo| *albedo == [0.5; 3]));
    }
}

/// The same light from a sphere of the scene, however it is found; not by chance and by search both.
#[test]
fn an_emissive_sphere_over_a_plane() {
    let sphere = Sphere::new(LAMP.to_array(), LAMP_RADIUS, LinearRgb::WHITE)
        .with_material(Material::Emissive { strength: 2.0 });
    let shot = plane(&[sphere]);
    for (sampling, samples) in
        [(LightSampling::Chance, 2048), (LightSampling::Direct, 64), (LightSampling::Multiple, 256)]
    {
        let lighting =
            RenderSettings { ground: Some(ground(gray(0.5))), ..paths(samples, sampling) };
        let image = shot.render(&lighting);
        let errors = standard_errors(&image, 4);
        let found = blocks(&image, 4);
        for ((found, error), wanted) in found.iter().zip(errors).zip(expected(&shot, lit_plane)) {
            let difference = (found[0] - wanted).abs();
            assert!(difference < 4.0 * error, "{sampling:?}: {found:?} ± {error}, not {wanted}");
            assert!(error < 2e-3, "{sampling:?}: {error}");
        }
    }
}

/// A directional light of strength 1 gives a surface that faces it its own colour: sharp or soft, in a studio or on
/// paths, found by chance or sought.
#[test]
fn a_sun_over_a_plane() {
    let shot = plane(&[]);
    let toward = DVec3::new(1.0, -2.0, 2.0);
    for angular_radius in [0.0, 0.01, 0.7] {
        let sun = LightKind::Directional { toward, strength: gray(1.5), angular_radius };
        let base = RenderSettings { ground: Some(ground(gray(0.5))), ..studio(256, &[sun]) };
        let mut lightings = vec![base.clone()];
        for (sampling, samples) in [
            (LightSampling::Chance, 1024),
            (LightSampling::Direct, 256),
            (LightSampling::Multiple, 256),
        ] {
            // Chance does not meet what is so small.
            if sampling != LightSampling::Chance || angular_radius != 0.01 {
                lightings.push(RenderSettings {
                    lights: base.lights.clone(),
                    ground: base.ground,
                    ..paths(samples, sampling)
                });
            }
        }
        // The mean of cosines over the disk is that of its middle; and all of it is above the plane.
        for lighting in lightings {
            let image = shot.render(&lighting);
            let [found, ..] = blocks(&image, 1)[0];
            assert!(
                (found - 0.5).abs() < 1e-3,
                "{angular_radius}, {:?}: {found}",
                lighting.integrator
            );
        }
    }
}

#[test]
fn a_point_light_and_a_light_at_the_eye() {
    let shot = plane(&[]);
    let position = DVec3::new(0.5, 0.2, 1.5);
    let lights = [
        LightKind::Point { position, intensity: gray(3.0) },
        LightKind::Head { strength: gray(0.25) },
    ];
    let in_studio = RenderSettings { ground: Some(ground(gray(0.5))), ..studio(16, &lights) };
    let on_paths = RenderSettings {
        lights: in_studio.lights.clone(),
        ground: in_studio.ground,
        ..paths(16, LightSampling::Multiple)
    };
    for lighting in [in_studio, on_paths] {
        let image = shot.render(&lighting);
        for j in 0..16 {
            for i in 0..16 {
                let p = on_ground(&shot, [i, j]);
                let to_light = position - p;
                let point = 0.5 * 3.0 * to_light.z / to_light.length().powi(3);
                let head = 0.5 * 0.25 * -shot.ray([i, j]).direction.z;
                let found = f64::from(image.color()[(j * 16 + i) as usize][0]);
                assert!((found - point - head).abs() < 4e-3, "{found}, not {point} + {head}");
            }
        }
    }
}

/// A light of the camera's frame is where the camera is.
#[test]
fn lights_turn_with_the_camera() {
    let shot = plane(&[]);
    let kind = LightKind::Directional {
        toward: DVec3::new(0.0, 3.0, 4.0),
        strength: LinearRgb::WHITE,
        angular_radius: 0.0,
    };
    let lights = vec![Light { kind, frame: LightFrame::Camera }];
    let lighting =
        RenderSettings { lights, ground: Some(ground(LinearRgb::WHITE)), ..studio(1, &[]) };
    for color in shot.render(&lighting).color() {
        assert!((color[0] - 0.8).abs() < 1e-6, "{color:?}");
    }
}

/// Each pixel of a convex matt sphere is its colour times the cosine, whether shadows are asked for or not: no point
/// is in the shadow of its own sphere, also where light grazes.
#[test]
fn a_sphere_casts_no_shadow_on_what_faces_the_light() {
    let toward = DVec3::new(1.0, 0.4, 0.1).normalize_or(DVec3::X);
    let sun = LightKind::Directional { toward, strength: LinearRgb::WHITE, angular_radius: 0.0 };
    for radius in [1e-4, 1.0, 1e6] {
        let sphere = Sphere::new([0.0; 3], radius, gray(0.5));
        let shot = Shot::new(&[sphere], [0.0; 3], 1.1 * radius, 1 << 12);
        let lighting = studio(1, &[sun]);
        let picture = shot.picture(&lighting);
        for k in 0..4000 {
            let pixel = [(k * 1021) % 4096, (k * 577) % 4096];
            let Some(hit) = cpu::trace(&shot.scene, &shot.ray(pixel)) else { continue };
            let wanted = 0.5 * hit.normal.dot(toward).max(0.0);
            let found = picture.sample(pixel, 0).color[0];
            // A pixel is 1/1900 of the radius wide, more where it is seen aslant.
            let slant = -hit.normal.dot(shot.ray(pixel).direction);
            assert!((found - wanted).abs() < 3e-4 / slant, "{radius}: {found}, not {wanted}");
        }
    }
}

/// Under a uniform sky, a convex matt sphere has its colour times the sky's everywhere, exactly.
#[test]
fn a_matt_sphere_under_a_uniform_sky() {
    let sphere = Sphere::new([0.0; 3], 1.0, rgb([0.75, 0.5, 0.25]));
    let shot = Shot::new(&[sphere], [0.0; 3], 1.2, 32);
    let sky = Sky { light: SkyLight::Constant(rgb([2.0, 4.0, 8.0])), is_visible: false };
    for sampling in [LightSampling::Chance, LightSampling::Direct, LightSampling::Multiple] {
        let lighting = RenderSettings { sky: sky.clone(), ..paths(4, sampling) };
        let image = shot.render(&lighting);
        for (color, alpha) in image.color().iter().zip(image.alpha().unwrap()) {
            assert_eq!(*color, [1.5, 2.0, 2.0].map(|c: f32| c * alpha));
        }
    }
}

/// A sphere lamp inside which everything is, lights as a uniform sky does.
#[test]
fn inside_a_lamp() {
    let lamp = LightKind::Sphere { center: DVec3::ZERO, radius: 9.0, radiance: gray(0.5) };
    let shot = Shot::new(&[white([0.3, 0.2, 0.1], 0.5)], [0.3, 0.2, 0.1], 0.2, 16);
    for lighting in [
        studio(256, &[lamp]),
        RenderSettings { lights: vec![light(lamp)], ..paths(256, LightSampling::Multiple) },
    ] {
        for color in blocks(&shot.render(&lighting), 4) {
            assert!((color[0] - 0.5).abs() < 2e-3, "{color:?}");
        }
    }
}
