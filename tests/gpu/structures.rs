//! Tests that every structure gives the same picture as testing all spheres: the same spheres at the same distances, to
//! the bit, in one brick or in several.
//!
//! The division of a picture into slices depends on the clock, and no option fixes it. But slices are small
//! at first and adapt to the measured times, so two renders of a large film are rarely divided in the same
//! way. The test `slices` compares some.

use std::sync::LazyLock;

use fastrand::Rng;
use libtest_mimic::Trial;
use pinhole::accel::{Accel, AccelChoice, AccelPlan, Brick, Structure};
use pinhole::camera::{Camera, FisheyeCamera, OrthographicCamera, PinholeCamera, Pose};
use pinhole::gpu::{
    ColorTarget, Decision, GpuError, Headless, HeadlessOptions, LimitChoice, PictureRequest, RendererOptions,
    SceneBuffers, Wait, wgpu,
};
use pinhole::image::NO_ID;
use pinhole::internals::{NO_HIT, ShaderEdit};
use pinhole::{Film, Image, LayerSet, LinearRgb, RenderSettings, Scene, glam};

use crate::embedding::size_of_film;
use crate::headless;
use crate::host_program::{Drawing, Host};
use crate::planted::faulty;
use crate::support::View;
use crate::support::compare::{Picture, compare};
use crate::support::spheres::{self, Spheres};
use crate::trial;

/// Maximum sizes of a binding in bytes, for one brick and for several bricks.
const ROOMY: u64 = 1 << 27;
const TINY: u64 = 16 * 600;
const TINY_FOR_BALLS: u64 = (1 << 20) + 68 * 600;

/// Opens a device with the limits of WebGPU.
static WEBGPU: LazyLock<Headless> = LazyLock::new(|| {
    let options = HeadlessOptions { limits: LimitChoice::WebGpu, ..HeadlessOptions::default() };
    Headless::open(&options).wait().unwrap()
});

