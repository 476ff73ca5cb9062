//! In a furnace, where light of radiance 1 comes from everywhere, nothing that loses no light is seen.

use pinhole::{LinearRgb, Material, Sphere, cpu};

use super::{Shot, blocks, furnace, gray, white};

/// How far from 1 the mean of a block may be: less than what tables of energies are interpolated by.
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
fn matt_surfaces_lose_nothing() {
    for color in quarters(&[ball(Material::default())], 4) {
        assert_eq!(color, [1.0; 3]);
    }
    for (roughness, samples) in [(0.02, 16), (0.1, 64), (0.3, 256), (0.6, 1024), (1.0, 1024)] {
        let lobe = Material::Lambert { specular: 0.5, roughness };
        assert_unseen(&format!("lobe {roughness}"), &[ball(lobe)], samples);
    }
}

#[test]
fn metals_lose_nothing() {
    for (roughness, samples) in [(0.02, 16), (0.1, 64), (0.3, 256), (0.6, 1024), (1.0, 1024)] {
        let conductor = Material::Conductor { roughness };
        assert_unseen(&format!("conductor {roughness}"), &[ball(conductor)], samples);
    }
}

/// Where light is refracted towards the wall at a flat angle it may stay inside for longer than 64 surfaces: that is
/// what is missing of glass that is nearly smooth.
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
    let color = LinearRgb::new([0.8, 0.5, 0.0]).unwrap();
    for found in quarters(&[Sphere::new([0.0; 3], 3.0, color)], 4) {
        for (found, wanted) in found.into_iter().zip([0.8, 0.5, 0.0]) {
            assert!((found - wanted).abs() < 1e-6, "{found}");
        }
    }
}

/// Between two spheres light is scattered again, and loses more.
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

/// A metal that is nearly smooth reflects what Schlick's formula says of its colour at each angle.
#[test]
fn metals_are_white_where_light_grazes() {
    let metal = Material::Conductor { roughness: 0.02 };
    let sphere = Sphere::new([0.0; 3], 1.0, gray(0.3)).with_material(metal);
    // So large that all of a pixel is seen at one angle.
    let shot = Shot::new(&[sphere], [0.0; 3], 1.2, 1 << 14);
    let lighting = furnace(1);
    let picture = shot.picture(&lighting);
    for column in (1 << 13..).step_by(97).take(69) {
        let pixel = [column, 1 << 13];
        let ray = shot.ray(pixel);
        let cosine = -cpu::trace(&shot.scene, &ray).unwrap().normal.dot(ray.direction);
        let wanted = 0.3 + 0.7 * (1.0 - cosine).powi(5);
        let found =
            (0..64).map(|sample| picture.sample(pixel, sample).color[0]).sum::<f64>() / 64.0;
        assert!((found - wanted).abs() < 2e-3, "{cosine}: {found}, not {wanted}");
    }
}
