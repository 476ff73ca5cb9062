//! In a furnace, where light of radiance 1 comes from everywhere, surfaces that lose no light are invisible. Also tests
//! the view through spheres: absorption and opacity.

use pinhole::glam::DVec3;
use pinhole::light::{Sky, SkyLight};
use pinhole::render::{DepthCue, Integrator, LightSampling, Studio};
use pinhole::{LinearRgb, Material, RenderSettings, Sphere, cpu};

use super::{Shot, blocks, by, emissive, furnace, gray, paths, rgb, studio, sun, white};

/// The largest deviation of a block's mean from 1, which allows for the errors of energy tables.
const TOLERANCE: f64 = 1e-3;

fn glass(ior: f32, roughness: f32) -> Material {
    Material::Dielectric { ior, roughness, attenuation_distance: None }
}

fn ball(material: Material) -> Sphere {
    white([0.0; 3], 1.0).with_material(material)
}

/// Means of the quarters of a picture of 32×32 pixels.
fn quarters(spheres: &[Sphere], samples: u32) -> Vec<[f64; 3]> {
    blocks(&Shot::new(spheres, [0.0; 3], 1.2, 32).render(&furnace(samples)), 2)
}

#[track_caller]
fn assert_unseen(what: &str, spheres: &[Sphere], samples: u32) {
    for (quarter, color) in quarters(spheres, samples).into_iter().enumerate() {
        let is_one = color.iter().all(|c| (c - 1.0).abs() <= TOLERANCE);
        assert!(is_one, "{what}, quarter {quarter}: {color:?}");
    }
}

#[test]
fn matt_surfaces_and_metals_lose_nothing() {
    for color in quarters(&[ball(Material::default())], 4) {
        assert_eq!(color, [1.0; 3]);
    }
    for (roughness, samples) in [(0.02, 16), (0.1, 64), (0.3, 256), (0.6, 1024), (1.0, 1024)] {
        let lobe = Material::Lambert { specular: 0.5, roughness };
        for material in [lobe, Material::Conductor { roughness }] {
            assert_unseen(&format!("{material:?}"), &[ball(material)], samples);
        }
    }
}

/// Light that is refracted towards the wall at a flat angle may stay inside for more than 64 surfaces. That light is
/// missing for glass that is nearly smooth.
#[test]
fn glass_loses_nothing() {
    for ior in [1.0, 1.1, 1.5, 2.5] {
        assert_unseen(&format!("smooth, {ior}"), &[ball(glass(ior, 0.0))], 16);
    }
    let rough = [(1.0, 0.5, 16), (1.1, 0.3, 1024), (1.5, 0.3, 1024), (1.5, 0.6, 2048)];
    for (ior, roughness, samples) in rough {
        let what = format!("rough, {ior}, {roughness}");
        assert_unseen(&what, &[ball(glass(ior, roughness))], samples);
    }
}

#[test]
fn what_lets_light_pass_loses_nothing() {
    for (material, samples) in [
        (Material::default(), 16),
        (Material::Conductor { roughness: 0.4 }, 1024),
        (glass(1.5, 0.0), 16),
        (glass(1.5, 0.3), 1024),
    ] {
        let sphere = ball(material).with_opacity(0.5);
        assert_unseen(&format!("{material:?}"), &[sphere], samples);
    }
    assert_unseen("clear", &[ball(Material::default()).with_opacity(0.0)], 1);
}

#[test]
fn spheres_that_touch_or_overlap_lose_nothing() {
    let pair = |material: Material| {
        let spheres = [white([-0.6, 0.0, 0.0], 0.6), white([0.3, 0.1, 0.2], 0.5)];
        spheres.map(|sphere| sphere.with_material(material))
    };
    assert_unseen("touching", &[white([-0.5, 0.0, 0.0], 0.5), white([0.5, 0.0, 0.0], 0.5)], 64);
    assert_unseen("overlapping", &pair(Material::default()), 64);
    assert_unseen("overlapping metal", &pair(Material::Conductor { roughness: 0.3 }), 256);
    assert_unseen("overlapping glass", &pair(glass(1.5, 0.0)), 256);
}

#[test]
fn spheres_in_glass_lose_nothing() {
    let outer = ball(glass(1.5, 0.0));
    let inner = white([0.3, 0.2, 0.1], 0.5);
    let middle = white([0.0; 3], 0.5).with_material(glass(1.3, 0.0));
    assert_unseen("glass in the middle", &[outer, middle], 64);
    assert_unseen("glass", &[outer, inner.with_material(glass(1.3, 0.0))], 256);
    assert_unseen("matt", &[outer, inner], 256);
    let rough = [ball(glass(1.3, 0.3)), inner.with_material(glass(1.5, 0.4))];
    assert_unseen("rough glass in rough glass", &rough, 1024);
}

