//! Tests the checker without a device. It must not accuse conforming devices. `planted_faults.rs` tests its finds.

use std::f64::consts::TAU;

use pinhole::camera::film::YAxis;
use pinhole::camera::{
    Camera, CameraKind, CameraVectors, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose,
    ThinLensCamera,
};
use pinhole::glam::DVec3;
use pinhole::image::NO_ID;
use pinhole::render::PrimarySettings;
use pinhole::scene::cone::{Caps, Cone};
use pinhole::verify::{Certificate, Checker, Outcome, PlainRender, Recording, RequestedCamera, UploadedView};
use pinhole::{Film, Image, LayerSet, LinearRgb, Scene, SphereArray, View};

use crate::scene::colored;
use crate::support::legal_device::{Habit, LegalDevice};
use crate::support::spheres::{self, Spheres};
use crate::written::assert_is_not_accused;

/// The upload of a camera, with its origin advanced by `advance`, and of the corners of a scene's box.
pub(crate) fn uploaded(
    vectors: &CameraVectors,
    origin: DVec3,
    advance: f32,
    [scene_min, scene_max]: [[f32; 3]; 2],
) -> UploadedView {
    let narrow = |v: DVec3| v.as_vec3().to_array();
    UploadedView {
        origin: narrow(origin + f64::from(advance) * vectors.forward),
        advance,
        right: narrow(vectors.right),
        up: narrow(vectors.up),
        forward: narrow(vectors.forward),
        numbers: vectors.numbers.map(|number| number as f32),
        scene_min,
        scene_max,
    }
}

/// A recording with a device's input, and without any output.
pub(crate) fn given(scene: &Scene, camera: &dyn Camera, film: Film) -> Recording {
    let vectors = camera.vectors();
    let bounds = scene.bounds_to_frame();
    let margin = 1e-4 * bounds.size().length();
    let (low, high) = (bounds.min() - scene.origin() - margin, bounds.max() - scene.origin() + margin);
    let origin = vectors.origin - scene.origin();
    let forward = vectors.forward;
    let [low, high] = [low, high].map(|corner| corner.as_vec3().as_dvec3());
    let across = vectors.right.cross(vectors.up);
    let nearest = (0..8)
        .map(|i| {
            let side = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let corner = DVec3::new(side(0), side(1), side(2));
            (corner - origin).dot(across) / forward.dot(across)
        })
        .fold(f64::INFINITY, f64::min)
        .max(0.0);
    // Rays of panoramas and fisheyes go in all directions, so they are not advanced.
    let is_moved = !matches!(camera.kind(), CameraKind::Panorama | CameraKind::Fisheye);
    let advance = if is_moved { nearest as f32 } else { 0.0 };
    let corners = [low, high].map(|corner| corner.as_vec3().to_array());
    Recording {
        camera: RequestedCamera { kind: camera.kind(), vectors },
        uploaded: uploaded(&vectors, origin, advance, corners),
        film,
        primary: PrimarySettings::default(),
        pixels: Vec::new(),
        image: Image::new(0, 0, LayerSet::DATA).unwrap(),
        rendered: PlainRender::None,
    }
}

fn scene(spheres: &[[f32; 4]]) -> Scene {
    colored(spheres, |i| [3, 5, 7].map(|k| ((i * k) % 17) as f32 / 16.0))
}

/// The size of a scene, and poses outside it, far away, and inside.
pub(crate) fn poses(scene: &Scene) -> (f64, [Pose; 3]) {
    let bounds = scene.bounds_to_frame();
    let (center, size) = (bounds.center(), bounds.size().max_element());
    let up = [0.1, 1.0, 0.2];
    let outside = Pose::looking_at(center + DVec3::new(1.2, 0.7, 1.9) * size, center, up).unwrap();
    let far = Pose::looking_at(center + DVec3::new(60.0, 30.0, -70.0) * size, center, up).unwrap();
    let within = Pose::looking_along(center, [0.3, -0.4, 0.8], up).unwrap();
    (size, [outside, far, within])
}

