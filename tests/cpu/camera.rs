//! Pinhole and orthographic cameras: their rays, constructors and errors.

use pinhole::Film;
use pinhole::camera::film::YAxis;
use pinhole::camera::{Camera, CameraError, OrthographicCamera, PinholeCamera, Pose};
use pinhole::geometry::basis::OrthonormalBasis;
use pinhole::geometry::bounds::Bounds;
use pinhole::glam::{DVec2, DVec3};

const UP: DVec3 = DVec3::Y;

fn assert_near(a: DVec3, b: DVec3, context: &str) {
    assert!((a - b).length() < 1e-12 * (1.0 + b.length()), "{a} is not {b}: {context}");
}

fn random_point(random: &mut fastrand::Rng, size: f64) -> DVec3 {
    DVec3::from([0; 3].map(|_| (random.f64() * 2.0 - 1.0) * size))
}

#[test]
fn rays_on_paper() {
    let pose = Pose::looking_at([1.0, 2.0, 10.0], [1.0, 2.0, 0.0], UP).unwrap();
    let pinhole = PinholeCamera::new(pose, 2.0, [4.0, 3.0]).unwrap();
    let orthographic = OrthographicCamera::new(pose, [4.0, 3.0]).unwrap();
    for (x, y) in [(0.0, 0.0), (1.0, 1.0), (-1.0, 0.5), (0.25, -1.0)] {
        let location = DVec2::new(x, y);
        let ray = pinhole.ray_in_world(location);
        assert_near(ray.origin, DVec3::new(1.0, 2.0, 10.0), "eye");
        let toward = DVec3::new(4.0 * x, 3.0 * y, -2.0);
        assert_near(ray.direction, toward / toward.length(), "direction");

        let ray = orthographic.ray_in_world(location);
        assert_near(ray.origin, DVec3::new(1.0 + 4.0 * x, 2.0 + 3.0 * y, 10.0), "origin");
        assert_near(ray.direction, DVec3::NEG_Z, "direction");
    }
}

/// The vectors for kernels agree with the rays of the reference.
#[test]
fn vectors_and_rays_agree() {
    let mut random = fastrand::Rng::with_seed(3);
    for _ in 0..1000 {
        let eye = random_point(&mut random, 100.0);
        let pose = Pose::looking_at(eye, random_point(&mut random, 10.0), random_point(&mut random, 1.0));
        let pose = pose.unwrap();
        let half_extent = DVec2::new(random.f64() + 0.01, random.f64() + 0.01);
        let distance = random.f64() * 5.0 + 0.01;
        let location = DVec2::new(random.f64(), random.f64()) * 2.0 - 1.0;

        let camera = PinholeCamera::new(pose, distance, half_extent).unwrap();
        let (ray, v) = (camera.ray_in_world(location), camera.vectors());
        let toward = location.x * v.right + location.y * v.up + v.forward;
        assert_eq!(ray.origin, v.origin);
        assert_near(ray.direction, toward / toward.length(), "pinhole");
        assert!((ray.direction.length() - 1.0).abs() < 1e-15);

        let camera = OrthographicCamera::new(pose, half_extent).unwrap();
        let (ray, v) = (camera.ray_in_world(location), camera.vectors());
        assert_near(ray.origin, v.origin + location.x * v.right + location.y * v.up, "orthographic");
        assert_near(ray.direction, v.forward, "orthographic");
    }
}

#[test]
fn roll_turns_the_picture_about_its_middle() {
    let camera = |roll: f64| {
        let up = DVec3::new(-roll.sin(), roll.cos(), 0.0);
        let pose = Pose::looking_at([0.0, 0.0, 5.0], [0.0; 3], up).unwrap();
        PinholeCamera::new(pose, 1.0, [1.0, 1.0]).unwrap()
    };
    for degrees in [0.0, 30.0, 90.0, 180.0, 271.0_f64] {
        let roll = degrees.to_radians();
        let upright = camera(0.0).ray_in_world(DVec2::from_angle(roll).rotate(DVec2::new(0.3, 0.2)));
        let rolled = camera(roll).ray_in_world(DVec2::new(0.3, 0.2));
        assert_near(rolled.direction, upright.direction, "roll");
    }
}

