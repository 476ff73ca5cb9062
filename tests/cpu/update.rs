//! Scenes that change: what is updated is as in a scene that was made so, and what is refused changes nothing.

use fastrand::Rng;
use pinhole::scene::{Centers, NewColors, SceneUpdate};
use pinhole::{Appearance, Colors, LinearRgb, Scene, SphereArray};

use crate::support::appearances::kinds;

/// All that a scene consists of.
fn parts(scene: &Scene) -> (Vec<[f32; 4]>, Appearance, String) {
    let bounds = format!("{:?} {:?}", scene.bounds(), scene.origin());
    (scene.spheres().to_vec(), scene.appearance().clone(), bounds)
}

/// The same scene, made of its numbers.
fn fresh(scene: &Scene) -> Scene {
    let spheres = SphereArray::F32(scene.spheres().to_vec());
    Scene::from_parts(spheres, scene.appearance().clone()).unwrap()
}

#[test]
fn updates_are_as_a_scene_that_was_made_so() {
    let mut random = Rng::with_seed(41);
    for kind in kinds() {
        let mut scene = kind.scene;
        for _ in 0..50 {
            let first = random.usize(..scene.len());
            let count = random.usize(..=scene.len() - first);
            let centers: Vec<[f32; 3]> =
                (0..count).map(|_| [0; 3].map(|_| random.f32() * 4.0 - 2.0)).collect();
            let radii: Vec<f32> = (0..count).map(|_| 0.05 + random.f32() * 0.3).collect();
            let places: Vec<u32> = (0..count).map(|_| random.u32(..40)).collect();
            let rgba: Vec<[u8; 4]> = (0..count).map(|_| [0; 4].map(|_| random.u8(..))).collect();
            let colors = match scene.appearance().colors() {
                Colors::One(_) => None,
                Colors::Palette { .. } => Some(NewColors::Palette(&places)),
                Colors::Rgba8(_) => Some(NewColors::Rgba8(&rgba)),
                _ => Some(NewColors::Scalars(&radii)),
            };
            let update = SceneUpdate {
                first: first as u32,
                centers: random.bool().then_some(Centers::F32(&centers)),
                radii: random.bool().then_some(&radii[..]),
                colors: colors.filter(|_| random.bool()),
            };
            let before = scene.clone();
            scene.apply(&update).unwrap();
            for id in 0..scene.len() {
                let is_in = update.range().contains(&(id as u32));
                let place = id.wrapping_sub(first);
                let [x, y, z, r] = before.spheres()[id];
                let [x, y, z] =
                    if is_in && update.centers.is_some() { centers[place] } else { [x, y, z] };
                let r = if is_in && update.radii.is_some() { radii[place] } else { r };
                assert_eq!(scene.spheres()[id], [x, y, z, r]);
                if !is_in || update.colors.is_none() {
                    assert_eq!(scene.color(id as u32), before.color(id as u32));
                }
            }
            if let (Some(NewColors::Rgba8(colors)), true) = (update.colors, count > 0) {
                let [r, g, b, _] = colors[0];
                assert_eq!(scene.color(first as u32), LinearRgb::from_srgb8([r, g, b]));
            }
            assert_eq!(parts(&scene), parts(&fresh(&scene)), "{}", kind.name);
        }
    }
}

/// Far from the world's origin, centres are moved into the frame in f64.
#[test]
fn centers_are_in_the_world() {
    let spheres = [[1e7, 0.0, 0.0, 0.5], [1e7 + 3.0, 1.0, 0.0, 0.5]];
    let mut scene = Scene::from_f64(&spheres, LinearRgb::WHITE).unwrap();
    let origin = scene.origin();
    let moved = [[1e7 + 0.125, 0.25, 0.0]];
    let update =
        SceneUpdate { first: 1, centers: Some(Centers::F64(&moved)), ..SceneUpdate::default() };
    scene.apply(&update).unwrap();
    assert_eq!(scene.origin(), origin);
    let [x, y, z, radius] = scene.spheres()[1].map(f64::from);
    assert_eq!([x + origin.x, y + origin.y, z + origin.z, radius], [1e7 + 0.125, 0.25, 0.0, 0.5]);
}

#[test]
fn what_is_refused_is_named_and_changes_nothing() {
    let palette = vec![LinearRgb::WHITE; 3];
    let colors = Colors::Palette { palette, indices: vec![0; 10] };
    let spheres = SphereArray::F32(vec![[0.0, 0.0, 0.0, 0.5]; 10]);
    let mut scene = Scene::from_parts(spheres, Appearance::new(colors)).unwrap();
    let before = parts(&scene);
    let centers = [[1.0_f32; 3]; 4];
    let mut bad_centers = centers;
    bad_centers[2][1] = f32::NAN;
    let update = SceneUpdate { first: 4, ..SceneUpdate::default() };
    let moved = |centers| Some(Centers::F32(centers));
    let radii = Some(&[0.25, -1.0][..]);
    for (update, words) in [
        (SceneUpdate { first: 7, centers: moved(&centers), ..update }, "there is no sphere 10: "),
        (SceneUpdate { first: u32::MAX, centers: moved(&centers), ..update }, "there is no sphere"),
        (
            SceneUpdate { centers: moved(&bad_centers), ..update },
            "sphere 6: its center is [1.0, NaN",
        ),
        (SceneUpdate { radii, ..update }, "sphere 5: its radius is -1.0; "),
        (
            SceneUpdate { centers: moved(&centers), radii, ..update },
            "sphere 6 is not in every list: the update has a radius for 2 spheres, but 4",
        ),
        (
            SceneUpdate { colors: Some(NewColors::Palette(&[2, 3])), ..update },
            "sphere 5 has no color: its index is out of range; the palette has 3 colors",
        ),
        (
            SceneUpdate {
                radii: Some(&[1.0; 2]),
                colors: Some(NewColors::Palette(&[2])),
                ..update
            },
            "sphere 5 is not in every list: the update has a color for 1 spheres, but 2",
        ),
        (
            SceneUpdate { colors: Some(NewColors::Rgba8(&[[0; 4]])), ..update },
            "sphere 4 cannot be given individual colors: the scene's spheres have palette colors",
        ),
        // What comes before it is right, and is not kept.
        (
            SceneUpdate { radii: Some(&[0.25]), colors: Some(NewColors::Palette(&[9])), ..update },
            "sphere 4 has no color: its index is out of range; the palette has 3 colors",
        ),
    ] {
        let error = scene.apply(&update).unwrap_err();
        assert!(error.to_string().starts_with(words), "{error}");
        assert_eq!(parts(&scene), before, "{error}");
    }
    let scalars = [0.5, f32::NAN];
    let update = SceneUpdate { colors: Some(NewColors::Scalars(&scalars)), ..update };
    for mut kind in kinds() {
        let before = parts(&kind.scene);
        let refused = kind.scene.apply(&update).unwrap_err();
        let is_named = match kind.scene.appearance().colors() {
            Colors::Scalars { .. } => {
                refused.to_string().starts_with("sphere 5 has the number NaN")
            }
            _ => refused.to_string().starts_with("sphere 4 cannot be given"),
        };
        assert!(is_named, "{}: {refused}", kind.name);
        assert_eq!(format!("{:?}", parts(&kind.scene)), format!("{before:?}"));
    }
}
