//! Panorama and fisheye: their rays on paper, and back.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};
use pinhole::camera::{Camera, CameraError, FisheyeCamera, PanoramaCamera, Pose};
use pinhole::image::NO_ID;
use pinhole::{Film, LayerSet, LinearRgb, RenderSettings, Scene, Sphere, View, cpu, glam};

const EYE: [f64; 3] = [1.0, 2.0, 3.0];

/// Right is x, up is y.
fn pose() -> Pose {
    Pose::looking_along(EYE, [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap()
}

#[track_caller]
fn points(camera: &dyn Camera, location: [f64; 2], direction: [f64; 3]) {
    let ray = camera.ray_in_world(location.into());
    assert_eq!(ray.origin, DVec3::from(EYE));
    assert!((ray.direction - DVec3::from(direction)).length() < 1e-15, "{location:?}: {ray:?}");
}

#[test]
fn a_panorama_on_paper() {
    let camera = PanoramaCamera::new(pose());
    let half = 0.5_f64.sqrt();
    points(&camera, [0.0, 0.0], [0.0, 0.0, -1.0]);
    points(&camera, [0.5, 0.0], [1.0, 0.0, 0.0]);
    points(&camera, [-0.5, 0.0], [-1.0, 0.0, 0.0]);
    points(&camera, [1.0, 0.0], [0.0, 0.0, 1.0]);
    points(&camera, [-1.0, 0.0], [0.0, 0.0, 1.0]);
    points(&camera, [0.25, 0.0], [half, 0.0, -half]);
    points(&camera, [0.3, 1.0], [0.0, 1.0, 0.0]);
    points(&camera, [0.3, -1.0], [0.0, -1.0, 0.0]);
    points(&camera, [0.0, 0.5], [0.0, half, -half]);
    points(&camera, [0.5, -0.5], [half, -half, 0.0]);
}

#[test]
fn a_fisheye_on_paper() {
    let half = 0.5_f64.sqrt();
    let camera = FisheyeCamera::new(pose(), PI, 2.0).unwrap();
    points(&camera, [0.0, 0.0], [0.0, 0.0, -1.0]);
    // The film is twice as wide as the disk.
    points(&camera, [0.5, 0.0], [1.0, 0.0, 0.0]);
    points(&camera, [0.0, 1.0], [0.0, 1.0, 0.0]);
    points(&camera, [0.25, 0.0], [half, 0.0, -half]);
    points(&camera, [0.0, -0.5], [0.0, -half, -half]);
    for (location, is_seen) in [
        ([0.5, 0.0], true),
        ([0.501, 0.0], false),
        ([0.0, 1.0], true),
        ([0.36, 0.72], false),
        ([0.35, 0.7], true),
        ([1.0, 1.0], false),
    ] {
        assert_eq!(camera.sees(location.into()), is_seen, "{location:?}");
    }
    let all = FisheyeCamera::new(pose(), TAU, 0.5).unwrap();
    points(&all, [1.0, 0.0], [0.0, 0.0, 1.0]);
    points(&all, [0.0, -0.25], [0.0, -1.0, 0.0]);
    points(&all, [0.5, 0.0], [1.0, 0.0, 0.0]);
}

#[test]
fn a_point_on_a_ray_is_seen_where_the_ray_comes_from() {
    let pose = Pose::looking_along(EYE, [0.3, -0.4, 0.8], [0.1, 1.0, 0.2]).unwrap();
    let cameras: [&dyn Camera; 5] = [
        &PanoramaCamera::new(pose),
        &FisheyeCamera::new(pose, TAU, 1.0).unwrap(),
        &FisheyeCamera::new(pose, PI, 1.7).unwrap(),
        &FisheyeCamera::new(pose, 0.01, 0.6).unwrap(),
        &FisheyeCamera::new(pose, 4.0, 1.0).unwrap(),
    ];
    let mut random = fastrand::Rng::with_seed(11);
    for camera in cameras {
        let mut seen = 0;
        for _ in 0..2000 {
            let location = (DVec2::new(random.f64(), random.f64()) * 2.0 - 1.0) * 0.999;
            let ray = camera.ray_in_world(location);
            assert!((ray.direction.length() - 1.0).abs() < 1e-15);
            if camera.sees(location) {
                let back = camera.location_of(ray.at(random.f64() * 100.0 + 0.1)).unwrap();
                assert!((back - location).length() < 1e-9, "{camera:?}: {back} is not {location}");
                seen += 1;
            }
        }
        assert!(seen > 500, "{camera:?}");
        assert_eq!(camera.location_of(DVec3::from(EYE)), None);
    }
    let narrow = FisheyeCamera::new(pose, 1.0, 1.0).unwrap();
    let behind = DVec3::from(EYE) - DVec3::new(0.3, -0.4, 0.8);
    assert_eq!(narrow.location_of(behind), None);
}

/// A sphere all around: every pixel of the disk, and none outside of it.
#[test]
fn outside_of_the_disk_there_is_nothing() {
    let scene = Scene::new(&[Sphere::new(EYE, 5.0, LinearRgb::WHITE)]).unwrap();
    let film = Film::new(90, 60).unwrap();
    let camera = FisheyeCamera::new(pose(), TAU, film.aspect()).unwrap();
    let image =
        cpu::render(&scene, &View::new(&camera, film), &RenderSettings::default(), LayerSet::ALL)
            .unwrap();
    for (index, id) in image.id().unwrap().iter().enumerate() {
        let (i, j) = ((index % 90) as f64 + 0.5, (index / 90) as f64 + 0.5);
        let is_in_disk = (i - 45.0).hypot(j - 30.0) <= 30.0;
        assert_eq!(*id != NO_ID, is_in_disk, "{i}, {j}");
        assert_eq!(image.depth().unwrap()[index].is_finite(), is_in_disk);
    }
}

#[test]
fn angles_out_of_range_are_refused() {
    for bad in [0.0, -0.1, 6.3, f64::NAN, f64::INFINITY] {
        let error = FisheyeCamera::new(pose(), bad, 1.0).unwrap_err();
        assert!(matches!(error, CameraError::Range { low: 0.0, high: 360.0, .. }), "{error}");
        assert!(error.to_string().contains("`angle` in degrees"), "{error}");
    }
    assert!(FisheyeCamera::new(pose(), TAU, 1.0).is_ok());
    assert!(FisheyeCamera::new(pose(), FRAC_PI_2, 0.0).is_err());
}
