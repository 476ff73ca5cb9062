//! Certificates of answers about cones and cylinders: no careful renderer is accused, and planted faults are found.

use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::glam::DVec3;
use pinhole::image::NO_ID;
use pinhole::scene::cone::{Caps, Cone};
use pinhole::verify::conformance::{Answers, Conformance, Rays, Reason};
use pinhole::verify::{Checker, Outcome};
use pinhole::{Film, LinearRgb, Scene, SphereArray, View};

use crate::conformance::{Layers, cameras};
use crate::support::cones;
use crate::support::legal_device::{Habit, LegalDevice};
use crate::verify::{given, with_cones};

fn film() -> Film {
    Film::new(41, 33).unwrap()
}

fn scene_of(cones: &[Cone]) -> Scene {
    Scene::from_shapes(SphereArray::F32(Vec::new()), cones, LinearRgb::WHITE.into()).unwrap()
}

fn judged(scene: &Scene, view: View<'_>, made: &Layers) -> Conformance {
    let answers = Answers { normals: Some(&made.normals), ..made.answers() };
    Checker::new(scene).unwrap().certify_answers(&answers, Rays::View(view), None).unwrap()
}

/// The layers of a device that computes in f32.
fn by_device(scene: &Scene, camera: &dyn Camera, habit: Habit) -> Layers {
    let mut device = LegalDevice { habit, random: fastrand::Rng::with_seed(0) };
    Layers::of_image(&device.record(scene, &given(scene, camera, film())).image)
}

#[test]
fn no_careful_renderer_is_accused() {
    let mut random = fastrand::Rng::with_seed(9);
    let mut scenes = vec![
        with_cones(1, 1.0, [0.3, 1.0], [0.05, 0.2]),
        with_cones(2, 1e6, [0.5, 2.0], [1e-4, 0.02]),
        with_cones(3, 1e-6, [1e-4, 0.1], [0.1, 0.4]),
    ];
    let plain = scenes.len();
    scenes.extend((0..12).map(|_| cones::hostile(&mut random).0));
    let mut hits = 0;
    for (number, scene) in scenes.iter().enumerate() {
        for camera in cameras(scene).into_iter().take(3) {
            let view = View::new(camera.as_ref(), film());
            let by_reference = Layers::by_reference(scene, &view);
            hits += by_reference.ids.iter().filter(|id| **id != NO_ID && **id >= scene.len() as u32).count();
            // The reference rounds only its answers, a careful renderer each step, and the last one as badly as is legal.
            for (made, most) in [
                (by_reference, 2.0),
                (by_device(scene, camera.as_ref(), Habit::Nearest), 10.0),
                (by_device(scene, camera.as_ref(), Habit::Random), 48.0),
            ] {
                let found = judged(scene, view, &made);
                assert!(found.largest() <= most, "{number}, {}: {found}", camera.kind().name());
                assert_ne!(found.outcome(), Outcome::Violated, "{number}");
                // From far away, flat cones are thinner than their move.
                assert!(number >= plain || found.decided_fraction() > 0.7, "{number}: {found}");
            }
        }
    }
    assert!(hits > 2000, "{hits}");
}