#[test]
fn a_field_of_view_spans_its_angle() {
    let pose = Pose::looking_at([0.0; 3], [0.0, 0.0, -1.0], UP).unwrap();
    for degrees in [1.0, 45.0, 120.0, 179.0_f64] {
        let camera = PinholeCamera::with_vertical_fov(pose, degrees.to_radians(), 1.6).unwrap();
        let ray = |x, y| camera.ray_in_world(DVec2::new(x, y)).direction;
        let vertical = ray(0.0, 1.0).angle_between(ray(0.0, -1.0)).to_degrees();
        assert!((vertical - degrees).abs() < 1e-6, "{vertical} is not {degrees}");
        let [half_width, half_height] =
            [ray(1.0, 0.0), ray(0.0, 1.0)].map(|d| (d.length_squared() - d.z * d.z).sqrt() / -d.z);
        assert!((half_width / half_height - 1.6).abs() < 1e-9);
    }
}

#[test]
fn a_framed_box_is_seen_whole_and_fills_the_picture() {
    let mut random = fastrand::Rng::with_seed(5);
    for _ in 0..500 {
        let center = random_point(&mut random, 1e3);
        let half = DVec3::from([0; 3].map(|_| 10_f64.powf(random.f64() * 6.0 - 3.0)));
        let bounds = Bounds::of_sphere(center - half, 1e-9).union(Bounds::of_sphere(center + half, 1e-9));
        let pose = Pose::looking_along(DVec3::ZERO, random_point(&mut random, 1.0), UP).unwrap();
        let aspect = 0.3 + random.f64() * 3.0;
        let fov = random.f64() * 2.0 + 0.1;
        let cameras: [Box<dyn Camera>; 2] = [
            Box::new(PinholeCamera::framing(bounds, pose, fov, aspect, 0.025).unwrap()),
            Box::new(OrthographicCamera::framing(bounds, pose, aspect, 0.025).unwrap()),
        ];
        for camera in &cameras {
            let largest = bounds
                .corners()
                .map(|corner| {
                    let location = camera.location_of(corner).expect("a corner is behind");
                    location.abs().max_element()
                })
                .into_iter()
                .fold(0.0, f64::max);
            assert!(largest < 0.951, "{:?}: a corner lies at {largest}", camera.kind());
            assert!(largest > 0.949, "{:?}: the box reaches only to {largest}", camera.kind());
        }
    }
}

#[test]
fn both_directions_of_y() {
    let film = Film::new(4, 2).unwrap();
    // Centre of the upper left pixel.
    assert_eq!(film.relative_location(0.5, 0.5), DVec2::new(-0.75, 0.5));
    let down = film.with_y_axis(YAxis::Down);
    assert_eq!(down.relative_location(0.5, 0.5), DVec2::new(-0.75, -0.5));
    assert_eq!(down.relative_location(2.0, 1.0), DVec2::ZERO);
}

#[test]
fn sizes_without_pixels_or_beyond_f32_are_refused() {
    for (width, height) in [(0, 5), (5, 0), (0, 0), (Film::MAX_SIDE + 1, 1)] {
        assert!(Film::new(width, height).is_err(), "{width}x{height}");
    }
    assert!(Film::new(Film::MAX_SIDE, 1).is_ok());
}

#[test]
fn degenerate_poses_are_errors_that_say_which() {
    let eye = DVec3::new(1.0, 2.0, 3.0);
    let target = DVec3::ZERO;
    let at = |eye: DVec3, look_at: DVec3, up: DVec3| Pose::looking_at(eye, look_at, up).unwrap_err();
    let same = "the eye and the look-at point are both at [1.0, 2.0, 3.0]; move one of them";
    assert_eq!(at(eye, eye, UP).to_string(), same);
    assert_eq!(at(eye, target, eye), CameraError::UpParallelToView { up: eye });
    assert_eq!(at(eye, target, -2.0 * eye), CameraError::UpParallelToView { up: -2.0 * eye });
    let zero = "is the zero vector, which has no direction";
    assert_eq!(at(eye, target, DVec3::ZERO).to_string(), format!("up {zero}"));
    let along = Pose::looking_along(eye, DVec3::ZERO, UP).unwrap_err();
    assert_eq!(along.to_string(), format!("the direction {zero}"));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let spoilt = |mut v: DVec3| {
                v[axis] = bad;
                v
            };
            let along = Pose::looking_along(eye, spoilt(UP), eye).unwrap_err();
            for (error, parameter, value) in [
                (at(spoilt(eye), target, UP), "the eye", spoilt(eye)),
                (at(eye, spoilt(target), UP), "the look-at point", spoilt(target)),
                (at(eye, target, spoilt(UP)), "up", spoilt(UP)),
                (along, "the direction", spoilt(UP)),
            ] {
                assert_eq!(error.to_string(), out_of_range(parameter, value));
            }
        }
    }
    let too_far = DVec3::new(1e30, 0.0, 0.0);
    assert_eq!(at(too_far, target, UP).to_string(), out_of_range("the eye", too_far));
}

