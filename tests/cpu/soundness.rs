//! Checks that the set of legal answers contains the exact answer, computed without rounding, and every answer of a
//! device that uses all the freedom of WGSL. Rays are hostile, or come from all cameras, locations and points of the
//! lens.

use std::f64::consts::TAU;

use dashu_float::round::mode;
use dashu_float::{Context, FBig};
use fastrand::Rng;
use pinhole::camera::{
    Camera, DepthOrder, FisheyeCamera, HostCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose,
    ThinLensCamera,
};
use pinhole::glam::{DMat3, DMat4, DVec2, DVec3, Vec3};
use pinhole::internals::NO_HIT;
use pinhole::verify::{Checker, Interval, LegalCameraRay, LegalHits, TracedRay, UploadedView};
use pinhole::{LinearRgb, Scene};

use crate::support::effort::tries;
use crate::support::hosts::{Convention, view};
use crate::support::legal_device::{Habit, LegalDevice};
use crate::verify;

/// The number of cases if all of them run.
const CASES: u32 = 1_000_000;

/// Numbers of any length, whose sums and products are exact.
type Exact = FBig<mode::HalfEven, 2>;

/// The number of bits of a square root, which is far more than any bound can tell.
const ROOT_BITS: usize = 160;

fn exact(value: f32) -> Exact {
    Exact::try_from(value).unwrap().with_precision(0).value()
}

fn dot(a: &[Exact; 3], b: &[Exact; 3]) -> Exact {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// The ray's parameter at the first point of a sphere in front of its origin, or from inside at the far side.
fn exact_hit(origin: &[Exact; 3], direction: &[Exact; 3], sphere: [f32; 4]) -> Option<Exact> {
    let [x, y, z, radius] = sphere.map(exact);
    let l = [&x - &origin[0], &y - &origin[1], &z - &origin[2]];
    let s = dot(direction, direction);
    let b = dot(&l, direction);
    let c = dot(&l, &l) - &radius * &radius;
    let discriminant = &b * &b - &s * &c;
    if discriminant < Exact::ZERO {
        return None;
    }
    let context = Context::<mode::HalfEven>::new(ROOT_BITS);
    let root: Exact = context.sqrt(discriminant.repr()).unwrap().value();
    let is_outside = c > Exact::ZERO;
    let numerator = if is_outside { b.clone() - root } else { b.clone() + root };
    if numerator <= Exact::ZERO || (is_outside && b <= Exact::ZERO) {
        return None;
    }
    Some(context.div(numerator.repr(), s.repr()).unwrap().value())
}

/// Whether the legal answers contain the exact nearest sphere at its exact distance.
fn holds_exact(case: &Case, scene: &Scene, legal: &LegalHits) -> bool {
    let (origin, direction) = (case.origin.map(exact), case.direction.map(exact));
    let hits: Vec<_> = (0..)
        .zip(scene.spheres())
        .filter_map(|(id, sphere)| Some((exact_hit(&origin, &direction, *sphere)?, id)))
        .collect();
    let nearest = hits.iter().min_by(|a, b| a.partial_cmp(b).unwrap());
    let Some((t, id)) = nearest else { return legal.miss };
    // The parameter, and the length along a direction that is nearly a unit vector, are both exact answers.
    let s = dot(&direction, &direction);
    let context = Context::<mode::HalfEven>::new(ROOT_BITS);
    let length: Exact = context.sqrt(s.repr()).unwrap().value();
    [t.clone(), t * length].iter().all(|t| legal.allows(*id, t.to_f64().value()))
}

/// Whether the legal answers contain the answer of a device.
fn allows(device: &mut LegalDevice, case: &Case, scene: &Scene, legal: &LegalHits) -> bool {
    let ray = TracedRay { origin: case.origin, direction: case.direction, distance: 0.0 };
    let mut nearest = (NO_HIT, u32::MAX);
    for (id, sphere) in (0..).zip(scene.spheres()) {
        // A kernel finds the same distance for equal spheres, but a random device would not.
        if scene.spheres()[..id as usize].contains(sphere) {
            continue;
        }
        let t = device.intersect(&ray, *sphere);
        if t < nearest.0 {
            nearest = (t, id);
        }
    }
    match nearest {
        (_, u32::MAX) => legal.miss,
        (t, id) => legal.allows(id, t.into()),
    }
}

/// Runs `judge` on many cases, on two threads, and shows the first case that fails.
fn on_cases(seed: u64, judge: impl Fn(&Case, &Scene, &LegalHits, &mut Rng) -> bool + Sync) {
    let cases = u64::from(tries(CASES));
    let undecided: u64 = std::thread::scope(|scope| {
        let run = |thread: u64| {
            let mut random = Rng::with_seed(seed + thread);
            let mut undecided = 0;
            for _ in 0..cases.div_ceil(2) {
                let case = case(&mut random);
                // In the scene's own frame, wherever its origin is.
                let Ok(scene) = Scene::from_f32(case.spheres.clone(), LinearRgb::WHITE) else {
                    continue;
                };
                let moved = scene.origin().to_array();
                let origin = [0, 1, 2].map(|k| (f64::from(case.origin[k]) - moved[k]) as f32);
                let case = Case { origin, ..case };
                let legal = Checker::new(&scene).unwrap().legal_hits(case.origin, case.direction);
                undecided += u64::from(legal.count() != 1);
                assert!(
                    judge(&case, &scene, &legal, &mut random),
                    "{case:?}\nspheres in the scene's frame: {:?}\nlegal: {legal}",
                    scene.spheres()
                );
            }
            undecided
        };
        let handles = [0, 1].map(|thread| scope.spawn(move || run(thread)));
        handles.into_iter().map(|handle| handle.join().unwrap()).sum()
    });
    // The cases are hostile, yet most have one answer. A set of all answers would be sound as well.
    assert!(undecided < cases / 2, "{undecided}");
    assert!(undecided > cases / 100, "{undecided}");
}

#[test]
fn the_exact_answer_is_legal() {
    on_cases(1, |case, scene, legal, _| holds_exact(case, scene, legal));
}

#[test]
fn no_conforming_device_is_accused() {
    on_cases(3, |case, scene, legal, random| {
        [Habit::Nearest, Habit::Up, Habit::Down, Habit::Random].into_iter().all(|habit| {
            let mut device = LegalDevice { habit, random: random.fork() };
            allows(&mut device, case, scene, legal)
        })
    });
}

/// A ray and a few spheres, with exactly the numbers that a device gets.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    pub(crate) spheres: Vec<[f32; 4]>,
}

