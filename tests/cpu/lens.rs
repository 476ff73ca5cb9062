//! The thin lens: what is sharp, and how unsharp the rest is.

use glam::{DVec2, DVec3};
use pinhole::camera::{Camera, CameraError, PinholeCamera, Pose, ThinLensCamera};
use pinhole::glam;

/// At the height 1 over the origin, looking along −z.
fn pinhole() -> PinholeCamera {
    let pose = Pose::looking_along([0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
    PinholeCamera::new(pose, 0.5, [0.4, 0.3]).unwrap()
}

fn random_point(random: &mut fastrand::Rng) -> DVec2 {
    DVec2::new(random.f64(), random.f64())
}

/// Where a ray meets the plane across the view at a distance, from the axis.
fn at_distance(camera: &dyn Camera, location: DVec2, lens: DVec2, distance: f64) -> DVec2 {
    let ray = camera.ray_through_lens(location, lens);
    let point = ray.at((-distance - ray.origin.z) / ray.direction.z);
    DVec2::new(point.x, point.y - 1.0)
}

#[test]
fn through_the_centre_goes_the_pinholes_ray() {
    let camera = ThinLensCamera::new(pinhole(), 0.1, 3.0).unwrap();
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..1000 {
        let location = 2.0 * random_point(&mut random) - 1.0;
        let expected = pinhole().ray_in_world(location);
        for ray in
            [camera.ray_in_world(location), camera.ray_through_lens(location, DVec2::splat(0.5))]
        {
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
        widest = widest.max((ray.origin - DVec3::Y).length());
        assert!(ray.origin.z.abs() < 1e-15, "the lens lies across the view");
        assert!((ray.direction.length() - 1.0).abs() < 1e-15);
        let focus = location * DVec2::new(0.4, 0.3) / 0.5 * 3.0;
        assert!((at_distance(&camera, location, lens, 3.0) - focus).length() < 1e-12);
    }
    assert!(widest < 0.1 && widest > 0.098, "{widest}");
}

/// A point at the distance S₂ seen through a lens of diameter A that is focused on S₁: on the sensor of a lens of
/// focal length f its disk has the diameter A |S₂ − S₁|/S₂ · f/(S₁ − f).
#[test]
fn a_circle_of_confusion_is_as_wide_as_the_formula_says() {
    let (focal_length, f_stop, focus) = (0.05, 2.0, 2.0);
    let radius = ThinLensCamera::aperture_radius(focal_length, f_stop).unwrap();
    assert!((radius - 0.0125).abs() < 1e-15);
    // The sensor, 36 by 24 millimetres, lies where the lens makes the picture of the plane of focus.
    let sensor_distance = 1.0 / (1.0 / focal_length - 1.0 / focus);
    let pose = Pose::looking_along([0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
    let half_extent = DVec2::new(0.018, 0.012);
    let film = PinholeCamera::new(pose, sensor_distance, half_extent).unwrap();
    let camera = ThinLensCamera::new(film, radius, focus).unwrap();
    for distance in [0.5, 1.0, 1.9, 2.0, 3.0, 50.0, 1e6] {
        for aside in [DVec2::ZERO, DVec2::new(0.1, -0.07)] {
            let target = aside * distance;
            // The location whose ray through this point of the lens meets the target; all of this is linear.
            let location = |lens: [f64; 2]| {
                let at = |x, y| at_distance(&camera, DVec2::new(x, y), lens.into(), distance);
                let none = at(0.0, 0.0);
                let step = DVec2::new(at(1.0, 0.0).x - none.x, at(0.0, 1.0).y - none.y);
                (target - none) / step
            };
            for [a, b] in [[[0.0, 0.5], [1.0, 0.5]], [[0.5, 0.0], [0.5, 1.0]], [[0.0; 2], [1.0; 2]]]
            {
                let diameter = ((location(a) - location(b)) * half_extent).length();
                let expected = 2.0 * radius * (distance - focus).abs() / distance * focal_length
                    / (focus - focal_length);
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
    let on = ThinLensCamera::focused_on(pinhole(), 0.1, [5.0, -2.0, -3.0]).unwrap();
    assert_eq!(on, ThinLensCamera::new(pinhole(), 0.1, 3.0).unwrap());
    let behind = ThinLensCamera::focused_on(pinhole(), 0.1, [0.0, 0.0, 2.0]).unwrap_err();
    assert!(behind.to_string().contains("`focus_on` along the view is -2.0"), "{behind}");
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
        let parameter = |error| match error {
            CameraError::Length { parameter, .. } => parameter,
            other => panic!("{other}"),
        };
        assert_eq!(
            parameter(ThinLensCamera::new(pinhole(), 0.1, bad).unwrap_err()),
            "`focus_distance`"
        );
        assert_eq!(
            parameter(ThinLensCamera::aperture_radius(bad, 2.0).unwrap_err()),
            "`focal_length`"
        );
        assert_eq!(parameter(ThinLensCamera::aperture_radius(0.05, bad).unwrap_err()), "`f_stop`");
    }
}