#[test]
fn colors_lose_what_they_say() {
    let color = rgb([0.8, 0.5, 0.0]);
    for found in quarters(&[Sphere::new([0.0; 3], 3.0, color)], 4) {
        for (found, wanted) in found.into_iter().zip([0.8, 0.5, 0.0]) {
            assert!((found - wanted).abs() < 1e-6, "{found}");
        }
    }
}

/// Between two spheres, light is scattered again, and loses more.
#[test]
fn light_between_two_spheres_loses_more() {
    let spheres = [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]].map(|c| Sphere::new(c, 0.5, gray(0.5)));
    let image = Shot::new(&spheres, [0.0; 3], 1.2, 32).render(&furnace(64));
    let mut least = 1.0;
    for ([found, ..], alpha) in image.color().iter().zip(image.alpha().unwrap()) {
        assert!(*found <= 1.0 - 0.5 * alpha, "{found}, {alpha}");
        least = found.min(least);
    }
    assert!(least < 0.35, "{least}");
}

/// A nearly smooth metal reflects the share that Schlick's formula gives for its colour at each angle.
#[test]
fn metals_are_white_where_light_grazes() {
    let metal = Material::Conductor { roughness: 0.02 };
    let sphere = Sphere::new([0.0; 3], 1.0, gray(0.3)).with_material(metal);
    // So large that a whole pixel is seen at one angle.
    let shot = Shot::new(&[sphere], [0.0; 3], 1.2, 1 << 14);
    let lighting = furnace(1);
    let picture = shot.picture(&lighting);
    for column in (1 << 13..).step_by(97).take(69) {
        let pixel = [column, 1 << 13];
        let ray = shot.ray(pixel);
        let cosine = -cpu::trace(&shot.scene, &ray).unwrap().normal.dot(ray.direction);
        let wanted = 0.3 + 0.7 * (1.0 - cosine).powi(5);
        let found = (0..64).map(|sample| picture.sample(pixel, sample).color[0]).sum::<f64>() / 64.0;
        assert!((found - wanted).abs() < 2e-3, "{cosine}: {found}, not {wanted}");
    }
}

const TINT: [f32; 3] = [0.9, 0.5, 0.1];

fn clear(attenuation_distance: f32) -> Material {
    Material::Dielectric { ior: 1.0, roughness: 0.0, attenuation_distance: Some(attenuation_distance) }
}

/// Beer's law along a chord, which no refraction bends: T^(chord/distance).
#[test]
fn absorption_along_a_chord() {
    let sphere = Sphere::new([0.0; 3], 2.0, rgb(TINT)).with_material(clear(1.5));
    let shot = Shot::new(&[sphere], [0.0; 3], 2.2, 1 << 12);
    let lighting = furnace(1);
    let picture = shot.picture(&lighting);
    for column in (2048..4096).step_by(61) {
        let pixel = [column, 2048];
        let ray = shot.ray(pixel);
        let foot = ray.origin - ray.origin.dot(ray.direction) * ray.direction;
        let half_chord = (4.0 - foot.length_squared()).max(0.0).sqrt();
        // Each sample is in the middle of its share once.
        let mean: Vec<f64> =
            (0..3).map(|c| (0..16).map(|s| picture.sample(pixel, s).color[c]).sum::<f64>() / 16.0).collect();
        for (found, tint) in mean.into_iter().zip(TINT) {
            let wanted = f64::from(tint).powf(2.0 * half_chord / 1.5);
            let slope = 2.0 / 1.5 * -f64::from(tint).ln() * wanted * 2.0 / half_chord.max(0.05);
            assert!((found - wanted).abs() < 1e-6 + 4e-4 * slope, "{column}: {found}, not {wanted}");
        }
    }
}

/// Glass that light leaves through a translucent wall absorbs no more.
#[test]
fn absorption_ends_where_glass_ends() {
    let sphere = Sphere::new([0.0; 3], 1.0, gray(0.5)).with_material(clear(1.0)).with_opacity(0.5);
    let far_behind = white([0.0, 0.0, -30.0], 5.0).with_material(emissive(1.0));
    let shot = Shot::from(8.0, &[sphere, far_behind], [0.0; 3], 0.01, 8);
    let found = blocks(&shot.render(&paths(256, LightSampling::Chance)), 1)[0][0];
    // Half of the light is lost at the entry, and then some on the way of 2.
    assert!((found - (0.5 + 0.5 * 0.25)).abs() < 1e-3, "{found}");
}

