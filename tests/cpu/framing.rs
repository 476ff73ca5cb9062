//! Cameras that frame spheres by their silhouettes.

use glam::{DVec2, DVec3};
use pinhole::camera::{Camera, CameraKind, OrthographicCamera, PinholeCamera, Pose};
use pinhole::{LinearRgb, Scene, SphereArray, glam};

/// The largest fraction of the picture's half width or half height that a framed scene fills with the default margin.
const FILL: f64 = 0.85;

fn scene(spheres: Vec<[f64; 4]>) -> Scene {
    SphereArray::F64(spheres).scene(LinearRgb::WHITE).unwrap()
}

/// A cloud of spheres that is longest along one axis, and a pose in any direction.
fn cloud(random: &mut fastrand::Rng, count: usize) -> (Scene, Pose) {
    let place = DVec3::from([0; 3].map(|_| random.f64() * 200.0 - 100.0));
    let size = DVec3::from([0; 3].map(|_| 10_f64.powf(random.f64() * 2.0)));
    let sphere = |_| {
        let center = place + size * DVec3::from([0; 3].map(|_| random.f64() - 0.5));
        [center.x, center.y, center.z, 0.05 + 2.0 * random.f64().powi(4)]
    };
    let scene = scene((0..count).map(sphere).collect());
    let direction = DVec3::from([0; 3].map(|_| random.f64() - 0.5));
    (scene, Pose::looking_along(DVec3::ZERO, direction, DVec3::Y).unwrap())
}

/// The smallest and the largest relative location of all spheres' silhouettes. They are computed from angles. The lines
/// through the eye that touch a circle of radius r at the distance l make the angle asin(r/l) with the line to its
/// centre.
fn silhouettes(camera: &dyn Camera, scene: &Scene) -> [DVec2; 2] {
    let v = camera.vectors();
    let ahead = v.forward / v.forward.length();
    let mut extremes = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    for sphere in scene.spheres() {
        let [x, y, z, r] = sphere.map(f64::from);
        let offset = scene.origin() + DVec3::new(x, y, z) - v.origin;
        let side = |axis: DVec3, sign: f64| {
            let aside = offset.dot(axis) / axis.length();
            if camera.kind() == CameraKind::Orthographic {
                return (aside + sign * r) / axis.length();
            }
            let depth = offset.dot(ahead);
            let angle = aside.atan2(depth) + sign * (r / aside.hypot(depth)).asin();
            assert!(angle.abs() < std::f64::consts::FRAC_PI_2, "a sphere is behind the camera");
            angle.tan() * v.forward.length() / axis.length()
        };
        let corner = |sign| DVec2::new(side(v.right, sign), side(v.up, sign));
        extremes = [extremes[0].min(corner(-1.0)), extremes[1].max(corner(1.0))];
    }
    extremes
}

#[test]
fn silhouettes_fill_the_tighter_side_and_lie_in_the_middle() {
    let mut random = fastrand::Rng::with_seed(11);
    for round in 0..200 {
        let (scene, pose) = cloud(&mut random, 1 + round % 40);
        let aspect = [0.3, 0.5625, 0.707, 1.0, 4.0 / 3.0, 16.0 / 9.0, 3.0][round % 7];
        let (fov, margin) = (0.1 + 2.0 * random.f64(), 0.4 * random.f64());
        let pinhole = PinholeCamera::framing(scene.subject(), pose, fov, aspect, margin).unwrap();
        let parallel = OrthographicCamera::framing(scene.subject(), pose, aspect, margin).unwrap();
        for camera in [&pinhole as &dyn Camera, &parallel] {
            let [low, high] = silhouettes(camera, &scene);
            let fill = 1.0 - 2.0 * margin;
            let tighter = high.max_element();
            assert!((tighter - fill).abs() < 1e-6, "{round} {:?}: {tighter}", camera.kind());
            let off_center = (low + high).abs().max_element();
            assert!(off_center < 1e-5, "{round} {:?}: {low} to {high}", camera.kind());
        }
    }
}

#[test]
fn one_sphere_and_spheres_far_from_the_origin_are_framed() {
    for center in [[0.0; 3], [1e7, -2e7, 3e6]] {
        let [x, y, z] = center;
        let scene = scene(vec![[x, y, z, 2.0], [x + 1.0, y, z, 0.25]]);
        let camera = PinholeCamera::framing_from_the_front(scene.subject(), 1.5).unwrap();
        let [low, high] = silhouettes(&camera, &scene);
        assert!((high.y - FILL).abs() < 1e-4 && (low + high).abs().max_element() < 1e-4);
    }
}

#[test]
fn flat_data_is_recognized() {
    let with = |z: f64| scene(vec![[0.0, 0.0, 1.0, 1.0], [5.0, 1.0, 1.0, 0.5], [2.0, 7.0, z, 0.5]]);
    assert_eq!(with(1.0).subject().flat_axis(), Some(2));
    assert_eq!(with(1.5).subject().flat_axis(), None);
    // A row of spheres or a single sphere has no plane of its own.
    assert_eq!(scene(vec![[0.0, 0.0, 0.0, 1.0], [5.0, 0.0, 0.0, 1.0]]).subject().flat_axis(), None);
    assert_eq!(scene(vec![[0.0, 0.0, 0.0, 1.0]]).subject().flat_axis(), None);
}

/// The silhouettes fill the space beside the free parts in one direction, and lie in its middle in the other.
#[test]
fn free_sides_stay_free() {
    let mut random = fastrand::Rng::with_seed(12);
    for round in 0..200 {
        let (scene, pose) = cloud(&mut random, 1 + round % 40);
        let (aspect, fov) = (0.3 + 3.0 * random.f64(), 0.1 + 1.5 * random.f64());
        let sides = [(); 4].map(|()| (0.9 * random.f64() - 0.45).max(0.0));
        let subject = scene.subject().with_free_sides(sides);
        let cameras: [Box<dyn Camera>; 2] = [
            Box::new(PinholeCamera::framing(subject, pose, fov, aspect, 0.05).unwrap()),
            Box::new(OrthographicCamera::framing(subject, pose, aspect, 0.05).unwrap()),
        ];
        let [left, right, low, high] = sides.map(|side| 2.0 * side.max(0.05));
        let [start, end] = [DVec2::new(left, low) - 1.0, 1.0 - DVec2::new(right, high)];
        for camera in cameras {
            let [lowest, highest] = silhouettes(camera.as_ref(), &scene);
            let free = [lowest - start, end - highest];
            let least = free[0].min(free[1]);
            assert!(least.min_element().abs() < 1e-4, "{sides:?}: {lowest} {highest}");
            let uneven = (free[0] - free[1]).abs().max_element();
            assert!(uneven < 1e-3, "{sides:?}: {lowest} {highest}");
        }
    }
}
