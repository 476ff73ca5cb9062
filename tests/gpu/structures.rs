//! Every structure gives the picture that trying every sphere gives: the same spheres at the same distances, to
//! the bit, in one brick or in several.
//!
//! How a picture is cut into slices follows the clock, and no option says otherwise. But slices begin small
//! and grow by what they took, so that two renders of a large film are rarely cut alike; `slices` compares
//! some.

use std::ops::ControlFlow;
use std::sync::LazyLock;

use fastrand::Rng;
use libtest_mimic::Trial;
use pinhole::accel::{Accel, AccelChoice, AccelPlan, ListLayout, Structure};
use pinhole::camera::{Camera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::gpu::{Headless, HeadlessOptions, LimitChoice, Query};
use pinhole::{Film, Image, LayerSet, LinearRgb, Scene, Settings, glam};

use crate::headless;
use crate::support::spheres::{self, Spheres};
use crate::trial;

/// Bytes of a binding, for one brick and for several.
const ROOMY: u64 = 1 << 27;
const TINY: u64 = 16 * 600;
const TINY_FOR_GRIDS: u64 = (1 << 20) + 68 * 600;

/// A device with WebGPU's limits.
static WEBGPU: LazyLock<Headless> = LazyLock::new(|| {
    let options = HeadlessOptions { limits: LimitChoice::WebGpu, ..HeadlessOptions::default() };
    Headless::open(&options).unwrap()
});

type Named = (&'static str, fn() -> Spheres);

fn all_scenes() -> Vec<Named> {
    vec![
        ("three", || spheres::random(3, 1, |_| 0.3)),
        ("random", || spheres::random(2_000, 2, |_| 0.02)),
        ("four_decades", || spheres::four_decades(1_000)),
        ("equal", || vec![[1.0, 2.0, 3.0, 0.5]; 300]),
        ("twice", || spheres::twice(700)),
        ("line", || spheres::line(800)),
        ("nested", || spheres::nested(200)),
        ("lattice", || spheres::lattice(14)),
        ("one_around_all", || spheres::one_around_all(1_500)),
        ("clusters", || spheres::clusters(10, 200)),
        ("crowd", || spheres::crowd(1_500)),
        ("far", || {
            // Spheres too small to be seen, and some that are not.
            let mut spheres = spheres::far(800);
            spheres.extend(spheres::scaled(&spheres::random(200, 24, |_| 0.03), 1e7));
            spheres
        }),
        ("flat", || spheres::flat(1_500)),
        ("outlier", || spheres::outlier(1_500)),
        ("times_2_to_the_50", || spheres::scaled(&spheres::four_decades(500), 2_f32.powi(50))),
        ("times_2_to_the_minus_50", || {
            // A scene's radii are not below 2⁻⁵⁶.
            spheres::scaled(&spheres::random(500, 25, |_| 0.03), 2_f32.powi(-50))
        }),
    ]
}

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials: Vec<Trial> = all_scenes()
        .into_iter()
        .map(|(name, make)| {
            Trial::test(format!("structures::{name}"), move || {
                check(headless()?, make());
                Ok(())
            })
        })
        .collect();
    trials.push(trial("structures::a_million_coincident_centres", coincident));
    trials.push(trial("structures::slices_do_not_show", slices));
    trials.push(trial("structures::whether_there_is_any_is_answered_in_time", any));
    trials
}

/// Every structure but the list, in one brick and in several.
fn all(spheres: &[[f32; 4]]) -> Vec<Accel> {
    let mut all = Vec::new();
    for choice in [AccelChoice::Grid, AccelChoice::Tree, AccelChoice::BinaryTree, AccelChoice::List]
    {
        let tiny = if choice == AccelChoice::Grid { TINY_FOR_GRIDS } else { TINY };
        for binding_bytes in [ROOMY, tiny] {
            let mut plan = AccelPlan::new(spheres, choice, binding_bytes);
            all.push(plan.build(spheres));
            if choice == AccelChoice::Grid {
                plan.structure = Structure::Grid(ListLayout::Referenced);
                all.push(plan.build(spheres));
            }
        }
    }
    all
}

/// From the front, from within, and in parallel along an axis, with odd films.
fn views(scene: &Scene) -> Vec<(Box<dyn Camera>, Film)> {
    let bounds = scene.bounds_to_frame();
    let (center, size) = (bounds.center(), bounds.size().max_element());
    let from_front = PinholeCamera::framing_from_the_front(&bounds, 1.5).unwrap();
    let pose = Pose::looking_along(center, [0.3, -0.4, 0.8], [0.0, 1.0, 0.1]).unwrap();
    let from_within = PinholeCamera::with_vertical_fov(pose, 1.9, 1.0).unwrap();
    let eye = center + glam::DVec3::X * size;
    let pose = Pose::looking_along(eye, [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
    let parallel = OrthographicCamera::new(pose, [size * 1.1, size * 1.1]).unwrap();
    vec![
        (Box::new(from_front), Film::new(101, 67).unwrap()),
        (Box::new(from_within), Film::new(45, 83).unwrap()),
        (Box::new(parallel), Film::new(64, 33).unwrap()),
    ]
}

fn render(headless: &Headless, scene: &Scene, accel: &Accel) -> Vec<Image> {
    let buffers = headless.upload(scene, accel).unwrap();
    let settings = Settings::default();
    let go_on = &mut |_| ControlFlow::Continue(());
    let render = |(camera, film): &(Box<dyn Camera>, Film), go_on: &mut _| {
        headless
            .render_uploaded(&buffers, camera.as_ref(), film, &settings, LayerSet::ALL, go_on)
            .unwrap()
    };
    views(scene).iter().map(|view| render(view, go_on)).collect()
}

/// Distances and ids are the same, to the bit.
fn assert_same(name: &str, found: &[Image], expected: &[Image]) {
    for (view, (found, expected)) in found.iter().zip(expected).enumerate() {
        let pixels = |image: &Image| -> Vec<(u32, u32)> {
            let depths = image.depth().unwrap().iter().map(|depth| depth.to_bits());
            image.id().unwrap().iter().copied().zip(depths).collect()
        };
        let (found, expected) = (pixels(found), pixels(expected));
        let wrong: Vec<usize> = (0..found.len()).filter(|i| found[*i] != expected[*i]).collect();
        if let Some(first) = wrong.first() {
            let (found, expected, count) = (found[*first], expected[*first], wrong.len());
            panic!("{name}, view {view}: {count} pixels; {first} is {found:?}, not {expected:?}");
        }
    }
}

fn check(headless: &Headless, spheres: Spheres) {
    let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
    let list = AccelPlan::new(scene.spheres(), AccelChoice::List, ROOMY).build(scene.spheres());
    let expected = render(headless, &scene, &list);
    let is_hit = |image: &Image| image.id().unwrap().iter().any(|id| *id != u32::MAX);
    assert!(expected.iter().any(is_hit), "nothing is seen");
    for accel in all(scene.spheres()) {
        let name = format!("{} in {}", accel.structure().name(), accel.bricks().len());
        assert_same(&name, &render(headless, &scene, &accel), &expected);
        if accel.bricks().len() > 1 {
            let name = format!("{name}, with the limits of WebGPU");
            assert_same(&name, &render(&WEBGPU, &scene, &accel), &expected);
        }
    }
}

/// The grid keeps of a million the one that counts, which is the first.
fn coincident(headless: &'static Headless) {
    let million = vec![[0.5, 0.25, 0.0, 1.0]; 1_000_000];
    let few = Scene::from_f32(million[..100].to_vec(), LinearRgb::WHITE).unwrap();
    let scene = Scene::from_f32(million, LinearRgb::WHITE).unwrap();
    let list = AccelPlan::new(few.spheres(), AccelChoice::List, ROOMY).build(few.spheres());
    let grid = AccelPlan::new(scene.spheres(), AccelChoice::Grid, ROOMY).build(scene.spheres());
    assert_same("grid", &render(headless, &scene, &grid), &render(headless, &few, &list));
}

fn slices(headless: &'static Headless) {
    let scene = Scene::from_f32(spheres::clusters(10, 200), LinearRgb::WHITE).unwrap();
    let bounds = scene.bounds_to_frame();
    let camera = PinholeCamera::framing_from_the_front(&bounds, 1.0).unwrap();
    let film = Film::new(1003, 997).unwrap();
    let mut rng = Rng::with_seed(1);
    let mut first = None;
    for choice in [AccelChoice::Grid, AccelChoice::Tree, AccelChoice::List, AccelChoice::Grid] {
        let accel = headless.plan(&scene, choice).build(scene.spheres());
        let buffers = headless.upload(&scene, &accel).unwrap();
        let settings = Settings::default();
        let mut told = Vec::new();
        let watch = &mut |progress: pinhole::gpu::Progress| {
            // Between slices, so that it changes nothing.
            std::thread::sleep(std::time::Duration::from_micros(rng.u64(0..300)));
            told.push((progress.done, progress.total));
            ControlFlow::Continue(())
        };
        let image = headless
            .render_uploaded(&buffers, &camera, &film, &settings, LayerSet::ALL, watch)
            .unwrap();
        assert!(told.is_sorted() && told.iter().all(|(done, total)| done <= total), "{told:?}");
        let expected = first.get_or_insert_with(|| image.clone());
        assert_same(&choice.to_string(), &[image], std::slice::from_ref(expected));
    }
}

/// What the second kind of query answers cannot be read back: `measure` throws it away. That it ends, for every
/// structure, can be seen; what it answers, `tests/cpu/structures.rs` checks of its twin.
fn any(headless: &'static Headless) {
    let scene = Scene::from_f32(spheres::clusters(10, 200), LinearRgb::WHITE).unwrap();
    let bounds = scene.bounds_to_frame();
    let camera = PinholeCamera::framing_from_the_front(&bounds, 1.0).unwrap();
    let film = Film::new(61, 43).unwrap();
    for accel in all(scene.spheres()) {
        let buffers = headless.upload(&scene, &accel).unwrap();
        headless.measure(&buffers, &camera, &film, Query::Any).unwrap();
    }
}