/// Every camera from all poses.
fn cameras(scene: &Scene) -> Vec<Box<dyn Camera>> {
    let (size, [outside, far, within]) = poses(scene);
    let pinhole = PinholeCamera::with_vertical_fov(outside, 0.7, 1.3).unwrap();
    let [left, _] = pinhole.stereo_pair(0.2 * size, 1.5 * size).unwrap();
    let panorama = PanoramaCamera::new(within);
    let [_, right_around] = panorama.stereo_pair(0.1 * size, 0.5 * size).unwrap();
    vec![
        Box::new(left),
        Box::new(ThinLensCamera::new(pinhole, 0.1 * size, 2.0 * size).unwrap()),
        Box::new(panorama),
        Box::new(right_around),
        Box::new(PanoramaCamera::new(far)),
        Box::new(FisheyeCamera::new(within, TAU, 41.0 / 33.0).unwrap()),
        Box::new(FisheyeCamera::new(outside, 1.1, 0.8).unwrap()),
        Box::new(PinholeCamera::new(far, 100.0 * size, [0.6 * size, 0.5 * size]).unwrap()),
        Box::new(PinholeCamera::with_vertical_fov(within, 1.9, 1.3).unwrap()),
        Box::new(OrthographicCamera::new(outside, [0.9 * size, 0.7 * size]).unwrap()),
        // Other tests change recordings of this camera.
        Box::new(pinhole),
    ]
}

/// Spheres at any scale: of all sizes, coincident, nested, touching, far away, huge, and none.
pub(crate) fn hostile_spheres() -> [Spheres; 10] {
    let few = spheres::random(40, 2, |_| 0.1);
    let mut far_from_the_origin = spheres::random(40, 3, |rng| 0.02 + 0.1 * rng.f32());
    for [x, y, z, _] in &mut far_from_the_origin {
        (*x, *y, *z) = (*x + 1e6, *y - 2e6, *z + 3e6);
    }
    [
        spheres::random(40, 1, |rng| 0.02 + 0.1 * rng.f32()),
        spheres::scaled(&few, 2_f32.powi(40)),
        spheres::scaled(&few, 2_f32.powi(-40)),
        spheres::four_decades(60),
        spheres::twice(20),
        spheres::nested(12),
        spheres::lattice(4),
        far_from_the_origin,
        vec![[0.0, -1e5, 0.0, 1e5], [0.3, 0.2, 0.1, 0.2]],
        Vec::new(),
    ]
}

pub(crate) fn certify(scene: &Scene, recording: &Recording) -> Certificate {
    Checker::new(scene).unwrap().certify(recording)
}

/// Checks that no habit of a legal device is accused.
fn assert_never_accused(name: &str, scene: &Scene, camera: &dyn Camera, film: Film) -> usize {
    let habits = [(Habit::Nearest, 0), (Habit::Up, 0), (Habit::Down, 0), (Habit::Random, 1), (Habit::Random, 2)];
    let made = habits.map(|(habit, seed)| {
        let mut device = LegalDevice { habit, random: fastrand::Rng::with_seed(seed) };
        device.record(scene, &given(scene, camera, film))
    });
    let mut otherwise = 0;
    for (number, (habit, _)) in habits.into_iter().enumerate() {
        // Kernels that keep no rays may have another habit.
        let mut recording = made[number].clone();
        recording.compare(made[(number + 1) % made.len()].image.clone());
        let certificate = certify(scene, &recording);
        assert_ne!(certificate.outcome(), Outcome::Violated, "{name}, {camera:?}, {habit:?}:\n{certificate}");
        otherwise += certificate.rendered_otherwise.unwrap();
        let view = View::new(camera, film);
        assert_is_not_accused(name, scene, &view, &recording.image);
    }
    // This has a meaning only if habits differ.
    let is_seen = made[0].pixels.iter().any(|pixel| pixel.id != NO_ID);
    assert_eq!(otherwise > 0, is_seen, "{name}, {camera:?}");
    habits.len() * film.pixel_count() as usize
}

#[test]
fn no_picture_of_a_conforming_device_is_accused() {
    let mut pixels = 0;
    for (number, spheres) in hostile_spheres().iter().enumerate() {
        let scene = scene(spheres);
        for camera in cameras(&scene) {
            for y_axis in [YAxis::Up, YAxis::Down] {
                let film = Film::new(41, 33).unwrap().with_y_axis(y_axis);
                pixels += assert_never_accused(&number.to_string(), &scene, camera.as_ref(), film);
            }
        }
    }
    assert!(pixels > 400_000, "{pixels}");
}

