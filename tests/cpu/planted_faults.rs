//! Tests the checker without a device. It finds every fault planted in a recording.

use pinhole::image::NO_ID;
use pinhole::internals::NO_HIT;
use pinhole::verify::{Checker, Outcome, Recording, TracedPixel, TracedRay, Verdict};
use pinhole::{Image, LayerSet, RenderSettings, Scene};

use crate::support::legal_device::{Habit, LegalDevice};
use crate::support::spheres_of;
use crate::verify::{certify, legal_recording, legal_recording_of_cones};

/// The stages that the checker names after `spoil` changed a pixel with a hit, or one with a miss.
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

/// NaN and infinities, ids without a sphere, hits changed to misses and misses to hits, and misses with a distance.
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
        // Each component is legal for some entry into the box, but not for the same one.
        camera(true, &|ray| ray.origin[axis] += 2e-5);
    }
}

/// Faults of all pixels that show cones, and the least share of them in which each is found.
#[test]
fn faults_of_cones_are_found() {
    let (scene, recording) = legal_recording_of_cones();
    let first = scene.len() as u32;
    let is_cone = |id: u32| id != NO_ID && id >= first;
    let cones = recording.pixels.iter().filter(|pixel| is_cone(pixel.id)).count();
    let traced = |spoil: fn(&mut TracedPixel)| {
        let mut spoilt = recording.clone();
        spoilt.pixels.iter_mut().filter(|pixel| is_cone(pixel.id)).for_each(spoil);
        spoilt
    };
    let shaded = |spoil: fn(&mut Layers)| {
        let mut spoilt = recording.clone();
        change_layers(&mut spoilt, |layers| {
            if is_cone(layers.id[layers.at]) {
                spoil(layers);
            }
        });
        spoilt
    };
    for (fault, least, spoilt) in [
        ("another cone", 1.0, traced(|pixel| pixel.id ^= 1)),
        ("a miss", 0.99, traced(|pixel| (pixel.t, pixel.id) = (NO_HIT, NO_ID))),
        ("a distance", 0.99, traced(|pixel| pixel.t *= 1.0 + 1e-4)),
        ("a depth", 1.0, shaded(|l| l.depth[l.at] *= 1.0 + 1e-4)),
        ("a normal that is turned", 0.98, shaded(|l| l.normal[l.at][0] += 1e-3)),
        ("a normal of another length", 1.0, shaded(|l| l.normal[l.at] = l.normal[l.at].map(|c| 1.001 * c))),
        ("a color", 1.0, shaded(|l| l.color[l.at][0] *= 1.001)),
    ] {
        let found = certify(&scene, &spoilt).count(Verdict::Violation);
        assert!(cones > 100 && found as f64 >= least * cones as f64, "{fault}: {found} of {cones}");
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
    // Some ray misses the box, and need not be traced.
    let index = (0..61 * 47).find(|index| untraced(*index, NO_HIT, NO_ID).is_none()).unwrap();
    assert_eq!(untraced(index, -3.0, 7), Some("hit"));
    assert_eq!(untraced(index, 1.0, NO_ID), Some("hit"));
}

/// The violation in a changed upload.
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

/// The violations in a picture that was rendered beside the recording and has one pixel changed, and the number of
/// pixels that differ.
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

/// The layers of a picture, and the index of one pixel.
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

    /// The image of the layers, with the size of another picture.
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
    // Compares values, because a zero has no sign.
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
    // Pictures of another size, and without a layer.
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
    let TracedPixel { id, t, ray, .. } = recording.pixels[index];
    let (_, told) = violation.message.split_once("; legal is ").unwrap();
    // The message gives the legal answer: that sphere, but not at that distance.
    let TracedRay { origin, direction, .. } = ray.unwrap();
    let legal = Checker::new(&scene).unwrap().legal_hits(origin, direction);
    assert!(legal.of(id).is_some() && !legal.allows(id, t.into()), "{legal}");
    assert_eq!(told, legal.to_string());
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

/// Changes the layers at each pixel.
fn change_layers(recording: &mut Recording, change: impl Fn(&mut Layers)) {
    let mut layers = Layers::of(&recording.image);
    for at in 0..layers.id.len() {
        layers.at = at;
        change(&mut layers);
    }
    recording.image = layers.image(&recording.image);
}

/// The largest p up to 23 for which a relative error of 2⁻ᵖ is found somewhere in a picture.
fn least_found(spoil: impl Fn(&mut Recording, f32)) -> i32 {
    let (scene, recording) = legal_recording();
    let is_found = |power: &i32| {
        let mut spoilt = recording.clone();
        spoil(&mut spoilt, 2_f32.powi(-power));
        certify(&scene, &spoilt).outcome() == Outcome::Violated
    };
    (4..24).take_while(is_found).last().unwrap_or(0)
}

/// These sizes must match the table in docs/explain/how-verify-decides.md.
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
            // Turned about the third axis by about `size`.
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
