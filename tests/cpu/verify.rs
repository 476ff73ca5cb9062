//! The checker by itself: it accuses no device that does what WGSL lets it do, and overlooks nothing that is
//! planted in a recording.

use pinhole::camera::film::YAxis;
use pinhole::camera::{Camera, CameraVectors, OrthographicCamera, PinholeCamera, Pose};
use pinhole::glam::DVec3;
use pinhole::image::NO_ID;
use pinhole::internals::NO_HIT;
use pinhole::render::PrimarySettings;
use pinhole::verify::{
    Certificate, Checker, Outcome, Recording, Rendered, RequestedCamera, TracedPixel, TracedRay,
    UploadedView, Verdict,
};
use pinhole::{Film, Image, LayerSet, RenderSettings, Scene, View};

use crate::legal_device::{Habit, LegalDevice};
use crate::scene::{colored, spheres_of};
use crate::support::spheres::{self, Spheres};
use crate::written::assert_is_not_accused;

/// What a device is given of a camera, whose origin is moved up by `advance`, and of the corners of a scene's box.
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

/// What a device is given; it has made nothing of it yet.
pub(crate) fn given(scene: &Scene, camera: &dyn Camera, film: Film) -> Recording {
    let vectors = camera.vectors();
    let bounds = scene.bounds_to_frame();
    let margin = 1e-4 * bounds.size().length();
    let (low, high) =
        (bounds.min() - scene.origin() - margin, bounds.max() - scene.origin() + margin);
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
    let advance = nearest as f32;
    let corners = [low, high].map(|corner| corner.as_vec3().to_array());
    Recording {
        camera: RequestedCamera { kind: camera.kind(), vectors },
        uploaded: uploaded(&vectors, origin, advance, corners),
        film,
        primary: PrimarySettings::default(),
        pixels: Vec::new(),
        image: Image::new(0, 0, LayerSet::DATA).unwrap(),
        rendered: Rendered::None,
    }
}

fn scene(spheres: &[[f32; 4]]) -> Scene {
    colored(spheres, |i| [3, 5, 7].map(|k| ((i * k) % 17) as f32 / 16.0))
}

/// The size of a scene, and poses outside of it, far away, and within.
pub(crate) fn poses(scene: &Scene) -> (f64, [Pose; 3]) {
    let bounds = scene.bounds_to_frame();
    let (center, size) = (bounds.center(), bounds.size().max_element());
    let up = [0.1, 1.0, 0.2];
    let outside = Pose::looking_at(center + DVec3::new(1.2, 0.7, 1.9) * size, center, up).unwrap();
    let far = Pose::looking_at(center + DVec3::new(60.0, 30.0, -70.0) * size, center, up).unwrap();
    let within = Pose::looking_along(center, [0.3, -0.4, 0.8], up).unwrap();
    (size, [outside, far, within])
}

/// From all poses; `tests/gpu/adversary` has the pictures of every camera.
fn cameras(scene: &Scene) -> Vec<Box<dyn Camera>> {
    let (size, [outside, far, within]) = poses(scene);
    let pinhole = PinholeCamera::with_vertical_fov(outside, 0.7, 1.3).unwrap();
    let [left, _] = pinhole.stereo_pair(0.2 * size, 1.5 * size).unwrap();
    vec![
        Box::new(left),
        Box::new(PinholeCamera::new(far, 100.0 * size, [0.6 * size, 0.5 * size]).unwrap()),
        Box::new(PinholeCamera::with_vertical_fov(within, 1.9, 1.3).unwrap()),
        Box::new(OrthographicCamera::new(outside, [0.9 * size, 0.7 * size]).unwrap()),
        // Recordings to be spoilt are this one's.
        Box::new(pinhole),
    ]
}

/// Spheres at any scale, of all sizes, in one place, in each other, in touch, far away, huge, and none.
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