fn out_of_range(parameter: &str, value: DVec3) -> String {
    let range = "every component must be finite and at most 7.205759403792794e16 in size";
    format!("{parameter} is {:?}; {range}", value.to_array())
}

#[test]
fn degenerate_lengths_and_angles_are_errors() {
    let pose = Pose::looking_at([0.0, 0.0, 1.0], [0.0; 3], UP).unwrap();
    let bounds = Bounds::of_sphere(DVec3::ZERO, 1.0);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-30, 1e30] {
        let is_length_error = |error| matches!(error, CameraError::Length { .. });
        assert!(is_length_error(PinholeCamera::new(pose, bad, [1.0, 1.0]).unwrap_err()));
        assert!(is_length_error(PinholeCamera::new(pose, 1.0, [bad, 1.0]).unwrap_err()));
        assert!(is_length_error(PinholeCamera::new(pose, 1.0, [1.0, bad]).unwrap_err()));
        assert!(is_length_error(OrthographicCamera::new(pose, [1.0, bad]).unwrap_err()));
        assert!(is_length_error(PinholeCamera::with_vertical_fov(pose, 1.0, bad).unwrap_err()));
        assert!(is_length_error(OrthographicCamera::framing(bounds, pose, bad, 0.1).unwrap_err()));
    }
    for bad in [0.0, -0.1, std::f64::consts::PI, 4.0, f64::NAN, f64::INFINITY] {
        let error = PinholeCamera::with_vertical_fov(pose, bad, 1.0).unwrap_err().to_string();
        assert!(error.starts_with("the vertical field of view is"), "{error}");
    }
}

/// A vector of random direction, and of a length between 10⁻¹⁰⁰ and 10¹⁰⁰.
fn random_vector(random: &mut fastrand::Rng) -> DVec3 {
    let direction = DVec3::from([0; 3].map(|_| random.f64() * 2.0 - 1.0));
    direction * 10_f64.powf(random.f64() * 200.0 - 100.0)
}

fn assert_orthonormal(basis: &OrthonormalBasis, context: &str) {
    let (u, v, w) = (basis.u(), basis.v(), basis.w());
    for (name, value, expected) in [
        ("|u|", u.length(), 1.0),
        ("|v|", v.length(), 1.0),
        ("|w|", w.length(), 1.0),
        ("u·v", u.dot(v), 0.0),
        ("u·w", u.dot(w), 0.0),
        ("v·w", v.dot(w), 0.0),
        ("|u × v − w|", (u.cross(v) - w).length(), 0.0),
    ] {
        assert!((value - expected).abs() < 1e-14, "{name} = {value} for {context}");
    }
}

#[test]
fn any_two_vectors_make_a_right_handed_basis() {
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..100_000 {
        let (a, b) = (random_vector(&mut random), random_vector(&mut random));
        let basis = OrthonormalBasis::from_vectors(a, b).unwrap();
        assert_orthonormal(&basis, &format!("{a} and {b}"));
        // w lies along a, and b is in the half plane of v.
        assert!(basis.w().dot(a) > 0.0 && basis.v().dot(b) > 0.0, "{a} and {b}");
    }
}

#[test]
fn nearly_parallel_vectors_make_a_basis_or_none() {
    let mut random = fastrand::Rng::with_seed(2);
    for _ in 0..10_000 {
        let (a, c) = (random_vector(&mut random), random_vector(&mut random));
        let across = OrthonormalBasis::from_vectors(a, c).unwrap().u();
        let tilt = 10_f64.powf(-random.f64() * 20.0);
        let b = a + across * a.length() * tilt;
        match OrthonormalBasis::from_vectors(a, b) {
            Some(basis) => assert_orthonormal(&basis, &format!("tilt {tilt:e}")),
            None => assert!(tilt < 1e-8, "tilt {tilt:e}"),
        }
    }
}

#[test]
fn degenerate_vectors_make_no_basis() {
    let good = DVec3::new(1.0, 2.0, 3.0);
    let none = |a: DVec3, b: DVec3| assert_eq!(OrthonormalBasis::from_vectors(a, b), None);
    none(DVec3::ZERO, good);
    none(good, DVec3::ZERO);
    for factor in [1.0, -1.0, 1e-300, -1e300] {
        none(good, good * factor);
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut vector = good;
            vector[axis] = bad;
            none(vector, good);
            none(good, vector);
        }
    }
}
