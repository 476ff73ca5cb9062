//! Two eyes: where they see the same, and where not.

use glam::{DVec2, DVec3};
use pinhole::camera::{Camera, CameraError, PanoramaCamera, PinholeCamera, Pose};
use pinhole::glam;

const EYE: DVec3 = DVec3::new(1.0, 2.0, 3.0);

/// Right is x, up is y.
fn pose() -> Pose {
    Pose::looking_along(EYE, [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap()
}

fn pinhole() -> PinholeCamera {
    PinholeCamera::new(pose(), 0.5, [0.4, 0.3]).unwrap()
}

/// By how much a point lies farther to the right for the left eye than for the right one.
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
        let location = DVec2::new(random.f64(), random.f64()) * 2.0 - 1.0;
        let ray = pinhole().ray_in_world(location);
        let at = |depth: f64| ray.at(-depth / ray.direction.z);
        assert!(disparity(&pair, at(2.0)).abs() < 1e-12);
        // By similar triangles: separation · distance/half extent · (1/depth − 1/convergence).
        for depth in [0.5, 1.0, 4.0, 1e6] {
            let expected = 0.06 * 0.5 / 0.4 * (1.0 / depth - 0.5);
            assert!((disparity(&pair, at(depth)) - expected).abs() < 1e-12, "{depth}");
        }
        // Each eye's ray is where its picture has it.
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
        let location = DVec2::new(random.f64(), random.f64()) * 2.0 - 1.0;
        let middle = one.ray_in_world(location);
        let [left, right] = [&pair[0], &pair[1]].map(|camera| camera.ray_in_world(location));
        // In the plane of u and w, across the ray, and the right eye to the right.
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
    let parameter = |error| match error {
        CameraError::Length { parameter, .. } => parameter,
        other => panic!("{other}"),
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let named = "`separation` of the eyes";
        assert_eq!(parameter(pinhole().stereo_pair(bad, 2.0).unwrap_err()), named);
        let panorama = PanoramaCamera::new(pose());
        assert_eq!(parameter(panorama.stereo_pair(bad, 2.0).unwrap_err()), named);
    }
    for bad in [0.0, -1.0, f64::NAN] {
        let named = "`convergence` of the eyes";
        assert_eq!(parameter(pinhole().stereo_pair(0.06, bad).unwrap_err()), named);
        let panorama = PanoramaCamera::new(pose());
        assert_eq!(parameter(panorama.stereo_pair(0.06, bad).unwrap_err()), named);
    }
    let shifted = pinhole().stereo_pair(1e16, 1e-16).unwrap_err();
    assert!(matches!(shifted, CameraError::Range { .. }), "{shifted}");
}