/// Both walls of a sphere of opacity a over a background: a + (1 − a) a of its own colour, and (1 − a)² of the rest.
#[test]
fn opacity_hides_twice() {
    let opacity = 0.3_f32;
    let a = f64::from(opacity);
    let front = Sphere::new([0.0; 3], 1.0, rgb([0.8, 0.4, 0.0])).with_material(emissive(1.0)).with_opacity(opacity);
    let behind = Sphere::new([0.0, 0.0, -20.0], 3.0, rgb([0.0, 0.5, 1.0])).with_material(emissive(2.0));
    let background = rgb([0.25; 3]);
    let wanted = |behind: [f64; 3]| {
        let own = [0.8, 0.4, 0.0];
        let covered = 1.0 - (1.0 - a).powi(2);
        [0, 1, 2].map(|c| covered * own[c] + (1.0 - covered) * behind[c])
    };
    for (spheres, behind, alpha) in
        [(vec![front], [0.25; 3], 1.0 - (1.0 - a).powi(2)), (vec![front, behind], [0.0, 1.0, 2.0], 1.0)]
    {
        let shot = Shot::from(8.0, &spheres, [0.0; 3], 0.01, 8);
        let path = paths(1024, LightSampling::Multiple);
        let sky = Sky { light: SkyLight::Constant(LinearRgb::BLACK), is_visible: false };
        let studio = Integrator::Studio(Studio::default());
        let path = RenderSettings { sky: sky.clone(), background, ..path };
        for (lighting, tolerance) in [(by(studio, &path), 1e-6), (path, 2e-3)] {
            let image = shot.render(&lighting);
            let found = blocks(&image, 1)[0];
            for (found, wanted) in found.into_iter().zip(wanted(behind)) {
                assert!((found - wanted).abs() < tolerance, "{found}, not {wanted}");
            }
            let mean = image.alpha().unwrap().iter().map(|a| f64::from(*a)).sum::<f64>() / 64.0;
            assert!((mean - alpha).abs() < tolerance, "{mean}, not {alpha}");
            // Without a background, the same minus the visible part of the background.
            let cut_out = blocks(&shot.render(&RenderSettings { is_transparent: true, ..lighting }), 1)[0];
            let missing = found[0] - cut_out[0];
            assert!((missing - (1.0 - mean) * 0.25).abs() < 1e-6, "{missing}");
        }
    }
}

/// In a studio, translucent spheres cast no shadow and hide no ambient light. Only as many walls as asked are visible.
#[test]
fn a_studio_sees_through() {
    let veils = [2.0, 4.0, 6.0].map(|z| Sphere::new([0.0, 0.0, z], 0.5, LinearRgb::BLACK).with_opacity(0.5));
    let spheres = [&veils[..], &[white([0.0; 3], 1.0)]].concat();
    let shot = Shot::from(8.0, &spheres, [0.0; 3], 0.01, 4);
    for (max_surfaces, seen) in [(64, 1.0 / 64.0), (7, 1.0 / 64.0), (6, 0.0), (3, 0.0)] {
        let sun = sun(DVec3::Z, LinearRgb::WHITE, 0.0);
        let mut lighting = studio(1, &[sun]);
        let Integrator::Studio(studio) = &mut lighting.integrator else { panic!() };
        studio.max_surfaces = max_surfaces;
        let image = shot.render(&lighting);
        for (color, alpha) in image.color().iter().zip(image.alpha().unwrap()) {
            assert!((f64::from(color[0]) - seen).abs() < 1e-4, "{max_surfaces}: {color:?}");
            let covered = if max_surfaces < 7 { 1.0 - 0.5_f32.powi(max_surfaces as i32) } else { 1.0 };
            assert!((alpha - covered).abs() < 1e-6, "{max_surfaces}: {alpha}");
        }
    }
}

/// Colour fades with the distance from the camera, also through clear spheres. The background does not fade.
#[test]
fn the_depth_cue() {
    let veil = Sphere::new([0.0, 0.0, 2.0], 0.5, LinearRgb::BLACK).with_opacity(0.0);
    let lamp = white([0.0; 3], 1.0).with_material(emissive(3.0));
    // The middle of the lamp is 7 units away.
    let shot = Shot::from(8.0, &[veil, lamp], [0.0; 3], 0.01, 1);
    for (near, far, fade) in [(0.0, 7.0, 1.0), (0.0, 28.0, 0.25), (6.0, 8.0, 0.5), (7.5, 9.0, 0.0)] {
        let cue = DepthCue { near, far, color: rgb([0.0, 1.0, 0.0]) };
        let studio = Studio { depth_cue: Some(cue), ..Studio::default() };
        let lighting = by(Integrator::Studio(studio), &paths(1, LightSampling::Chance));
        let [[red, green, _]] = blocks(&shot.render(&lighting), 1)[..] else { panic!() };
        assert!((red - 3.0 * (1.0 - fade)).abs() < 1e-4, "{near}, {far}: {red}");
        assert!((green - (3.0 - 2.0 * fade)).abs() < 1e-4, "{near}, {far}: {green}");
    }
}