fn unit(random: &mut Rng) -> DVec3 {
    loop {
        let v = DVec3::from([0; 3].map(|_| random.f64() * 2.0 - 1.0));
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize_or(DVec3::X);
        }
    }
}

/// Ten to a random power between two numbers.
fn decades(random: &mut Rng, low: f64, high: f64) -> f64 {
    10_f64.powf(low + (high - low) * random.f64())
}

/// A direction as normalized in f32, or slightly off unit length.
fn narrow_direction(direction: DVec3, random: &mut Rng) -> [f32; 3] {
    let off = 1.0 + (random.f64() - 0.5) * 2e-6 * f64::from(random.u8(0..2));
    (direction * off).as_vec3().to_array()
}

fn sphere(center: DVec3, radius: f64) -> [f32; 4] {
    let center = center.as_vec3();
    [center.x, center.y, center.z, radius as f32]
}

/// A sphere that the ray passes at nearly the distance of its radius, at `along` ahead.
fn nearly_tangent(origin: DVec3, direction: DVec3, along: f64, random: &mut Rng) -> [f32; 4] {
    let radius = along * decades(random, -4.0, 0.5);
    let across = direction.cross(unit(random)).normalize_or(direction.any_orthonormal_vector());
    let off = 1.0 + (random.f64() - 0.5) * decades(random, -9.0, -2.0);
    sphere(origin + along * direction + radius * off * across, radius)
}

/// A sphere with the ray's origin nearly on its wall.
fn nearly_on_wall(origin: DVec3, random: &mut Rng) -> [f32; 4] {
    let radius = decades(random, -3.0, 3.0);
    let off = 1.0 + (random.f64() - 0.5) * decades(random, -9.0, -3.0);
    sphere(origin + unit(random) * radius * off, radius)
}

