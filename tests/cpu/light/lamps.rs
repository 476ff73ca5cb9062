//! Lights over a plane and a sphere, ambient occlusion, and shadow catchers, compared with integrals on paper.

use std::f64::consts::{PI, TAU};

use pinhole::glam::DVec3;
use pinhole::light::{Ground, Light, LightFrame, LightKind, Sky, SkyLight};
use pinhole::render::{Integrator, LightSampling, Occlusion, Studio};
use pinhole::{LinearRgb, RenderSettings, Sphere, cpu};

use super::{Shot, blocks, by, emissive, gray, ground, light, paths, rgb, standard_errors, studio, sun, white};

fn floor(color: LinearRgb) -> Option<Ground> {
    Some(ground(DVec3::ZERO, DVec3::new(0.0, 0.0, 2.0), color))
}

/// Settings of a studio and of paths.
fn on_the_floor(samples: u32, lights: &[LightKind], sampling: LightSampling) -> [RenderSettings; 2] {
    let in_studio = RenderSettings { ground: floor(gray(0.5)), ..studio(samples, lights) };
    let RenderSettings { lights, ground, .. } = in_studio.clone();
    [in_studio, RenderSettings { lights, ground, ..paths(samples, sampling) }]
}

/// The point where the ray of a pixel hits the ground.
fn on_ground(shot: &Shot, pixel: [u32; 2]) -> DVec3 {
    let ray = shot.ray(pixel);
    ray.at(-ray.origin.z / ray.direction.z)
}

const LAMP: DVec3 = DVec3::new(3.0, 0.0, 2.5);
const LAMP_RADIUS: f64 = 1.0;

/// A plane of colour 0.5 in the light of a sphere of radiance 2 that is wholly above it. E is π L (R/d)² cos θ, and 0.5
/// E/π of that is visible.
fn lit_plane(p: DVec3) -> f64 {
    let to_lamp = LAMP - p;
    let d = to_lamp.length();
    0.5 * 2.0 * (LAMP_RADIUS / d).powi(2) * to_lamp.z / d
}

/// The plane from above, without other visible objects. There may be an emissive sphere beside the picture.
fn plane(spheres: &[Sphere]) -> Shot {
    Shot::new(spheres, [0.0; 3], 1.0, 16)
}

/// The expected values of blocks of 4×4 pixels.
fn expected(shot: &Shot, of_point: impl Fn(DVec3) -> f64) -> Vec<f64> {
    let block = |b: u32| {
        let pixels = (0..16).map(|k| [b % 4 * 4 + k % 4, b / 4 * 4 + k / 4]);
        pixels.map(|pixel| of_point(on_ground(shot, pixel))).sum::<f64>() / 16.0
    };
    (0..16).map(block).collect()
}

