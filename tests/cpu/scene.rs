//! What a scene accepts, and in which frame it keeps it.

use glam::DVec3;
use pinhole::scene::SceneError;
use pinhole::sphere::SphereError;
use pinhole::{LinearRgb, Scene, Sphere, glam};

fn sphere(center: [f64; 3], radius: f64) -> Sphere {
    Sphere::new(center, radius, LinearRgb::WHITE)
}

#[test]
fn bad_spheres_are_named_by_index() {
    let good = sphere([1.0, 2.0, 3.0], 1.0);
    let error = |bad: Sphere| Scene::new(&[good, good, bad, good]).unwrap_err();
    for radius in [0.0, -1.0, -0.0, f64::NAN, f64::INFINITY, 1e-40, 1e40] {
        let error = error(sphere([0.0; 3], radius));
        let expected = SphereError::Radius { radius };
        assert_eq!(error.to_string(), format!("sphere 2: {expected}"));
        assert!(error.to_string().starts_with("sphere 2: its radius is "), "{error}");
    }
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e20] {
        for axis in 0..3 {
            let mut center = [0.0; 3];
            center[axis] = x;
            let error = error(sphere(center, 1.0));
            let found =
                matches!(error, SceneError::Sphere { index: 2, error: SphereError::Center { .. } });
            assert!(found, "{error}");
        }
    }
}

#[test]
fn data_around_the_origin_keeps_its_numbers() {
    let scene = Scene::new(&[sphere([-4.0, 0.1, 0.0], 2.0), sphere([4.0, 0.0, 3.0], 2.0)]).unwrap();
    assert_eq!(scene.origin(), DVec3::ZERO);
    assert_eq!(scene.spheres()[0], [-4.0, 0.1, 0.0, 2.0]);
}

#[test]
fn data_far_from_the_origin_keeps_its_shape() {
    let far = 123_456_789.0;
    let spheres: Vec<Sphere> =
        (0..100).map(|i| sphere([far + f64::from(i) * 0.01, -far, far], 0.004)).collect();
    let scene = Scene::new(&spheres).unwrap();
    for (given, kept) in spheres.iter().zip(scene.spheres()) {
        let world = scene.origin() + DVec3::new(kept[0].into(), kept[1].into(), kept[2].into());
        assert!((world - DVec3::from(given.center)).length() < 1e-6, "{world}");
    }
    // In f32 without a frame, neighbours would fall together: its step there is 8.
    assert_eq!(far as f32, (far + 0.01) as f32);
}

/// Only the axis along which the data is far is moved; what was exact in f32 stays exact.
#[test]
fn data_that_was_exact_in_f32_stays_exact() {
    let mut random = fastrand::Rng::with_seed(14);
    let exact = |x: f64| f64::from(x as f32);
    let spheres: Vec<Sphere> = (0..1000)
        .map(|_| {
            let [x, y, z] = [0; 3].map(|_| random.f64() * 10.0 - 5.0);
            sphere([exact(1000.0 + x), exact(y), exact(z - 77.0)], 0.1)
        })
        .collect();
    let scene = Scene::new(&spheres).unwrap();
    assert!(scene.origin().x != 0.0 && scene.origin().y == 0.0);
    for (given, kept) in spheres.iter().zip(scene.spheres()) {
        let kept = DVec3::new(kept[0].into(), kept[1].into(), kept[2].into());
        assert_eq!((scene.origin() + kept).to_array(), given.center);
    }
}

#[test]
fn bounds_hold_every_sphere() {
    let scene =
        Scene::new(&[sphere([-4.0, 0.0, 0.0], 2.0), sphere([1.0, 5.0, -3.0], 0.5)]).unwrap();
    let bounds = scene.bounds().unwrap();
    assert_eq!(bounds.min(), DVec3::new(-6.0, -2.0, -3.5));
    assert_eq!(bounds.max(), DVec3::new(1.5, 5.5, 2.0));
    assert!(Scene::new(&[]).unwrap().bounds().is_none());
}