pub(crate) fn case(random: &mut Rng) -> Case {
    let size = match random.u8(0..8) {
        0 => 2_f64.powi(50),
        1 => 2_f64.powi(-50),
        _ => 1.0,
    };
    let offset = match random.u8(0..8) {
        0 => unit(random) * decades(random, 0.0, 6.0),
        _ => DVec3::ZERO,
    };
    let near = |random: &mut Rng| offset + DVec3::from([0; 3].map(|_| random.f64() * 2.0 - 1.0));
    let origin = near(random) * if random.u8(0..4) == 0 { 100.0 } else { 1.0 };
    let target = near(random);
    let aimed = match random.u8(0..8) {
        0 => DVec3::AXES[random.usize(0..3)],
        _ => (target - origin).normalize_or(DVec3::X),
    };
    let direction = narrow_direction(aimed, random);
    let exact = Vec3::from(direction).as_dvec3();
    let origin = origin.as_vec3().as_dvec3();
    let distance = (target - origin).length();
    let mut spheres: Vec<[f32; 4]> = Vec::new();
    for _ in 0..random.usize(1..5) {
        let made = match random.u8(0..6) {
            0 => nearly_tangent(origin, exact, distance * (0.1 + random.f64()), random),
            1 => nearly_on_wall(origin, random),
            // A tie: a sphere as far along the ray as another, or an equal one.
            2 if !spheres.is_empty() => {
                let [x, y, z, radius] = spheres[random.usize(0..spheres.len())];
                let center = DVec3::new(x.into(), y.into(), z.into());
                let grown = f64::from(radius) * decades(random, -1.0, 1.0);
                let off = (random.f64() - 0.5) * distance * decades(random, -9.0, -5.0);
                sphere(center + exact * (grown - f64::from(radius) + off), grown)
            }
            3 if !spheres.is_empty() => spheres[random.usize(0..spheres.len())],
            // A sphere in the ray's way, of any size.
            4 => sphere(origin + exact * distance, distance * decades(random, -5.0, 0.5)),
            _ => sphere(near(random), decades(random, -3.0, 0.0)),
        };
        spheres.push(made);
    }
    let scaled = |v: DVec3| (v * size).as_vec3().to_array();
    let spheres = spheres
        .into_iter()
        .map(|[x, y, z, radius]| {
            let [x, y, z] = scaled(DVec3::new(x.into(), y.into(), z.into()));
            [x, y, z, (f64::from(radius) * size) as f32]
        })
        .collect();
    Case { origin: scaled(origin), direction, spheres }
}

/// The number of rays of cameras if all of them run.
const RAYS: u32 = 400_000;

/// Any camera, with lengths over some decades.
fn any_camera(random: &mut fastrand::Rng) -> Box<dyn Camera> {
    let mut length = || decades(random, -3.0, 3.0);
    let (distance, half_extent) = (length(), [length(), length()]);
    let (focus, part, separation, convergence) = (length(), length() / 1e3, length(), length());
    let eye = unit(random) * if random.bool() { 0.0 } else { decades(random, -3.0, 3.0) };
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
        _ => Box::new(FisheyeCamera::new(pose, TAU * (1.0 - random.f64()), half_extent[0]).unwrap()),
    }
}

/// A host camera whose right, up and forward are at any angles.
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

/// The camera as a device gets it, with any advance.
fn uploaded(camera: &dyn Camera, random: &mut fastrand::Rng) -> UploadedView {
    let vectors = camera.vectors();
    let can_advance = camera.location_of(vectors.origin + vectors.forward).is_some()
        && vectors.numbers[2] == 0.0
        && vectors.numbers[1] != 1.0;
    let advance = if can_advance && random.bool() { decades(random, -3.0, 3.0) as f32 } else { 0.0 };
    verify::uploaded(&vectors, vectors.origin, advance, [[0.0; 3]; 2])
}

/// A point in the whole square, in its corners, on its diagonals or exactly in the middle.
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
    let cases = tries(RAYS) as usize;
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
    // Fisheyes see nothing in the corners. Otherwise those would not be tested.
    assert!(seen[0] > cases / 100 && seen[1] > cases / 2, "{seen:?}");
}

/// The bounds are narrow: an error of eighty roundings is found. The widest bounds are those of a fisheye of 360
/// degrees, whose angle is up to π times as uncertain as the radius from which it is computed.
#[test]
fn the_references_ray_is_near_the_middle_of_what_is_legal() {
    const ROUNDINGS: f64 = 80.0 / (1 << 23) as f64;
    for case in 0..tries(RAYS / 10) {
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
                // Wide lenses, and views to the side, have rays that are much shorter than their terms.
                let terms = if scale == 1.0 { 1.0 + reach / shortest(camera.as_ref()) } else { scale };
                let error = ROUNDINGS * terms;
                assert!(interval.high - interval.low <= error, "{context}: {interval:?}");
                assert!(interval.low - error <= exact, "{context}: {exact} {interval:?}");
                assert!(exact <= interval.high + error, "{context}: {exact} {interval:?}");
            }
        }
    }
}

/// A lower bound of the lengths of the camera's ray vectors before normalization.
fn shortest(camera: &dyn Camera) -> f64 {
    let vectors = camera.vectors();
    let across = vectors.right.cross(vectors.up);
    vectors.forward.dot(across).abs() / across.length()
}