/// Whatever a device may do, by every habit.
fn assert_never_accused(name: &str, scene: &Scene, camera: &dyn Camera, film: Film) -> usize {
    let habits = [
        (Habit::Nearest, 0),
        (Habit::Up, 0),
        (Habit::Down, 0),
        (Habit::Random, 1),
        (Habit::Random, 2),
    ];
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
        assert_ne!(
            certificate.outcome(),
            Outcome::Violated,
            "{name}, {camera:?}, {habit:?}:\n{certificate}"
        );
        otherwise += certificate.rendered_otherwise.unwrap();
        let view = View::new(camera, film);
        assert_is_not_accused(name, scene, &view, &recording.image);
    }
    // Which says something only if habits differ.
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

/// A flat box, along whose wall rays go: where they enter it depends on the last bit of their direction.
#[test]
fn rays_that_graze_the_box_are_not_accused() {
    let plate: Vec<[f32; 4]> = (0..48)
        .map(|i| [(i / 4) as f32 * 8.0 - 44.0, 0.0, (i % 4) as f32 * 8.0 - 12.0, 1.0])
        .collect();
    let scene = scene(&plate);
    for (height, down) in [(1.5, 10.0), (1.2, 10.0), (2.0, 6.0)] {
        let (eye, target) = ([-20.0, height, 1.0], [-10.0, height - down, 0.5]);
        let pose = Pose::looking_at(eye, target, [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 2.3, 1.3).unwrap();
        assert_never_accused("plate", &scene, &camera, Film::new(61, 501).unwrap());
    }
}

/// Squares of such lengths are normal numbers, but those of their components may become zero.
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

/// A recording of a device that rounds to the nearest.
pub(crate) fn legal_recording() -> (Scene, Recording) {
    let scene = scene(&spheres::random(40, 1, |rng| 0.02 + 0.1 * rng.f32()));
    let camera = cameras(&scene).pop().unwrap();
    let film = Film::new(61, 47).unwrap();
    let mut device = LegalDevice { habit: Habit::Nearest, random: fastrand::Rng::with_seed(0) };
    let recording = device.record(&scene, &given(&scene, camera.as_ref(), film));
    assert!(certify(&scene, &recording).is_legal());
    (scene, recording)
}

/// What is found where a pixel with a hit, or one with a miss, was spoilt.
fn spoilt(of_hit: bool, spoil: impl Fn(&mut TracedPixel)) -> Vec<&'static str> {
    let (scene, mut recording) = legal_recording();
    let hits = recording.pixels.iter().filter(|pixel| (pixel.id != NO_ID) == of_hit).count();
    let mut which = recording.pixels.iter_mut().filter(|pixel| (pixel.id != NO_ID) == of_hit);
    let pixel = which.nth(hits / 2).unwrap();
    spoil(pixel);
    let certificate = certify(&scene, &recording);
    assert_eq!(certificate.violations.len(), certificate.count(Verdict::Violation));
    certificate.violations.iter().map(|violation| violation.stage).collect()
}

/// Numbers that are none, ids of no sphere, hits that are made misses and the other way round, misses with a distance.
#[test]
fn what_is_no_legal_answer_is_found() {
    for (row, (of_hit, stage, spoil)) in [
        (true, "hit", (|pixel| pixel.t = f32::NAN) as fn(&mut TracedPixel)),
        (true, "hit", |pixel| pixel.t = f32::INFINITY),
        (true, "hit", |pixel| pixel.id = 40),
        (true, "hit", |pixel| pixel.id = u32::MAX - 1),
        (false, "hit", |pixel| pixel.id = 40),
        (false, "hit", |pixel| pixel.id = u32::MAX - 1),
        (true, "hit", |pixel| (pixel.t, pixel.id) = (NO_HIT, NO_ID)),
        (false, "hit", |pixel| (pixel.t, pixel.id) = (1.0, 3)),
        (true, "cull", |pixel| pixel.ray = None),
        (false, "hit", |pixel| pixel.t = 1.5),
        (false, "hit", |pixel| pixel.t = -1.0),
        (false, "hit", |pixel| pixel.t = f32::NAN),
        (false, "hit", |pixel| pixel.t = f32::INFINITY),
    ]
    .into_iter()
    .enumerate()
    {
        assert_eq!(spoilt(of_hit, spoil), [stage], "row {row}");
    }
    let camera = |of_hit, spoil: &dyn Fn(&mut TracedRay)| {
        assert_eq!(spoilt(of_hit, |pixel| spoil(pixel.ray.as_mut().unwrap())), ["camera"]);
    };
    for axis in 0..3 {
        for value in [f32::NAN, f32::INFINITY, f32::MAX] {
            camera(true, &|ray| ray.origin[axis] = value);
            camera(false, &|ray| ray.direction[axis] = value);
            camera(true, &|ray| ray.distance = value);
        }
        // Each component may be where it is for some entry into the box, but not for the same one.
        camera(true, &|ray| ray.origin[axis] += 2e-5);
    }
}