/// Spheres between cylinders, needles, flat discs and pointed cones, with closed and open ends, at any scale.
pub(crate) fn with_cones(seed: u64, scale: f64, length: [f64; 2], radius: [f64; 2]) -> Scene {
    let mut random = fastrand::Rng::with_seed(seed);
    let cones: Vec<Cone> = (0..30)
        .map(|index| {
            let mut vector = |size: f64| DVec3::from([0; 3].map(|_| scale * size * (random.f64() - 0.5)));
            let (start, way) = (vector(2.0), vector(1.0));
            let mut between = |[low, high]: [f64; 2]| low * (high / low).powf(random.f64());
            let (length, first) = (between(length), scale * between(radius));
            let way = if index % 5 == 0 { DVec3::AXES[index % 3] } else { way.normalize_or(DVec3::X) };
            let end = start + scale * length * way;
            let second = [first, 0.0, 0.5 * first][index % 3];
            let caps = [Caps::Both, Caps::None, Caps::First, Caps::Second][index % 4];
            Cone::new(start.to_array(), end.to_array(), [first, second]).with_caps(caps)
        })
        .collect();
    let spheres = spheres::scaled(&spheres::random(12, seed, |rng| 0.02 + 0.1 * rng.f32()), scale as f32);
    let array = SphereArray::F32(spheres);
    Scene::from_shapes(array, &cones, LinearRgb::new([0.9, 0.5, 0.2]).unwrap().into()).unwrap()
}

#[test]
fn no_picture_with_cones_is_accused() {
    let mut cones = 0;
    for (seed, scale, length, radius) in
        [(1, 1.0, [0.3, 1.0], [0.05, 0.2]), (2, 1e6, [0.5, 2.0], [1e-4, 0.02]), (3, 1e-6, [1e-4, 0.1], [0.1, 0.4])]
    {
        let scene = with_cones(seed, scale, length, radius);
        for camera in cameras(&scene) {
            let film = Film::new(41, 33).unwrap();
            assert_never_accused(&seed.to_string(), &scene, camera.as_ref(), film);
            let mut device = LegalDevice { habit: Habit::Nearest, random: fastrand::Rng::with_seed(0) };
            let recording = device.record(&scene, &given(&scene, camera.as_ref(), film));
            cones +=
                recording.pixels.iter().filter(|pixel| pixel.id != NO_ID && pixel.id >= scene.len() as u32).count();
        }
    }
    assert!(cones > 5000, "{cones}");
}

/// A flat box with rays along its wall. Where these enter depends on the last bit of their direction.
#[test]
fn rays_that_graze_the_box_are_not_accused() {
    let plate: Vec<[f32; 4]> =
        (0..48).map(|i| [(i / 4) as f32 * 8.0 - 44.0, 0.0, (i % 4) as f32 * 8.0 - 12.0, 1.0]).collect();
    let scene = scene(&plate);
    for (height, down) in [(1.5, 10.0), (1.2, 10.0), (2.0, 6.0)] {
        let (eye, target) = ([-20.0, height, 1.0], [-10.0, height - down, 0.5]);
        let pose = Pose::looking_at(eye, target, [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 2.3, 1.3).unwrap();
        assert_never_accused("plate", &scene, &camera, Film::new(61, 501).unwrap());
    }
}

/// Squares of such lengths are normal numbers, but the squares of their components may become zero.
#[test]
fn the_smallest_lengths_are_not_accused() {
    let up = [0.0, 1.0, 0.0];
    for power in [-56, -55, -54] {
        let size = 2_f64.powi(power);
        let two = spheres::scaled(&vec![[0.0, 0.0, 0.0, 1.0], [2.5, 0.0, 0.0, 1.0]], size as f32);
        let pose = Pose::looking_along([size, 0.0, 6.0 * size], [0.0, 0.0, -1.0], up).unwrap();
        let camera = OrthographicCamera::new(pose, [3.0 * size, 2.0 * size]).unwrap();
        assert_never_accused("spheres", &scene(&two), &camera, Film::new(201, 129).unwrap());

        let pose = Pose::looking_along([0.0, 0.0, 6.0], [0.0, 0.0, -1.0], up).unwrap();
        let camera = PinholeCamera::new(pose, size, [size, size]).unwrap();
        let one = scene(&[[0.0, 0.0, 0.0, 1.0]]);
        assert_never_accused("camera", &one, &camera, Film::new(201, 201).unwrap());
    }
}

/// A recording of a device that rounds to nearest.
pub(crate) fn legal_recording() -> (Scene, Recording) {
    recorded(scene(&spheres::random(40, 1, |rng| 0.02 + 0.1 * rng.f32())))
}

/// The same of spheres and cones.
pub(crate) fn legal_recording_of_cones() -> (Scene, Recording) {
    recorded(with_cones(1, 1.0, [0.3, 1.0], [0.05, 0.2]))
}

fn recorded(scene: Scene) -> (Scene, Recording) {
    let camera = cameras(&scene).pop().unwrap();
    let film = Film::new(61, 47).unwrap();
    let mut device = LegalDevice { habit: Habit::Nearest, random: fastrand::Rng::with_seed(0) };
    let recording = device.record(&scene, &given(&scene, camera.as_ref(), film));
    assert!(certify(&scene, &recording).is_legal());
    (scene, recording)
}