/// A cone that stands on its larger end, seen from a little above.
fn stump(caps: Caps) -> (Scene, OrthographicCamera) {
    let cone = Cone::new([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.8, 0.4]).with_caps(caps);
    let pose = Pose::looking_at([0.0, 2.0, 4.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    (scene_of(&[cone]), OrthographicCamera::new(pose, [1.5, 1.2]).unwrap())
}

#[test]
fn planted_faults_are_found() {
    let (scene, camera) = stump(Caps::Both);
    let view = View::new(&camera, film());
    let right = Layers::by_reference(&scene, &view);
    let found = judged(&scene, view, &right);
    assert_eq!(found.outcome(), Outcome::Proved, "{found}");
    let hits: Vec<usize> = (0..right.ids.len()).filter(|pixel| right.ids[*pixel] != NO_ID).collect();
    let is_cap = |pixel: usize| right.normals[pixel][1] > 0.99;
    assert!(hits.iter().any(|pixel| is_cap(*pixel)) && hits.iter().any(|pixel| !is_cap(*pixel)));
    let violated = |change: &dyn Fn(&mut Layers, usize)| {
        let mut made = right.clone();
        hits.iter().for_each(|pixel| change(&mut made, *pixel));
        judged(&scene, view, &made).count(Outcome::Violated)
    };
    let turned = |normal: [f64; 3], by: f64| (DVec3::from(normal) + by * DVec3::X).normalize_or_zero().to_array();
    let discs = hits.iter().filter(|pixel| is_cap(**pixel)).count();
    // Near silhouettes, a change of depth hardly leaves the surface.
    assert!(violated(&|made, pixel| made.depths[pixel] *= 1.0 + 1e-4) > hits.len() - 10);
    assert_eq!(violated(&|made, pixel| made.normals[pixel] = [0.0, 1.0, 0.0]), hits.len() - discs, "that of the axis");
    assert_eq!(violated(&|made, pixel| made.normals[pixel] = made.normals[pixel].map(|c| -c)), hits.len());
    assert_eq!(violated(&|made, pixel| made.normals[pixel] = turned(made.normals[pixel], 1e-3)), hits.len());
    assert_eq!(violated(&|made, pixel| made.ids[pixel] = NO_ID), hits.len(), "a cell missed");
    let lost = |made: &mut Layers, pixel: usize| {
        if is_cap(pixel) {
            made.ids[pixel] = NO_ID;
        }
    };
    assert_eq!(violated(&lost), discs, "a lost disc");
    // The radius of the other end, a little more of the radius, and ends that are not closed or round.
    for wrong in [
        Cone::new([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.4, 0.8]),
        Cone::new([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.8, 0.401]),
        Cone::new([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.8, 0.4]).with_caps(Caps::First),
    ] {
        let made = Layers::by_reference(&scene_of(&[wrong]), &view);
        let found = judged(&scene, view, &made);
        assert!(found.count(Outcome::Violated) >= discs, "{found}");
        assert!(found.to_string().contains("cone 0") || found.worst[0].id == NO_ID, "{found}");
    }
}

/// An answer on a disc that is not there, and the inside that is seen instead.
#[test]
fn open_ends_show_the_inside() {
    let (scene, camera) = stump(Caps::First);
    let view = View::new(&camera, film());
    let right = Layers::by_reference(&scene, &view);
    let found = judged(&scene, view, &right);
    assert_eq!(found.outcome(), Outcome::Proved, "{found}");
    let (closed, _) = stump(Caps::Both);
    let made = Layers::by_reference(&closed, &view);
    let differ = (0..made.ids.len()).filter(|pixel| made.depths[*pixel] != right.depths[*pixel]).count();
    let found = judged(&scene, view, &made);
    assert!(differ > 20 && found.count(Outcome::Violated) == differ, "{differ} {found}");
}

/// A shape behind another, a cone that is not hit, and cones beside spheres.
#[test]
fn hidden_shapes_are_found() {
    let front = Cone::cylinder([-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], 0.5);
    let behind = Cone::cylinder([-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], 0.8);
    let ball = SphereArray::F32(vec![[0.0, 0.0, 3.0, 0.2]]);
    let scene = Scene::from_shapes(ball, &[front, behind], LinearRgb::WHITE.into()).unwrap();
    let pose = Pose::looking_at([0.0, 0.0, 8.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::with_vertical_fov(pose, 0.5, 1.2).unwrap();
    let view = View::new(&camera, film());
    let right = Layers::by_reference(&scene, &view);
    assert_eq!(judged(&scene, view, &right).outcome(), Outcome::Proved);
    for id in 0..3 {
        assert!(right.ids.contains(&id), "{id}");
    }
    let without = [vec![front, behind], vec![behind]].map(|cones| {
        let nothing = SphereArray::F32(Vec::new());
        Layers::by_reference(&Scene::from_shapes(nothing, &cones, LinearRgb::WHITE.into()).unwrap(), &view)
    });
    for (made, shift, hidden) in [(&without[0], 1, 0), (&without[1], 2, 1)] {
        let ids = made.ids.iter().map(|id| if *id == NO_ID { NO_ID } else { id + shift }).collect();
        let found = judged(&scene, view, &Layers { ids, ..made.clone() });
        assert_eq!(found.worst[0].reason, Reason::Hidden(hidden), "{found}");
    }
    let message = judged(&scene, view, &Layers { ids: vec![NO_ID; right.ids.len()], ..right }).to_string();
    assert!(message.contains("sphere 0 is hit") || message.contains("cone "), "{message}");
}