#[test]
fn a_ray_that_is_not_traced_has_no_hit() {
    let (scene, recording) = legal_recording();
    let untraced = |index: usize, t, id| {
        let mut recording = recording.clone();
        recording.pixels[index] = TracedPixel { ray: None, t, id, shading_ray: None };
        let certificate = certify(&scene, &recording);
        certificate.violations.first().map(|violation| violation.stage)
    };
    // Some ray does not meet the box, and need not be traced.
    let index = (0..61 * 47).find(|index| untraced(*index, NO_HIT, NO_ID).is_none()).unwrap();
    assert_eq!(untraced(index, -3.0, 7), Some("hit"));
    assert_eq!(untraced(index, 1.0, NO_ID), Some("hit"));
}

/// What is found in what a device was given, where that was spoilt.
fn upload(spoil: impl Fn(&mut Recording)) -> Option<String> {
    let (scene, mut recording) = legal_recording();
    spoil(&mut recording);
    certify(&scene, &recording).upload.map(|error| error.to_string())
}

#[track_caller]
fn says(found: Option<String>, words: &str) {
    let found = found.unwrap();
    assert!(found.contains(words), "{found} lacks {words}");
}

/// What is found where a picture that was rendered beside the recording has another pixel, and in how many pixels that
/// is another.
fn rendered(of_hit: bool, spoil: impl Fn(&mut Layers)) -> (Vec<String>, Option<usize>) {
    let (scene, mut recording) = legal_recording();
    let Recording { image, pixels, .. } = &recording;
    let mut layers = Layers::of(image);
    let which = |index: &usize| (pixels[*index].id != NO_ID) == of_hit;
    let count = (0..pixels.len()).filter(which).count();
    layers.at = (0..pixels.len()).filter(which).nth(count / 2).unwrap();
    spoil(&mut layers);
    let other = layers.image(image);
    recording.compare(other);
    let certificate = certify(&scene, &recording);
    assert_eq!(certificate.violations.len(), certificate.count(Verdict::Violation));
    let found = certificate.violations.iter().map(|violation| {
        assert_eq!(violation.stage, "render");
        violation.message.clone()
    });
    (found.collect(), certificate.rendered_otherwise)
}

/// Of a picture, and a pixel of it.
struct Layers {
    color: Vec<[f32; 3]>,
    depth: Vec<f32>,
    normal: Vec<[f32; 3]>,
    id: Vec<u32>,
    at: usize,
}

impl Layers {
    fn of(image: &Image) -> Self {
        Self {
            color: image.color().to_vec(),
            depth: image.depth().unwrap().to_vec(),
            normal: image.normal().unwrap().to_vec(),
            id: image.id().unwrap().to_vec(),
            at: 0,
        }
    }

    /// As large as another picture.
    fn image(self, other: &Image) -> Image {
        let size = [other.width(), other.height()];
        Image::from_layers(size, self.color, self.depth, self.normal, self.id).unwrap()
    }