#[test]
fn a_sphere_lamp_over_a_plane() {
    let lamp = LightKind::Sphere { center: LAMP, radius: LAMP_RADIUS, radiance: rgb([2.0, 1.0, 0.0]) };
    let shot = plane(&[]);
    for lighting in on_the_floor(64, &[lamp], LightSampling::Chance) {
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

/// An emissive sphere gives the same light with each sampling method. Multiple sampling does not count it twice.
#[test]
fn an_emissive_sphere_over_a_plane() {
    let sphere = Sphere::new(LAMP.to_array(), LAMP_RADIUS, LinearRgb::WHITE).with_material(emissive(2.0));
    let shot = plane(&[sphere]);
    for (sampling, samples) in
        [(LightSampling::Chance, 2048), (LightSampling::Direct, 64), (LightSampling::Multiple, 256)]
    {
        let lighting = RenderSettings { ground: floor(gray(0.5)), ..paths(samples, sampling) };
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

/// A directional light of strength 1 gives a surface that faces it the surface's own colour: sharp or soft, in a studio
/// or on paths, hit by chance or sampled.
#[test]
fn a_sun_over_a_plane() {
    let shot = plane(&[]);
    let toward = DVec3::new(1.0, -2.0, 2.0);
    for angular_radius in [0.0, 0.01, 0.7] {
        let sun = sun(toward, gray(1.5), angular_radius);
        let base = RenderSettings { ground: floor(gray(0.5)), ..studio(256, &[sun]) };
        let mut lightings = vec![base.clone()];
        for (sampling, samples) in
            [(LightSampling::Chance, 1024), (LightSampling::Direct, 256), (LightSampling::Multiple, 256)]
        {
            // Chance does not hit such a small light.
            if sampling != LightSampling::Chance || angular_radius != 0.01 {
                lightings.push(RenderSettings {
                    lights: base.lights.clone(),
                    ground: base.ground,
                    ..paths(samples, sampling)
                });
            }
        }
        // The mean of cosines over the disk is that of its middle, because all of it is above the plane.
        for lighting in lightings {
            let image = shot.render(&lighting);
            let [found, ..] = blocks(&image, 1)[0];
            assert!((found - 0.5).abs() < 1e-3, "{angular_radius}, {:?}: {found}", lighting.integrator);
        }
    }
}

#[test]
fn a_point_light_and_a_light_at_the_eye() {
    let shot = plane(&[]);
    let position = DVec3::new(0.5, 0.2, 1.5);
    let lights = [LightKind::Point { position, intensity: gray(3.0) }, LightKind::Head { strength: gray(0.25) }];
    for lighting in on_the_floor(16, &lights, LightSampling::Multiple) {
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

/// A light in the camera's frame moves with the camera.
#[test]
fn lights_turn_with_the_camera() {
    let shot = plane(&[]);
    let kind = sun(DVec3::new(0.0, 3.0, 4.0), LinearRgb::WHITE, 0.0);
    let lights = vec![Light { kind, frame: LightFrame::Camera }];
    let lighting = RenderSettings { lights, ground: floor(LinearRgb::WHITE), ..studio(1, &[]) };
    for color in shot.render(&lighting).color() {
        assert!((color[0] - 0.8).abs() < 1e-6, "{color:?}");
    }
}

/// Each pixel of a convex matt sphere is its colour times the cosine, with or without shadows. No point is in the
/// shadow of its own sphere, even where light grazes.
#[test]
fn a_sphere_casts_no_shadow_on_what_faces_the_light() {
    let toward = DVec3::new(1.0, 0.4, 0.1).normalize_or(DVec3::X);
    let sun = sun(toward, LinearRgb::WHITE, 0.0);
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
            // A pixel is 1/1900 of the radius wide, and more at a slant.
            let slant = -hit.normal.dot(shot.ray(pixel).direction);
            assert!((found - wanted).abs() < 3e-4 / slant, "{radius}: {found}, not {wanted}");
        }
    }
}

/// Under a uniform sky, a convex matt sphere has exactly its colour times the sky's everywhere.
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

/// A sphere lamp around the scene lights it as a uniform sky does.
#[test]
fn inside_a_lamp() {
    let lamp = LightKind::Sphere { center: DVec3::ZERO, radius: 9.0, radiance: gray(0.5) };
    let shot = Shot::new(&[white([0.3, 0.2, 0.1], 0.5)], [0.3, 0.2, 0.1], 0.2, 16);
    for lighting in
        [studio(256, &[lamp]), RenderSettings { lights: vec![light(lamp)], ..paths(256, LightSampling::Multiple) }]
    {
        for color in blocks(&shot.render(&lighting), 4) {
            assert!((color[0] - 0.5).abs() < 2e-3, "{color:?}");
        }
    }
}

fn occluded(samples: u32, occlusion: Occlusion) -> RenderSettings {
    let studio = Studio { ambient: LinearRgb::WHITE, occlusion: Some(occlusion), ..Studio::default() };
    by(Integrator::Studio(studio), &paths(samples, LightSampling::Chance))
}

/// The cosine-weighted share of directions around a normal that a sphere hides, by midpoints over the sphere's cone.
/// Directions below the horizon count nothing.
fn hidden(point: DVec3, normal: DVec3, center: DVec3, radius: f64) -> f64 {
    const STEPS: u32 = 400;
    let to_center = center - point;
    let axis = to_center / to_center.length();
    let cone = 1.0 - (1.0 - (radius / to_center.length()).powi(2)).max(0.0).sqrt();
    let (x, y) = axis.any_orthonormal_pair();
    let mut sum = 0.0;
    for i in 0..STEPS {
        let cosine = 1.0 - cone * (f64::from(i) + 0.5) / f64::from(STEPS);
        let sine = (1.0 - cosine * cosine).sqrt();
        for j in 0..STEPS {
            let (s, c) = (TAU * (f64::from(j) + 0.5) / f64::from(STEPS)).sin_cos();
            let w = cosine * axis + sine * (c * x + s * y);
            sum += w.dot(normal).max(0.0);
        }
    }
    sum * cone * TAU / f64::from(STEPS).powi(2) / PI
}

#[test]
fn the_integral_is_that_of_a_sphere_above_the_horizon() {
    // (r/d)² cos θ.
    let found = hidden(DVec3::ZERO, DVec3::Z, DVec3::new(1.0, 0.0, 2.0), 0.7);
    let wanted = 0.49 / 5.0 * 2.0 / 5.0_f64.sqrt();
    assert!((found - wanted).abs() < 1e-4 * wanted, "{found}, {wanted}");
}

/// Two spheres that touch. Each hides the other's directions in its cone above the horizon.
#[test]
fn ambient_light_between_two_spheres() {
    let spheres = [white([-1.0, 0.0, 0.0], 1.0), white([0.5, 0.0, 0.0], 0.5)];
    // So large that a pixel is nearly a point.
    let shot = Shot::new(&spheres, [0.0, 0.0, 0.0], 1.0, 1 << 12);
    let samples = 64;
    let lighting = occluded(samples, Occlusion { radius: None, samples: 64 });
    let picture = shot.picture(&lighting);
    let mut darkest = 1.0;
    for k in 0..200 {
        let pixel = [300 + 17 * k, 2048 + 5 * (k % 50)];
        let ray = shot.ray(pixel);
        let hit = pinhole::cpu::trace(&shot.scene, &ray).unwrap();
        let other = &spheres[1 - hit.id as usize];
        let center = DVec3::from(other.center);
        let wanted = 1.0 - hidden(ray.at(hit.t), hit.normal, center, other.radius);
        let found = (0..samples).map(|s| picture.sample(pixel, s).color[0]).sum::<f64>() / f64::from(samples);
        // The bound is four standard errors of 4096 independent directions. They are placed more evenly.
        let bound = 4.0 * (wanted * (1.0 - wanted) / 4096.0).sqrt();
        assert!((found - wanted).abs() <= bound + 1e-3, "{pixel:?}: {found}, not {wanted}");
        darkest = wanted.min(darkest);
    }
    assert!(darkest < 0.3, "{darkest}");
}

/// Spheres farther away than the radius hide nothing.
#[test]
fn the_radius_ends_occlusion() {
    let spheres = [white([0.0; 3], 1.0), white([0.0, 0.0, 4.0], 1.0)];
    let shot = Shot::new(&spheres[..], [0.6, 0.0, 1.0], 0.2, 8);
    let colors = |radius| {
        let image = shot.render(&occluded(16, Occlusion { radius, samples: 16 }));
        image.color().iter().map(|c| f64::from(c[0])).sum::<f64>() / 64.0
    };
    assert_eq!(colors(Some(1.5)), 1.0);
    assert!(colors(None) < 0.97);
    assert!((colors(Some(100.0)) - colors(None)).abs() < 1e-12);
}

/// A shadow catcher under a sphere, in even light from above and everywhere. Its opacity is the missing share of light,
/// and nothing else of it is visible.
#[test]
fn shadows_on_nothing() {
    let center = DVec3::new(0.0, 3.0, 0.0);
    let spheres = [Sphere::new(center.to_array(), 1.0, LinearRgb::BLACK)];
    let from_above = sun(DVec3::new(1.0, 1.0, 0.0), LinearRgb::WHITE, 0.0);
    let ground = ground(DVec3::ZERO, DVec3::Y, LinearRgb::BLACK);
    let base = occluded(16, Occlusion { radius: None, samples: 64 });
    let lighting = RenderSettings {
        lights: vec![light(from_above)],
        ground: Some(Ground { is_shadow_catcher: true, ..ground }),
        background: LinearRgb::WHITE,
        ..base
    };
    // From the front and above, so that the plane y = 0 fills the rest of the picture.
    let pose = pinhole::camera::Pose::looking_at([0.0, 8.0, 20.0], [-1.5, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
    let camera = pinhole::camera::PinholeCamera::with_vertical_fov(pose, 0.2, 1.0).unwrap();
    let shot = Shot {
        scene: pinhole::Scene::new(&spheres).unwrap(),
        camera: Box::new(camera),
        film: pinhole::Film::new(1 << 12, 1 << 12).unwrap(),
    };
    let picture = shot.picture(&lighting);
    let transparent = RenderSettings { is_transparent: true, ..lighting.clone() };
    let cut_out = shot.picture(&transparent);
    let (mut lit, mut dark) = (0, 0);
    for k in 0..300 {
        let pixel = [13 * k, (401 * k) % 4096];
        let ray = shot.ray(pixel);
        if pinhole::cpu::trace(&shot.scene, &ray).is_some() {
            continue;
        }
        let p = ray.at(-ray.origin.y / ray.direction.y);
        // In the shadow that the light casts along (−1, −1, 0).
        let toward = DVec3::new(1.0, 1.0, 0.0) / 2.0_f64.sqrt();
        let beside = (center - p) - (center - p).dot(toward) * toward;
        if (beside.length() - 1.0).abs() < 0.01 {
            continue;
        }
        let is_dark = beside.length() < 1.0;
        // The light's share is the cosine.
        let cosine = 0.5_f64.sqrt();
        let missing = hidden(p, DVec3::Y, center, 1.0) + if is_dark { cosine } else { 0.0 };
        let wanted = missing / (1.0 + cosine);
        let mean = |of: &dyn Fn(u32) -> f64| (0..16).map(of).sum::<f64>() / 16.0;
        let found = mean(&|s| picture.sample(pixel, s).alpha);
        assert!((found - wanted).abs() < 0.02, "{p}: {found}, not {wanted}");
        assert!((mean(&|s| picture.sample(pixel, s).color[1]) - (1.0 - found)).abs() < 1e-12);
        assert_eq!(mean(&|s| cut_out.sample(pixel, s).color[1]), 0.0);
        assert_eq!(mean(&|s| cut_out.sample(pixel, s).alpha), found);
        *(if is_dark { &mut dark } else { &mut lit }) += 1;
    }
    assert!(lit > 50 && dark > 20, "{lit}, {dark}");
}
