//! Cameras from the matrices of host programs.

use glam::{DMat4, DVec2, DVec3, DVec4};
use pinhole::camera::{Camera, CameraKind, DepthOrder, HostCamera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::glam;

use crate::support::hosts::{Convention, changes, from_rows, view};

fn in_cube(random: &mut fastrand::Rng) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| 2.0 * random.f64() - 1.0))
}

fn random_pose(random: &mut fastrand::Rng) -> Pose {
    Pose::looking_along(10.0 * in_cube(random), in_cube(random), in_cube(random)).unwrap()
}

/// Random matrices of a host with a convention for depth.
fn random_host(random: &mut fastrand::Rng, convention: Convention) -> (DMat4, DMat4) {
    let into = if random.bool() { 1.0 } else { -1.0 };
    let half = DVec2::new(0.2 + random.f64(), 0.2 + random.f64());
    let middle = DVec2::new(random.f64() - 0.5, random.f64() - 0.5);
    let (low, high) = (middle - half, middle + half);
    let near = 0.01 + random.f64();
    let range = [near, near + 1.0 + 100.0 * random.f64()];
    let mut projection = convention.projection([low.x, high.x, low.y, high.y], range, into);
    let mut view = view(&random_pose(random), into);
    match random.u8(0..7) {
        change @ 0..3 => {
            let turn = glam::DQuat::from_rotation_y(0.7);
            let place = DMat4::from_rotation_translation(turn, DVec3::new(1.0, -2.0, 0.5));
            view *= place * changes()[usize::from(change) + 1];
        }
        // A screen turned by a quarter.
        3 => projection = DMat4::from_rotation_z(std::f64::consts::FRAC_PI_2) * projection,
        // An oblique near plane.
        4 => {
            let [x, y, z, w] = [0, 1, 2, 3].map(|row| projection.row(row));
            projection = from_rows([x, y, z + DVec4::new(0.01, 0.02, 0.0, 0.0), w]);
        }
        _ => {}
    }
    (view, projection)
}

/// Every point of a ray has the clip coordinates of the ray's location on the film, and the matrices' depth.
#[test]
fn points_of_rays_are_projected_to_where_the_rays_are() {
    let mut random = fastrand::Rng::with_seed(3);
    for case in 0..6000 {
        let convention = Convention::ALL[case % 6];
        let (view, projection) = random_host(&mut random, convention);
        let camera = HostCamera::new(view, projection, convention.order()).unwrap();
        let all = projection * view;
        for _ in 0..4 {
            let location = DVec2::new(random.f64(), random.f64()) * 2.4 - 1.2;
            let ray = camera.ray_in_world(location);
            assert!((ray.direction.length() - 1.0).abs() < 1e-12);
            let distance = 10_f64.powf(random.f64() * 4.0 - 2.0);
            let clip = all * ray.at(distance).extend(1.0);
            assert!(clip.w > 0.0, "{case}: in front of the camera");
            let found = clip.truncate() / clip.w;
            let scale = 1.0 + 1.0 / clip.w;
            assert!((found.truncate() - location).length() < 1e-11 * scale, "{case}: {found}");
            let depth = camera.clip_depth(location, distance);
            assert!((found.z - depth).abs() < 1e-11 * scale, "{case}: {depth} {found}");
            // Farther points have depths farther from the near plane.
            let farther = camera.clip_depth(location, 1.1 * distance);
            let is_order = (farther > depth) == (camera.depth_order() == DepthOrder::NearIsZero);
            assert!(is_order, "{case}");
            let back = camera.distance_of(location, depth);
            let steepness = (farther - depth).abs() / (0.1 * distance);
            assert!((back - distance).abs() < 1e-13 / steepness + 1e-9 * distance, "{case}");
            let back = camera.location_of(ray.at(distance)).unwrap();
            assert!((back - location).length() < 1e-11 * scale, "{case}");
        }
        if !convention.is_orthographic() {
            assert_eq!(camera.location_of(camera.ray_in_world(DVec2::ZERO).at(-1.0)), None);
        }
    }
}

/// Matrices of our own cameras reproduce the cameras' vectors, up to rounding in f64.
#[test]
fn our_own_cameras_come_back() {
    let mut random = fastrand::Rng::with_seed(4);
    for case in 0..2000 {
        let pose = random_pose(&mut random);
        let half = DVec2::new(0.1 + random.f64(), 0.1 + random.f64());
        let edges = [-half.x, half.x, -half.y, half.y];
        let convention = Convention::ALL[case % 6];
        let own: Box<dyn Camera> = if convention.is_orthographic() {
            Box::new(OrthographicCamera::new(pose, half).unwrap())
        } else {
            Box::new(PinholeCamera::new(pose, 1.0, half).unwrap())
        };
        // Our orthographic camera starts at its origin, which is the position of the near plane here.
        let near = if convention.is_orthographic() { 0.0 } else { 0.1 };
        for into in [1.0, -1.0] {
            let projection = convention.projection(edges, [near, 50.0], into);
            let host = HostCamera::new(view(&pose, into), projection, convention.order()).unwrap();
            let (a, b) = (own.vectors(), host.vectors());
            assert_eq!(own.kind(), host.kind());
            for (a, b) in [(a.origin, b.origin), (a.right, b.right), (a.up, b.up), (a.forward, b.forward)] {
                assert!((a - b).length() < 1e-14, "{case}: {a} {b}");
            }
        }
    }
}