    fn miss(&mut self) {
        self.depth[self.at] = f32::INFINITY;
        self.normal[self.at] = [0.0; 3];
        self.id[self.at] = NO_ID;
        self.color[self.at] = RenderSettings::default().background.to_array();
    }
}

#[test]
fn a_rendered_pixel_that_is_another_is_judged_by_itself() {
    assert_eq!(rendered(true, |_| ()), (vec![], Some(0)));
    let next = |depth: f32| depth.next_up();
    assert_eq!(rendered(true, |l| l.depth[l.at] = next(l.depth[l.at])), (vec![], Some(1)));
    // By value: a zero has no sign.
    assert_eq!(rendered(false, |l| l.normal[l.at][1] = -0.0), (vec![], Some(0)));
    for (of_hit, words, spoil) in [
        (true, "hit: sphere ", (|l| l.depth[l.at] *= 1.001) as fn(&mut Layers)),
        (true, "hit: sphere ", |l| l.depth[l.at] = f32::NAN),
        (true, "hit: sphere 40 at ", |l| l.id[l.at] = 40),
        (true, "hit: a miss; legal is sphere ", Layers::miss),
        (true, "normal: ", |l| l.normal[l.at][0] += 1e-3),
        (true, "color: green is ", |l| l.color[l.at][1] += 1e-3),
        (false, "hit: sphere 3 at ", |l| l.id[l.at] = 3),
        (false, "depth: ", |l| l.depth[l.at] = 1e30),
        (false, "color: ", |l| l.color[l.at][2] = 0.5),
    ] {
        let (found, count) = rendered(of_hit, spoil);
        assert_eq!((found.len(), count), (1, Some(1)), "{words}");
        assert!(found[0].starts_with(words), "{} is not {words}", found[0]);
    }
    // Of another size, and without a layer.
    let other = |[width, height]: [u32; 2], layers| {
        upload(|recording| recording.compare(Image::new(width, height, layers).unwrap()))
    };
    says(other([47, 61], LayerSet::DATA), "a picture of 47x61, but the film is 61x47");
    says(other([61, 47], LayerSet::COLOR), "the picture lacks one of its layers");
}

#[test]
fn one_bit_of_what_a_device_is_given_is_found() {
    for axis in 0..3 {
        for up in [true, false] {
            let moved = move |x: &mut f32| *x = if up { x.next_up() } else { x.next_down() };
            for found in [
                upload(|recording| moved(&mut recording.uploaded.origin[axis])),
                upload(|recording| moved(&mut recording.uploaded.right[axis])),
                upload(|recording| moved(&mut recording.uploaded.up[axis])),
                upload(|recording| moved(&mut recording.uploaded.forward[axis])),
                upload(|recording| moved(&mut recording.uploaded.numbers[axis])),
            ] {
                says(found, "the camera's vector");
            }
        }
    }
}

#[test]
fn a_camera_that_is_not_moved_up_to_the_box_is_found() {
    for factor in [0.0, 0.5, 1.01] {
        let found = upload(|recording| {
            let Recording { camera, uploaded, .. } = recording;
            uploaded.advance *= factor;
            let moved = f64::from(uploaded.advance) * camera.vectors.forward;
            uploaded.origin = (camera.vectors.origin + moved).as_vec3().to_array();
        });
        says(found, "times the forward vector ahead of the camera");
    }
}

#[test]
fn a_recording_of_another_size_is_found() {
    let fewer = upload(|recording| recording.pixels.truncate(100));
    says(fewer, "the recording has 100 pixels");
    let turned = upload(|recording| {
        recording.image = Image::new(47, 61, LayerSet::DATA).unwrap();
    });
    says(turned, "a picture of 47x61");
    let flat = upload(|recording| recording.image = Image::new(61, 47, LayerSet::COLOR).unwrap());
    says(flat, "the picture lacks one of its layers");
}