type NamedSpheres = (&'static str, fn() -> Spheres);

fn all_scenes() -> Vec<NamedSpheres> {
    vec![
        ("three", || spheres::random(3, 1, |_| 0.3)),
        ("random", || spheres::random(2_000, 2, |_| 0.02)),
        ("four_decades", || spheres::four_decades(1_000)),
        ("equal", || vec![[1.0, 2.0, 3.0, 0.5]; 300]),
        ("twice", || spheres::twice(700)),
        ("mirrored", || spheres::mirrored(1_000)),
        ("line", || spheres::line(800)),
        ("nested", || spheres::nested(200)),
        ("lattice", || spheres::lattice(14)),
        ("one_around_all", || spheres::one_around_all(1_500)),
        ("clusters", || spheres::clusters(10, 200)),
        ("crowd", || spheres::crowd(1_500)),
        ("far", || {
            // Some spheres are too small to be visible, and others are not.
            let mut spheres = spheres::far(800);
            spheres.extend(spheres::scaled(&spheres::random(200, 24, |_| 0.03), 1e7));
            spheres
        }),
        ("flat", || spheres::flat(1_500)),
        ("distant_sheet", || spheres::distant_sheet(6_000)),
        ("outlier", || spheres::outlier(1_500)),
        ("times_2_to_the_50", || spheres::scaled(&spheres::four_decades(500), 2_f32.powi(50))),
        ("times_2_to_the_minus_50", || {
            // The radii of a scene must not be less than 2⁻⁵⁶.
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
    trials.push(trial("structures::lists_of_tiles_in_slabs", slabs));
    trials.push(trial("structures::too_many_lists_of_tiles", too_many_lists));
    trials.push(trial("structures::outliers_do_not_show", outliers));
    trials.push(trial("structures::rays_from_afar_need_wider_boxes", unwidened));
    trials.push(trial("structures::slices_do_not_show", slices));
    trials.push(trial("structures::whether_there_is_any_is_what_the_nearest_says", any));
    trials.push(trial("structures::a_list_of_several_slices", long_list));
    trials.push(trial("structures::too_many_steps_are_an_error_and_no_picture", too_many_steps));
    trials
}

/// All structures, in one brick and in several.
fn all(spheres: &[[f32; 4]]) -> Vec<Accel> {
    let kinds = [(Structure::Grid, TINY_FOR_BALLS), (Structure::WideTree, TINY), (Structure::List, TINY)];
    let build = |(structure, tiny)| [ROOMY, tiny].map(|bytes| AccelPlan::of(spheres, structure, bytes).build(spheres));
    kinds.into_iter().flat_map(build).collect()
}

fn view(scene: &Scene, camera: impl Camera + 'static, size: [u32; 2]) -> View {
    View {
        scene: scene.clone(),
        camera: Box::new(camera),
        film: Film::new(size[0], size[1]).unwrap(),
        settings: RenderSettings::default(),
    }
}

fn white(spheres: Spheres) -> Scene {
    Scene::from_f32(spheres, LinearRgb::WHITE).unwrap()
}

/// A structure in one brick.
fn built(scene: &Scene, choice: AccelChoice) -> Accel {
    AccelPlan::new(scene.spheres(), choice, ROOMY).build(scene.spheres())
}

/// Views from the front, from inside, of parallel rays along an axis, and of almost all directions from inside, with films
/// of odd sizes.
fn views(scene: &Scene) -> [View; 4] {
    let bounds = scene.bounds_to_frame();
    let (center, size) = (bounds.center(), bounds.size().max_element());
    let from_front = PinholeCamera::framing_from_the_front(bounds, 1.5).unwrap();
    let within = Pose::looking_along(center, [0.3, -0.4, 0.8], [0.0, 1.0, 0.1]).unwrap();
    let from_within = PinholeCamera::with_vertical_fov(within, 1.9, 1.0).unwrap();
    let eye = center + glam::DVec3::X * size;
    let pose = Pose::looking_along(eye, [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
    let parallel = OrthographicCamera::new(pose, [size * 1.1, size * 1.1]).unwrap();
    let fisheye = FisheyeCamera::new(within, 5.5, 1.25).unwrap();
    [
        view(scene, from_front, [101, 67]),
        view(scene, from_within, [45, 83]),
        view(scene, parallel, [64, 33]),
        view(scene, fisheye, [80, 64]),
    ]
}

fn render(headless: &Headless, views: &[View], accel: &Accel) -> Vec<Image> {
    views.iter().map(|view| view.traced(headless, accel).unwrap()).collect()
}

/// Asserts that distances and ids are the same, to the bit.
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
    let scene = white(spheres);
    let views = views(&scene);
    let expected = render(headless, &views, &built(&scene, AccelChoice::List));
    let is_hit = |image: &Image| image.id().unwrap().iter().any(|id| *id != u32::MAX);
    assert!(expected.iter().any(is_hit), "nothing is seen");
    for accel in all(scene.spheres()) {
        let name = format!("{} in {}", accel.structure().name(), accel.bricks().len());
        assert_same(&name, &render(headless, &views, &accel), &expected);
        if accel.bricks().len() > 1 {
            let name = format!("{name}, with the limits of WebGPU");
            assert_same(&name, &render(&WEBGPU, &views, &accel), &expected);
        }
    }
    if !scene.is_empty() {
        assert_same("tiles", &by_tiles(headless, &views), &expected);
    }
}

fn by_tiles(headless: &Headless, views: &[View]) -> Vec<Image> {
    let by_tiles = |view: &View| {
        let (scene, settings) = (&view.scene, &view.settings);
        let request =
            PictureRequest { is_only: true, ..PictureRequest::new(scene, &view.seen(), settings, LayerSet::ALL) };
        let plan = headless.plan(&request, AccelChoice::Tiles);
        assert_eq!(plan.structure(), Structure::Tiles);
        headless
            .render_planned(&request, &plan, &mut |_| Decision::GoOn, &mut |_| Decision::GoOn)
            .wait()
            .map(|picture| picture.image)
    };
    views.iter().map(|view| by_tiles(view).unwrap()).collect()
}

/// So many spheres that lists are made in slabs of depth, and so many in one place that a slab needs several bricks, which
/// are not all shaded together.
fn slabs(headless: &'static Headless) {
    let mut heap = spheres::random(1_000, 5, |_| 0.02);
    heap.extend(vec![[0.1, 0.1, 0.1, 0.2]; 100_000]);
    for spheres in [spheres::random(300_000, 4, |rng| if rng.u32(..1000) == 0 { 0.05 } else { 0.004 }), heap] {
        let scene = white(spheres);
        let views = views(&scene);
        let expected = render(headless, &views, &built(&scene, AccelChoice::Grid));
        assert_same("tiles", &by_tiles(headless, &views), &expected);
    }
}

/// Where a picture needs too many lists, another structure is chosen.
fn too_many_lists(headless: &'static Headless) {
    let scene = white(vec![[1.0, 2.0, 3.0, 0.5]; 250_000]);
    let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.0).unwrap();
    let view = view(&scene, camera, [24, 24]);
    let request =
        PictureRequest { is_only: true, ..PictureRequest::new(&scene, &view.seen(), &view.settings, LayerSet::DATA) };
    let plan = headless.plan(&request, AccelChoice::Auto);
    assert_eq!(plan.structure(), Structure::Tiles);
    let picture = headless.render_planned(&request, &plan, &mut |_| Decision::GoOn, &mut |_| Decision::GoOn).wait();
    assert!(matches!(picture, Err(GpuError::Steps)), "{picture:?}");
    assert_eq!(plan.instead(), Some(AccelChoice::Grid));
    let image = headless.render(&scene, &view.seen(), &view.settings, LayerSet::DATA).wait().unwrap();
    assert!(image.id().unwrap().contains(&0));
}

/// A crowd beside an outlier, seen from near and from the outlier's side.
fn outliers(headless: &'static Headless) {
    let scene = white(spheres::crowd_and_outliers(3_000, 3, 1e4, false));
    let plan = AccelPlan::new(scene.spheres(), AccelChoice::Auto, ROOMY);
    assert_eq!(plan.crowd.map(|crowd| crowd.outliers), Some(3));
    for (eye, fov) in [([0.5, 0.6, -1.2], 0.7), ([7e3, 0.4, 5e3], 2e-4)] {
        let pose = Pose::looking_at(eye, [0.5, 0.5, 0.5], [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, fov, 1.5).unwrap();
        let views = [view(&scene, camera, [101, 67])];
        let expected = render(headless, &views, &built(&scene, AccelChoice::List));
        let ids = expected[0].id().unwrap();
        assert!(ids.iter().filter(|id| **id != u32::MAX).count() > 500, "little is seen");
        for accel in all(scene.spheres()) {
            assert_same(accel.structure().name(), &render(headless, &views, &accel), &expected);
        }
        assert_same("tiles", &by_tiles(headless, &views), &expected);
    }
}

/// A tree loses spheres if its boxes are not widened for rays that start far from the crowd.
fn unwidened(headless: &'static Headless) {
    let scene = white(spheres::crowd_and_outliers(3_000, 3, 1e5, false));
    let widening = "max(0x1p-17 * farthest - brick.crowd_margin, 0.0)";
    let faulty = faulty("accel/wide_tree.wgsl", widening, "0.0 * farthest").unwrap();
    let tree = built(&scene, AccelChoice::Tree);
    let pose = Pose::looking_at([7e4, 0.4, 5e4], [0.5, 0.5, 0.5], [0.0, 1.0, 0.0]).unwrap();
    let camera = PinholeCamera::with_vertical_fov(pose, 2e-5, 1.25).unwrap();
    let view = view(&scene, camera, [1000, 800]);
    let [right, wrong] = [headless, &faulty].map(|device| view.traced(device, &tree).unwrap());
    let pairs = right.id().unwrap().iter().zip(wrong.id().unwrap());
    let lost = pairs.filter(|(right, wrong)| right != wrong).count();
    assert!(lost > 0, "no pixel shows the fault");
}

fn slices(headless: &'static Headless) {
    let scene = white(spheres::clusters(10, 200));
    let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.0).unwrap();
    let view = view(&scene, camera, [1103, 997]);
    let mut rng = Rng::with_seed(1);
    let mut first = None;
    for choice in [AccelChoice::Grid, AccelChoice::Tree, AccelChoice::List, AccelChoice::Grid] {
        let buffers = view.uploaded(headless, choice);
        let mut told = Vec::new();
        let watch = &mut |progress: &pinhole::gpu::Progress| {
            // This runs between slices, so it must not change the picture.
            std::thread::sleep(std::time::Duration::from_micros(rng.u64(0..300)));
            told.push(progress.part);
            Decision::GoOn
        };
        let image = view.watched(headless, &buffers, LayerSet::ALL, watch).unwrap().image;
        assert!(told.is_sorted(), "{told:?}");
        // There are two tiles, and both are traced completely.
        assert!(told.len() >= 2 && told.last() == Some(&1.0), "{told:?}");
        let expected = first.get_or_insert_with(|| image.clone());
        assert_same(&choice.to_string(), &[image], std::slice::from_ref(expected));
    }
}

/// For every structure, in one brick and in several, the search for any hit reports a hit exactly where the picture of
/// the list has a sphere. This picture agrees with the reference.
fn any(headless: &'static Headless) {
    let host = Host::new();
    let mut met = Vec::new();
    for spheres in [spheres::random(2_000, 2, |_| 0.02), spheres::clusters(10, 200)] {
        let scene = white(spheres);
        let structures = all(scene.spheres());
        let mut answers = Vec::new();
        for view in views(&scene) {
            let nearest = view.traced(headless, &built(&scene, AccelChoice::List)).unwrap();
            let hits: Vec<bool> = nearest.id().unwrap().iter().map(|id| *id != NO_ID).collect();
            answers.extend(&hits);
            assert_is_reference(&view, &nearest);
            for accel in &structures {
                let found = any_hits(&host, &view, accel);
                let wrong = (0..hits.len()).filter(|i| found[*i] != hits[*i]).count();
                let (name, bricks) = (accel.structure().name(), accel.bricks().len());
                assert_eq!(wrong, 0, "{name} in {bricks}: pixels that are wrong");
            }
        }
        assert!(answers.contains(&true) && answers.contains(&false), "nothing to tell apart");
        met.extend(structures.iter().map(Accel::structure));
    }
    assert!(Structure::ALL.iter().all(|structure| met.contains(structure)), "{met:?}");
}

/// The statement of `trace` that runs once for each brick: it finds the nearest sphere.
const NEAREST: &str = "    store_hit(index, nearest_hit(entry, no_exclusion(), hit_before(index)));\n";

/// The statement that replaces it: it looks for any sphere, and records a hit as distance 0 without an id.
const ANY: &str = "
    let is_known = hit_before(index).t < NO_HIT;
    var t = select(NO_HIT, 0.0, is_known);
    if (entry.is_inside && !is_known && find_any(Search(entry.ray, entry.inverse, no_exclusion()), NO_HIT)) {
        t = 0.0;
    }
    store_hit(index, Hit(t, NO_ID, 0u, 0.0));
";

/// For each pixel, whether its ray hits a sphere: the depth layer then has no miss.
fn any_hits(host: &Host, view: &View, accel: &Accel) -> Vec<bool> {
    let View { scene, camera, film, settings } = view;
    let options = RendererOptions {
        color: ColorTarget::Linear32,
        data_layers: true,
        cameras: vec![camera.kind()],
        structures: vec![accel.structure()],
        several_bricks: accel.bricks().len() > 1,
        edits: vec![ShaderEdit {
            file: "primary/trace.wgsl".to_owned(),
            find: NEAREST.to_owned(),
            replace: ANY.to_owned(),
        }],
        ..RendererOptions::default()
    };
    let mut drawing = Drawing::new(host, &options, size_of_film(film));
    let Host { device, queue } = host;
    let scene = SceneBuffers::with_accel(&drawing.renderer, device, queue, scene, accel).wait().unwrap();
    let encoder = drawing.record(host, &scene, &view.seen(), settings);
    let depths: Vec<f32> = host.submit_and_read(encoder, &drawing.layers.depth);
    let is_hit = |depth: &f32| match depth.to_bits() {
        0 => true,
        bits if bits == NO_HIT.to_bits() => false,
        _ => panic!("the answer {depth}"),
    };
    depths.iter().map(is_hit).collect()
}

fn assert_is_reference(view: &View, image: &Image) {
    let comparison = compare(view, &Picture::from(&view.reference()), &Picture::from(image));
    let Some(first) = comparison.violations.first() else { return };
    panic!("{} violations, the first is {first:?}", comparison.violations.len());
}

/// The list has more spheres than one dispatch tests, with nearest spheres in each of its bricks.
fn long_list(headless: &'static Headless) {
    let scene = white(spheres::random(120_000, 26, |_| 0.005));
    let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.5).unwrap();
    let view = view(&scene, camera, [24, 16]);
    let [list, grid] =
        [AccelChoice::List, AccelChoice::Grid].map(|choice| headless.plan_accel(&scene, choice).build(scene.spheres()));
    assert_eq!((list.structure(), list.bricks().len()), (Structure::List, 3));
    let found = view.traced(headless, &list).unwrap();
    let seen = |brick: &Brick| {
        let ids = brick.ids[0]..=brick.ids[brick.ids.len() - 1];
        found.id().unwrap().iter().any(|id| ids.contains(id))
    };
    assert!(list.bricks().iter().all(seen), "a slice without a nearest sphere");
    let expected = view.traced(headless, &grid).unwrap();
    assert_same("list", std::slice::from_ref(&found), &[expected]);
    assert_is_reference(&view, &found);
}

/// A ray must test 30,000 spheres that are in one cell, and in all nodes. This exceeds the iteration limit of a
/// software device. All other devices must render the same picture as the list.
fn too_many_steps(headless: &'static Headless) {
    let scene = white(spheres::nearly_coincident(30_000));
    let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.5).unwrap();
    let view = view(&scene, camera, [24, 16]);
    let list = headless.plan_accel(&scene, AccelChoice::List).build(scene.spheres());
    let expected = [view.traced(headless, &list).unwrap()];
    let is_software = headless.adapter_info().device_type == wgpu::DeviceType::Cpu;
    for accel in all(scene.spheres()).iter().filter(|accel| accel.bricks().len() == 1) {
        let name = accel.structure().name();
        let result = view.traced(headless, accel);
        if is_software && accel.structure() != Structure::List {
            assert_eq!(result.err(), Some(GpuError::Steps), "{name}");
        } else {
            assert_same(name, &[result.unwrap()], &expected);
        }
    }
    // With an automatic choice of the structure, the picture is rendered on every device.
    assert_same("auto", &[view.picture(headless, LayerSet::ALL)], &expected);
}
