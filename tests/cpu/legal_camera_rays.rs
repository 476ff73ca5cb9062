//! What the checker says of rays holds the exact ray, and whatever a device may come to: for all cameras, locations
//! and points of the lens.

use std::f64::consts::TAU;

use glam::{DMat3, DMat4, DVec2, DVec3};
use pinhole::camera::{
    Camera, DepthOrder, FisheyeCamera, HostCamera, OrthographicCamera, PanoramaCamera,
    PinholeCamera, Pose, ThinLensCamera,
};
use pinhole::glam;
use pinhole::verify::{Interval, LegalCameraRay, UploadedView};

use crate::legal_device::{Habit, LegalDevice};
use crate::support::effort::tries;
use crate::support::hosts::{Convention, view};

/// How many cases there are if all run.
const CASES: u32 = 400_000;

fn unit(random: &mut fastrand::Rng) -> DVec3 {
    loop {
        let v = DVec3::from([0; 3].map(|_| random.f64() * 2.0 - 1.0));
        if v.length() > 0.1 && v.length() < 1.0 {
            return v / v.length();
        }
    }
}

/// Any camera, with lengths over some decades.
fn any_camera(random: &mut fastrand::Rng) -> Box<dyn Camera> {
    let mut length = || 10_f64.powf(random.f64() * 6.0 - 3.0);
    let (distance, half_extent) = (length(), [length(), length()]);
    let (focus, part, separation, convergence) = (length(), length() / 1e3, length(), length());
    let eye = unit(random) * if random.bool() { 0.0 } else { length_of(random) };
    let pose = Pose::looking_along(eye, unit(random), unit(random)).unwrap();
    let pinhole = PinholeCamera::new(pose, distance, half_extent).unwrap();
    let panorama = PanoramaCamera::new(pose);
    match random.u8(0..9) {
        0 => Box::new(pinhole),
        1 => Box::new(pinhole.stereo_pair(separation, convergence).unwrap()[random.usize(0..2)]),
        2 => Box::new(OrthographicCamera::new(pose, half_extent).unwrap()),
        3 => Box::new(ThinLensCamera::new(pinhole, part * focus, focus).unwrap()),
        4 => Box::new(panorama),
        5 => Box::new(panorama.stereo_pair(separation, convergence).unwrap()[random.usize(0..2)]),
        6 => Box::new(FisheyeCamera::new(pose, TAU, half_extent[0]).unwrap()),
        7 => Box::new(any_host(random, pose, half_extent)),
        _ => {
            Box::new(FisheyeCamera::new(pose, TAU * (1.0 - random.f64()), half_extent[0]).unwrap())
        }
    }
}

/// Right, up and forward are at any angles.
fn any_host(random: &mut fastrand::Rng, pose: Pose, half: [f64; 2]) -> HostCamera {
    let convention = [Convention::Perspective, Convention::Orthographic][random.usize(0..2)];
    let [x, y] = half.map(|half| (random.f64() - 0.5) * half);
    let edges = [x - half[0], x + half[0], y - half[1], y + half[1]];
    let projection = convention.projection(edges, [0.1, 10.0], -1.0);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis + 0.4 * unit(random));
    let sheared = DMat4::from_mat3(DMat3::from_cols(axes[0], axes[1], axes[2]));
    let to_view = view(&pose, -1.0) * sheared;
    HostCamera::new(to_view, projection, DepthOrder::NearIsZero).unwrap()
}

fn length_of(random: &mut fastrand::Rng) -> f64 {
    10_f64.powf(random.f64() * 6.0 - 3.0)
}

/// As a device is given it, with any advance.
fn uploaded(camera: &dyn Camera, random: &mut fastrand::Rng) -> UploadedView {
    let vectors = camera.vectors();
    let can_advance = camera.location_of(vectors.origin + vectors.forward).is_some()
        && vectors.numbers[2] == 0.0
        && vectors.numbers[1] != 1.0;
    let advance = if can_advance && random.bool() { length_of(random) as f32 } else { 0.0 };
    let narrow = |v: DVec3| v.as_vec3().to_array();
    UploadedView {
        origin: narrow(vectors.origin + f64::from(advance) * vectors.forward),
        advance,
        right: narrow(vectors.right),
        up: narrow(vectors.up),
        forward: narrow(vectors.forward),
        numbers: vectors.numbers.map(|number| number as f32),
        scene_min: [0.0; 3],
        scene_max: [0.0; 3],
    }
}

