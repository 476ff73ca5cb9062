//! What a scene accepts, and in which frame it keeps it.

use glam::DVec3;
use pinhole::scene::SceneError;
use pinhole::scene::sphere::SphereError;
use pinhole::{Colors, LinearRgb, Scene, Sphere, glam};

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

/// A list that is long enough for several threads.
fn many(random: &mut fastrand::Rng, at: f64) -> Vec<[f64; 4]> {
    let coordinate = |random: &mut fastrand::Rng| at + random.f64() * 10.0 - 5.0;
    (0..200_000)
        .map(|_| [0; 3].map(|_| coordinate(random)))
        .map(|[x, y, z]| [x, y, z, 0.1])
        .collect()
}

#[test]
fn arrays_make_the_scene_that_spheres_make() {
    let mut random = fastrand::Rng::with_seed(15);
    for at in [0.0, 1000.0, 1e7] {
        let wide = many(&mut random, at);
        let narrow: Vec<[f32; 4]> = wide.iter().map(|s| s.map(|x| x as f32)).collect();
        let same = |scene: Scene, spheres: Vec<Sphere>| {
            let expected = Scene::new(&spheres).unwrap();
            assert_eq!(scene.origin(), expected.origin());
            assert_eq!(scene.bounds(), expected.bounds());
            assert_eq!(scene.spheres(), expected.spheres());
            assert_eq!(scene.appearance(), expected.appearance());
            assert_eq!(scene.appearance().colors(), &Colors::One(LinearRgb::WHITE));
            assert_eq!(scene.color(17), LinearRgb::WHITE);
        };
        let spheres = wide.iter().map(|&[x, y, z, r]| sphere([x, y, z], r)).collect();
        same(Scene::from_f64(&wide, LinearRgb::WHITE).unwrap(), spheres);
        let spheres = narrow.iter().map(|s| s.map(f64::from));
        let spheres = spheres.map(|[x, y, z, r]| sphere([x, y, z], r)).collect();
        same(Scene::from_f32(narrow, LinearRgb::WHITE).unwrap(), spheres);
    }
}

#[test]
fn arrays_near_the_origin_are_not_copied() {
    let spheres = vec![[0.5, 0.25, 0.0, 0.5]; 1000];
    let place = spheres.as_ptr();
    let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
    assert_eq!(scene.spheres().as_ptr(), place);
    assert!(Scene::from_f32(Vec::new(), LinearRgb::WHITE).unwrap().bounds().is_none());
}

/// f64 data ten million units away has the shape that it has at the origin, to the last bit of what f64
/// keeps there.
#[test]
fn arrays_far_from_the_origin_keep_their_shape() {
    let mut random = fastrand::Rng::with_seed(16);
    // Multiples of 2⁻²⁰, which f64 adds to 10⁷ exactly.
    let step = f64::from(1 << 20).recip();
    let mut coordinate = || (f64::from(random.i32(-5_000_000..5_000_000))) * step;
    let near: Vec<[f64; 4]> =
        (0..1000).map(|_| [coordinate(), coordinate(), coordinate(), 0.1]).collect();
    let far: Vec<_> = near.iter().map(|[x, y, z, r]| [x + 1e7, y - 1e7, z + 1e7, *r]).collect();
    let near_scene = Scene::from_f64(&near, LinearRgb::WHITE).unwrap();
    let far_scene = Scene::from_f64(&far, LinearRgb::WHITE).unwrap();
    assert_eq!(near_scene.origin(), DVec3::ZERO);
    for (near, far) in near_scene.spheres().iter().zip(far_scene.spheres()) {
        for axis in 0..3 {
            let at = [1e7, -1e7, 1e7][axis] - far_scene.origin()[axis];
            let back = f64::from(far[axis]) - at;
            assert!((back - f64::from(near[axis])).abs() < 1e-6, "{near:?} {far:?}");
        }
    }
}

#[test]
fn the_first_bad_sphere_of_an_array_is_named_however_many_threads_look() {
    let mut random = fastrand::Rng::with_seed(17);
    let mut spheres = many(&mut random, 0.0);
    for bad in [199_999, 150_000, 70_001, 3] {
        spheres[bad][3] = -1.0;
        let expected = format!("sphere {bad}: its radius is -1.0; ");
        let narrow: Vec<[f32; 4]> = spheres.iter().map(|s| s.map(|x| x as f32)).collect();
        for error in [
            Scene::from_f64(&spheres, LinearRgb::WHITE).unwrap_err(),
            Scene::from_f32(narrow, LinearRgb::WHITE).unwrap_err(),
        ] {
            assert!(error.to_string().starts_with(&expected), "{error}");
        }
    }
}
