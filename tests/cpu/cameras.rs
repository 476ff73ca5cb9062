//! The thin lens, panorama and fisheye, and two eyes: known rays, and the way back from points to locations.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use pinhole::camera::{
    Camera, CameraError, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera,
};
use pinhole::glam::{DVec2, DVec3};

const EYE: DVec3 = DVec3::new(1.0, 2.0, 3.0);

/// A pose with x to the right and y up.
fn pose() -> Pose {
    Pose::looking_along(EYE, [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap()
}

fn pinhole() -> PinholeCamera {
    PinholeCamera::new(pose(), 0.5, [0.4, 0.3]).unwrap()
}

fn random_point(random: &mut fastrand::Rng) -> DVec2 {
    DVec2::new(random.f64(), random.f64())
}

/// The point where a ray hits the plane across the view at a distance, relative to the axis.
fn at_distance(camera: &dyn Camera, location: DVec2, lens: DVec2, distance: f64) -> DVec2 {
    let ray = camera.ray_through_lens(location, lens);
    let point = ray.at((EYE.z - distance - ray.origin.z) / ray.direction.z) - EYE;
    DVec2::new(point.x, point.y)
}

#[test]
fn through_the_centre_goes_the_pinholes_ray() {
    let camera = ThinLensCamera::new(pinhole(), 0.1, 3.0).unwrap();
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..1000 {
        let location = 2.0 * random_point(&mut random) - 1.0;
        let expected = pinhole().ray_in_world(location);
        for ray in [camera.ray_in_world(location), camera.ray_through_lens(location, DVec2::splat(0.5))] {
            assert!((ray.origin - expected.origin).length() < 1e-15);
            assert!((ray.direction - expected.direction).length() < 1e-15);
        }
        let point = expected.at(7.0);
        assert!((camera.location_of(point).unwrap() - location).length() < 1e-12);
    }
    assert!(camera.has_lens() && !pinhole().has_lens());
}

#[test]
fn all_rays_of_a_location_meet_in_the_plane_of_focus() {
    let camera = ThinLensCamera::new(pinhole(), 0.1, 3.0).unwrap();
    let mut random = fastrand::Rng::with_seed(2);
    let mut widest = 0.0_f64;
    for _ in 0..1000 {
        let location = 2.0 * random_point(&mut random) - 1.0;
        let lens = random_point(&mut random);
        let ray = camera.ray_through_lens(location, lens);
        widest = widest.max((ray.origin - EYE).length());
        assert!((ray.origin.z - EYE.z).abs() < 1e-15, "the lens lies across the view");
        assert!((ray.direction.length() - 1.0).abs() < 1e-15);
        let focus = location * DVec2::new(0.4, 0.3) / 0.5 * 3.0;
        assert!((at_distance(&camera, location, lens, 3.0) - focus).length() < 1e-12);
    }
    assert!(widest < 0.1 && widest > 0.098, "{widest}");
}

/// A point at the distance S₂, seen through a lens of diameter A that is focused on S₁. On the sensor of a lens of
/// focal length f, its disk has the diameter A |S₂ − S₁|/S₂ · f/(S₁ − f).
#[test]
fn a_circle_of_confusion_is_as_wide_as_the_formula_says() {
    let (focal_length, f_stop, focus) = (0.05, 2.0, 2.0);
    let radius = ThinLensCamera::aperture_radius(focal_length, f_stop).unwrap();
    assert!((radius - 0.0125).abs() < 1e-15);
    // The sensor, 36 by 24 millimetres, lies where the lens images the plane of focus.
    let sensor_distance = 1.0 / (1.0 / focal_length - 1.0 / focus);
    let half_extent = DVec2::new(0.018, 0.012);
    let film = PinholeCamera::new(pose(), sensor_distance, half_extent).unwrap();
    let camera = ThinLensCamera::new(film, radius, focus).unwrap();
    for distance in [0.5, 1.0, 1.9, 2.0, 3.0, 50.0, 1e6] {
        for aside in [DVec2::ZERO, DVec2::new(0.1, -0.07)] {
            let target = aside * distance;
            // The location whose ray through this point of the lens hits the target. All of this is linear.
            let location = |lens: [f64; 2]| {
                let at = |x, y| at_distance(&camera, DVec2::new(x, y), lens.into(), distance);
                let none = at(0.0, 0.0);
                let step = DVec2::new(at(1.0, 0.0).x - none.x, at(0.0, 1.0).y - none.y);
                (target - none) / step
            };
            for [a, b] in [[[0.0, 0.5], [1.0, 0.5]], [[0.5, 0.0], [0.5, 1.0]], [[0.0; 2], [1.0; 2]]] {
                let diameter = ((location(a) - location(b)) * half_extent).length();
                let expected =
                    2.0 * radius * (distance - focus).abs() / distance * focal_length / (focus - focal_length);
                assert!(
                    (diameter - expected).abs() < 1e-9 * (1e-3 + expected),
                    "{distance}: {diameter} is not {expected}"
                );
            }
        }
    }
}

#[test]
fn the_plane_of_focus_goes_through_a_point() {
    let on = ThinLensCamera::focused_on(pinhole(), 0.1, EYE + DVec3::new(4.0, -4.0, -3.0)).unwrap();
    assert_eq!(on, ThinLensCamera::new(pinhole(), 0.1, 3.0).unwrap());
    let behind = ThinLensCamera::focused_on(pinhole(), 0.1, EYE + 2.0 * DVec3::Z).unwrap_err();
    assert!(behind.to_string().contains("`focus_on` along the view is -2.0"), "{behind}");
}

/// The name of the length that an error refuses.
fn length(error: &CameraError) -> &'static str {
    match error {
        CameraError::Length { parameter, .. } => parameter,
        other => panic!("{other}"),
    }
}

#[test]
fn what_is_no_lens_is_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 3.1] {
        match ThinLensCamera::new(pinhole(), bad, 3.0).unwrap_err() {
            CameraError::Range { parameter: "`aperture_radius`", high, .. } => {
                assert_eq!(high, 3.0);
            }
            other => panic!("{other}"),
        }
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for (error, parameter) in [
            (ThinLensCamera::new(pinhole(), 0.1, bad).unwrap_err(), "`focus_distance`"),
            (ThinLensCamera::aperture_radius(bad, 2.0).unwrap_err(), "`focal_length`"),
            (ThinLensCamera::aperture_radius(0.05, bad).unwrap_err(), "`f_stop`"),
        ] {
            assert_eq!(length(&error), parameter, "{bad}");
        }
    }
}