/// In the whole square, in its corners, on its diagonals and in the very middle.
fn point(random: &mut fastrand::Rng) -> [f32; 2] {
    let [a, b] = [random.f32(), random.f32()];
    match random.u8(0..10) {
        0 => [0.5, 0.5],
        1 => [a, a],
        2 => [a, 1.0 - a],
        3 => [0.5, a],
        4 => [0.5 + a * 1e-6, 0.5 + b * 1e-6],
        5 => [(a * 4.0).round() / 4.0, (b * 4.0).round() / 4.0],
        _ => [a, b],
    }
}

fn holds(legal: [Interval; 3], found: [f32; 3]) -> bool {
    (0..3).all(|axis| legal[axis].contains(found[axis].into()))
}

#[test]
fn no_ray_of_a_conforming_device_is_accused() {
    let cases = tries(CASES) as usize;
    let mut seen = [0; 2];
    for case in 0..cases {
        let mut random = fastrand::Rng::with_seed(case as u64);
        let camera = any_camera(&mut random);
        let view = uploaded(camera.as_ref(), &mut random);
        let (lens, at) = (point(&mut random), point(&mut random));
        let location = at.map(|x| 2.0 * x - 1.0);
        let legal = LegalCameraRay::new(camera.kind(), &view, location, lens);
        let habit = [Habit::Nearest, Habit::Up, Habit::Down, Habit::Random][case % 4];
        let ray = LegalDevice { habit, random }.camera_ray(camera.kind(), &view, location, lens);
        assert!(
            holds(legal.origin, ray.origin)
                && holds(legal.direction, ray.direction)
                && legal.distance.contains(ray.distance.into())
                && if ray.is_seen { legal.may_be_seen } else { legal.may_be_unseen },
            "case {case}, {habit:?}, {camera:?} at {location:?}, lens {lens:?}: {legal:?}, {:?}",
            (ray.origin, ray.direction, ray.distance, ray.is_seen)
        );
        seen[usize::from(ray.is_seen)] += 1;
    }
    assert!(seen[0] > cases / 100 && seen[1] > cases / 2, "{seen:?}");
}

/// How narrow the bounds are: a fault of eighty roundings is seen. The widest are those of a fisheye of 360
/// degrees, whose angle is up to π times as uncertain as the radius that it is made of.
#[test]
fn the_references_ray_is_near_the_middle_of_what_is_legal() {
    const ROUNDINGS: f64 = 80.0 / (1 << 23) as f64;
    for case in 0..tries(CASES / 10) {
        let mut random = fastrand::Rng::with_seed(case as u64);
        let camera = any_camera(&mut random);
        let mut view = uploaded(camera.as_ref(), &mut random);
        view.advance = 0.0;
        view.origin = camera.vectors().origin.as_vec3().to_array();
        let (lens, at) = (point(&mut random), point(&mut random));
        let location = at.map(|x| 2.0 * x - 1.0);
        let wide = |point: [f32; 2]| DVec2::from(point.map(f64::from));
        let legal = LegalCameraRay::new(camera.kind(), &view, location, lens);
        let ray = camera.ray_through_lens(wide(location), wide(lens));
        let vectors = camera.vectors();
        let reach = vectors.right.length() + vectors.up.length() + vectors.forward.length();
        for axis in 0..3 {
            for (interval, exact, scale) in [
                (legal.direction[axis], ray.direction[axis], 1.0),
                (legal.origin[axis], ray.origin[axis], ray.origin.length() + reach),
            ] {
                let context = format!("case {case}, {camera:?} at {location:?}, lens {lens:?}");
                // Wide lenses, and views to the side, have rays much shorter than their terms.
                let terms =
                    if scale == 1.0 { 1.0 + reach / shortest(camera.as_ref()) } else { scale };
                let error = ROUNDINGS * terms;
                assert!(interval.high - interval.low <= error, "{context}: {interval:?}");
                assert!(interval.low - error <= exact, "{context}: {exact} {interval:?}");
                assert!(exact <= interval.high + error, "{context}: {exact} {interval:?}");
            }
        }
    }
}

/// No ray's vector is shorter, before it is made a unit vector.
fn shortest(camera: &dyn Camera) -> f64 {
    let vectors = camera.vectors();
    let across = vectors.right.cross(vectors.up);
    vectors.forward.dot(across).abs() / across.length()
}