/// The left edge of the view plane at distance 1 is 0.5 to the left, and the right edge 1.5 to the right. So the middle
/// is 0.5 to the right, as for one eye of a stereo pair.
#[test]
fn a_shifted_frustum_on_paper() {
    let edges = [-0.5, 1.5, -0.25, 0.75];
    let projection = Convention::Perspective.projection(edges, [0.1, 10.0], -1.0);
    let camera = HostCamera::new(DMat4::IDENTITY, projection, DepthOrder::NearIsZero).unwrap();
    let vectors = camera.vectors();
    assert_eq!(camera.kind(), CameraKind::Pinhole);
    assert!((vectors.forward - DVec3::new(0.5, 0.25, -1.0)).length() < 1e-15);
    assert!((vectors.right - DVec3::X).length() < 1e-15);
    assert!((vectors.up - 0.5 * DVec3::Y).length() < 1e-15);
    assert_eq!(vectors.origin, DVec3::ZERO);
}

/// Matrices in f32 may be given as arrays of columns and as sixteen numbers.
#[test]
fn arrays_in_f32() {
    let mut random = fastrand::Rng::with_seed(5);
    let (view, projection) = random_host(&mut random, Convention::Reversed);
    let (view, projection) = (view.as_mat4(), projection.as_mat4());
    let order = DepthOrder::NearIsOne;
    let a = HostCamera::new(view, projection, order).unwrap();
    let b = HostCamera::new(view.to_cols_array_2d(), projection.to_cols_array_2d(), order).unwrap();
    let c = HostCamera::new(view.to_cols_array(), projection.to_cols_array(), order).unwrap();
    let d = HostCamera::new(view.as_dmat4().to_cols_array_2d(), projection.as_dmat4().to_cols_array(), order);
    assert_eq!((a, a, Ok(a)), (b, c, d));
}

#[test]
fn what_is_no_camera_is_refused() {
    let order = DepthOrder::NearIsZero;
    let pose = Pose::looking_along([1.0, 2.0, 3.0], [0.3, -0.2, -1.0], [0.0, 1.0, 0.0]).unwrap();
    let view = view(&pose, -1.0);
    let edges = [-1.0, 1.0, -1.0, 1.0];
    let good = Convention::Perspective.projection(edges, [0.1, 10.0], -1.0);
    HostCamera::new(view, good, order).unwrap();
    let (mut nan, mut infinite) = (good, view);
    (nan.y_axis.x, infinite.w_axis.x) = (f64::NAN, f64::INFINITY);
    let flat = DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0));
    let nearly =
        DMat4::from_cols(DVec4::new(1.0, 1.0, 0.0, 0.0), DVec4::new(1.0, 1.0001, 0.0, 0.0), DVec4::Z, DVec4::W);
    let [x, y, _, w] = [0, 1, 2, 3].map(|row| good.row(row));
    for (view, projection, expected) in [
        (view, nan, "the projection matrix contains a number that is not finite"),
        (infinite, good, "the view matrix contains a number that is not finite"),
        // Matrices given row by row, and the two exchanged.
        (view.transpose(), good, "the last row of the view matrix is"),
        (view, good.transpose(), "the last row of the projection matrix is"),
        (good, view, "the last row of the view matrix is"),
        // Perspective along x instead of z.
        (view, good * DMat4::from_rotation_y(0.5), "the last row of the projection matrix is"),
        (view * flat, good, "the view matrix has no inverse"),
        (view, flat * good, "the projection matrix has no inverse"),
        (view * nearly, good, "lie nearly in one plane"),
        // Depth that runs in the other direction, or does not depend on the distance.
        (
            view,
            Convention::Reversed.projection(edges, [0.1, 10.0], -1.0),
            "NearIsZero was given, but the projection matrix maps the near plane to",
        ),
        (view, from_rows([x, y, 0.5 * w, w]), "the third row of the projection matrix is"),
        // A view plane that is too small, and an eye that is too far away.
        (view, DMat4::from_scale(DVec3::new(1e20, 1e20, 1.0)) * good, "the length of right is"),
        (view * DMat4::from_translation(DVec3::splat(1e18)), good, "the origin is"),
    ] {
        let error = HostCamera::new(view, projection, order).unwrap_err().to_string();
        assert!(error.contains(expected), "{error} is not {expected}");
    }
}

/// A reversed orthographic projection looks the same as that of a camera at the other end, so the order decides.
#[test]
fn the_order_says_from_which_end_an_orthographic_camera_looks() {
    let projection = Convention::Orthographic.projection([-1.0, 1.0, -1.0, 1.0], [2.0, 10.0], -1.0);
    let camera = |order| HostCamera::new(DMat4::IDENTITY, projection, order).unwrap();
    let ray = camera(DepthOrder::NearIsZero).ray_in_world(DVec2::new(0.5, 0.25));
    assert!((ray.origin - DVec3::new(0.5, 0.25, -2.0)).length() < 1e-12);
    assert!((ray.direction - DVec3::NEG_Z).length() < 1e-12);
    let ray = camera(DepthOrder::NearIsOne).ray_in_world(DVec2::new(0.5, 0.25));
    assert!((ray.origin - DVec3::new(0.5, 0.25, -10.0)).length() < 1e-12);
    assert!((ray.direction - DVec3::Z).length() < 1e-12);
}