#[test]
fn a_violation_is_told_with_both_values() {
    let (scene, mut recording) = legal_recording();
    let index = recording.pixels.iter().position(|pixel| pixel.id != NO_ID).unwrap();
    recording.pixels[index].t *= 1.001;
    let certificate = certify(&scene, &recording);
    let [violation] = &certificate.violations[..] else { panic!("{certificate}") };
    let TracedPixel { id, t, .. } = recording.pixels[index];
    let (_, legal) = violation.message.split_once("; legal is ").unwrap();
    assert!(legal.contains(&format!("sphere {id} at [")), "{legal}");
    let text = certificate.to_string();
    let [i, j] = violation.pixel;
    let told = format!("pixel ({i}, {j}), hit: sphere {id} at {t:?}; legal is");
    assert!(text.contains(&told), "{text}");
}

#[test]
fn of_too_many_violations_all_are_counted() {
    let (scene, mut recording) = legal_recording();
    for pixel in &mut recording.pixels {
        pixel.id = 77;
    }
    let certificate = certify(&scene, &recording);
    assert_eq!(certificate.count(Verdict::Violation), 61 * 47);
    assert_eq!(certificate.violations.len(), 1000);
    assert_eq!(certificate.violations[0].pixel, [0, 0]);
}

/// Changes the layers of each pixel.
fn change_layers(recording: &mut Recording, change: impl Fn(&mut Layers)) {
    let mut layers = Layers::of(&recording.image);
    for at in 0..layers.id.len() {
        layers.at = at;
        change(&mut layers);
    }
    recording.image = layers.image(&recording.image);
}

/// The largest power of two of which a relative error is found somewhere in a picture.
fn least_found(spoil: impl Fn(&mut Recording, f32)) -> i32 {
    let (scene, recording) = legal_recording();
    let is_found = |power: &i32| {
        let mut spoilt = recording.clone();
        spoil(&mut spoilt, 2_f32.powi(-power));
        certify(&scene, &spoilt).outcome() == Outcome::Violated
    };
    (4..24).take_while(is_found).last().unwrap_or(0)
}

/// The table of docs/verify.md says these sizes.
#[test]
fn errors_are_found_from_the_documented_size_on() {
    let (scene, recording) = legal_recording();
    let of_radius = least_found(|spoilt, size| {
        let mut larger = spheres_of(&scene);
        larger.iter_mut().for_each(|sphere| sphere.radius *= 1.0 + f64::from(size));
        let larger = Scene::new(&larger).unwrap();
        let mut device = LegalDevice { habit: Habit::Nearest, random: fastrand::Rng::with_seed(0) };
        *spoilt = device.record(&larger, &recording);
    });
    let of_distance = least_found(|spoilt, size| {
        let depths: Vec<f32> = spoilt
            .pixels
            .iter_mut()
            .map(|pixel| {
                pixel.t *= if pixel.id == NO_ID { 1.0 } else { 1.0 + size };
                pixel.ray.map_or(f32::INFINITY, |ray| ray.distance + pixel.t)
            })
            .collect();
        change_layers(spoilt, |l| {
            l.depth[l.at] = if l.id[l.at] == NO_ID { f32::INFINITY } else { depths[l.at] };
        });
    });
    let of_normal = least_found(|spoilt, size| {
        change_layers(spoilt, |l| {
            let [x, y, z] = l.normal[l.at];
            // Turned about the third axis, by about as much as `size`.
            l.normal[l.at] = [x - size * y, y + size * x, z];
        });
    });
    let of_color = least_found(|spoilt, size| {
        change_layers(spoilt, |l| {
            let factor = if l.id[l.at] == NO_ID { 1.0 } else { 1.0 + size };
            l.color[l.at] = l.color[l.at].map(|c| c * factor);
        });
    });
    let found = [of_radius, of_distance, of_normal, of_color];
    assert!(found.iter().zip([17, 17, 15, 17]).all(|(found, said)| *found >= said), "{found:?}");
}