#[track_caller]
fn points(camera: &dyn Camera, location: [f64; 2], direction: [f64; 3]) {
    let ray = camera.ray_in_world(location.into());
    assert_eq!(ray.origin, EYE);
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
    let cameras: [&dyn Camera; 7] = [
        &PinholeCamera::new(pose, 1.0, [1.0, 1.0]).unwrap(),
        &OrthographicCamera::new(pose, [5.0, 5.0]).unwrap(),
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
            let location = (2.0 * random_point(&mut random) - 1.0) * 0.999;
            let ray = camera.ray_in_world(location);
            assert!((ray.direction.length() - 1.0).abs() < 1e-15);
            if camera.sees(location) {
                let back = camera.location_of(ray.at(random.f64() * 100.0 + 0.1)).unwrap();
                let is_plane = ["pinhole", "orthographic"].contains(&camera.kind().name());
                let most = if is_plane { 1e-12 } else { 1e-9 };
                assert!((back - location).length() < most, "{camera:?}: {back} is not {location}");
                seen += 1;
            }
        }
        assert!(seen > 500, "{camera:?}");
    }
    assert!(cameras[2..].iter().all(|camera| camera.location_of(EYE).is_none()));
    let narrow = FisheyeCamera::new(pose, 1.0, 1.0).unwrap();
    let behind = EYE - DVec3::new(0.3, -0.4, 0.8);
    assert_eq!(narrow.location_of(behind), None);
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

/// The distance by which a point lies farther to the right for the left eye than for the right one.
fn disparity([left, right]: &[impl Camera; 2], point: DVec3) -> f64 {
    let [a, b] = [left, right].map(|camera| camera.location_of(point).unwrap());
    assert!((a.y - b.y).abs() < 1e-12, "eyes side by side see nothing higher or lower");
    a.x - b.x
}

