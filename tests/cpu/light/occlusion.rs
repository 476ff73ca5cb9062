//! Ambient occlusion and shadows on nothing, against integrals over what hides the light.

use std::f64::consts::{PI, TAU};

use pinhole::glam::DVec3;
use pinhole::light::{Ground, Light, LightFrame, LightKind};
use pinhole::render::{Integrator, LightSampling, Occlusion, Studio};
use pinhole::{LinearRgb, RenderSettings, Sphere};

use super::{Shot, by, paths, white};

fn studio(samples: u32, occlusion: Occlusion) -> RenderSettings {
    let studio =
        Studio { ambient: LinearRgb::WHITE, occlusion: Some(occlusion), ..Studio::default() };
    by(Integrator::Studio(studio), &paths(samples, LightSampling::Chance))
}

/// The cosine-weighted share of directions around a normal in which a sphere is: by midpoints over its cone, of which
/// what lies below the horizon counts nothing.
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

/// Two spheres that touch: of each, the other hides what lies in its cone above the horizon.
#[test]
fn ambient_light_between_two_spheres() {
    let spheres = [white([-1.0, 0.0, 0.0], 1.0), white([0.5, 0.0, 0.0], 0.5)];
    // So large that a pixel is a point.
    let shot = Shot::new(&spheres, [0.0, 0.0, 0.0], 1.0, 1 << 12);
    let samples = 64;
    let lighting = studio(samples, Occlusion { radius: None, samples: 64 });
    let picture = shot.picture(&lighting);
    let mut darkest = 1.0;
    for k in 0..200 {
        let pixel = [300 + 17 * k, 2048 + 5 * (k % 50)];
        let ray = shot.ray(pixel);
        let hit = pinhole::cpu::trace(&shot.scene, &ray).unwrap();
        let other = &spheres[1 - hit.id as usize];
        let center = DVec3::from(other.center);
        let wanted = 1.0 - hidden(ray.at(hit.t), hit.normal, center, other.radius);
        let found = (0..samples).map(|s| picture.sample(pixel, s).color[0]).sum::<f64>()
            / f64::from(samples);
        // Of 4096 directions, as if they were independent, four standard errors; they are placed more evenly.
        let bound = 4.0 * (wanted * (1.0 - wanted) / 4096.0).sqrt();
        assert!((found - wanted).abs() <= bound + 1e-3, "{pixel:?}: {found}, not {wanted}");
        darkest = wanted.min(darkest);
    }
    assert!(darkest < 0.3, "{darkest}");
}

/// What is farther away than the radius hides nothing.
#[test]
fn the_radius_ends_occlusion() {
    let spheres = [white([0.0; 3], 1.0), white([0.0, 0.0, 4.0], 1.0)];
    let shot = Shot::new(&spheres[..], [0.6, 0.0, 1.0], 0.2, 8);
    let colors = |radius| {
        let image = shot.render(&studio(16, Occlusion { radius, samples: 16 }));
        image.color().iter().map(|c| f64::from(c[0])).sum::<f64>() / 64.0
    };
    assert_eq!(colors(Some(1.5)), 1.0);
    assert!(colors(None) < 0.97);
    assert!((colors(Some(100.0)) - colors(None)).abs() < 1e-12);
}

/// A catcher under a sphere, in even light from above and everywhere: as opaque as light is missing. Nothing else of
/// it is seen.
#[test]
fn shadows_on_nothing() {
    let center = DVec3::new(0.0, 3.0, 0.0);
    let spheres = [Sphere::new(center.to_array(), 1.0, LinearRgb::BLACK)];
    let from_above = Light {
        kind: LightKind::Directional {
            toward: DVec3::new(1.0, 1.0, 0.0),
            strength: LinearRgb::WHITE,
            angular_radius: 0.0,
        },
        frame: LightFrame::World,
    };
    let ground = Ground {
        point: DVec3::ZERO,
        normal: DVec3::Y,
        color: LinearRgb::BLACK,
        is_shadow_catcher: true,
    };
    let base = studio(16, Occlusion { radius: None, samples: 64 });
    let lighting = RenderSettings {
        lights: vec![from_above],
        ground: Some(ground),
        background: LinearRgb::WHITE,
        ..base
    };
    // From the front and above: the plane y = 0 is where nothing else is seen.
    let pose =
        pinhole::camera::Pose::looking_at([0.0, 8.0, 20.0], [-1.5, 0.0, 0.0], [0.0, 1.0, 0.0])
            .unwrap();
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
        // In the shadow, which the light casts along (−1, −1, 0).
        let toward = DVec3::new(1.0, 1.0, 0.0) / 2.0_f64.sqrt();
        let beside = (center - p) - (center - p).dot(toward) * toward;
        if (beside.length() - 1.0).abs() < 0.01 {
            continue;
        }
        let is_dark = beside.length() < 1.0;
        // The light's share is its cosine.
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