#[test]
fn pinholes_see_the_same_in_the_plane_of_convergence() {
    let pair = pinhole().stereo_pair(0.06, 2.0).unwrap();
    let origins = pair.map(|camera| camera.ray_in_world(DVec2::ZERO).origin - EYE);
    assert!((origins[0] + 0.03 * DVec3::X).length() < 1e-15);
    assert!((origins[1] - 0.03 * DVec3::X).length() < 1e-15);
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..1000 {
        let location = 2.0 * random_point(&mut random) - 1.0;
        let ray = pinhole().ray_in_world(location);
        let at = |depth: f64| ray.at(-depth / ray.direction.z);
        assert!(disparity(&pair, at(2.0)).abs() < 1e-12);
        // By similar triangles: separation · distance/half extent · (1/depth − 1/convergence).
        for depth in [0.5, 1.0, 4.0, 1e6] {
            let expected = 0.06 * 0.5 / 0.4 * (1.0 / depth - 0.5);
            assert!((disparity(&pair, at(depth)) - expected).abs() < 1e-12, "{depth}");
        }
        // The ray of each eye leads back to its location in that eye's picture.
        for camera in &pair {
            let back = camera.location_of(camera.ray_in_world(location).at(5.0)).unwrap();
            assert!((back - location).length() < 1e-12);
            let (ray, v) = (camera.ray_in_world(location), camera.vectors());
            let toward = location.x * v.right + location.y * v.up + v.forward;
            assert!((ray.direction - toward / toward.length()).length() < 1e-15);
        }
    }
    let parallel = pinhole().stereo_pair(0.06, f64::INFINITY).unwrap();
    let ray = parallel.map(|camera| camera.ray_in_world(DVec2::new(0.3, 0.2)).direction);
    assert_eq!(ray[0], ray[1]);
}

#[test]
fn panoramas_meet_at_the_distance_of_convergence() {
    let one = PanoramaCamera::new(pose());
    let pair = one.stereo_pair(0.06, 2.0).unwrap();
    let apart = one.stereo_pair(0.06, f64::INFINITY).unwrap();
    let mut random = fastrand::Rng::with_seed(2);
    for _ in 0..1000 {
        let location = 2.0 * random_point(&mut random) - 1.0;
        let middle = one.ray_in_world(location);
        let [left, right] = [&pair[0], &pair[1]].map(|camera| camera.ray_in_world(location));
        // In the plane of u and w, across the ray, with the right eye to the right.
        let aside = right.origin - left.origin;
        assert!((aside.length() - 0.06).abs() < 1e-14 && aside.y.abs() < 1e-15);
        assert!(aside.dot(middle.direction).abs() < 1e-15);
        assert!(middle.direction.cross(DVec3::Y).dot(aside) > 0.0);
        let meeting = middle.at(2.0);
        for ray in [left, right] {
            assert!((ray.direction.length() - 1.0).abs() < 1e-15);
            let toward = meeting - ray.origin;
            assert!((ray.direction - toward / toward.length()).length() < 1e-14);
        }
        for camera in &apart {
            let ray = camera.ray_in_world(location);
            assert!((ray.direction - middle.direction).length() < 1e-15);
        }
    }
    assert_eq!(pair[0].location_of(EYE + DVec3::X), None);
}

#[test]
fn no_distance_between_eyes_is_refused() {
    let panorama = PanoramaCamera::new(pose());
    for (separation, convergence, parameter) in [
        (0.0, 2.0, "separation"),
        (-1.0, 2.0, "separation"),
        (f64::NAN, 2.0, "separation"),
        (f64::INFINITY, 2.0, "separation"),
        (0.06, 0.0, "convergence"),
        (0.06, -1.0, "convergence"),
        (0.06, f64::NAN, "convergence"),
    ] {
        let named = format!("`{parameter}` of the eyes");
        let [a, b] = [
            pinhole().stereo_pair(separation, convergence).unwrap_err(),
            panorama.stereo_pair(separation, convergence).unwrap_err(),
        ];
        assert_eq!([length(&a), length(&b)], [&*named; 2], "{separation} {convergence}");
    }
    let shifted = pinhole().stereo_pair(1e16, 1e-16).unwrap_err();
    assert!(matches!(shifted, CameraError::Range { .. }), "{shifted}");
}
