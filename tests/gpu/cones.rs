//! Pictures of cones and cylinders.

use libtest_mimic::Trial;
use pinhole::accel::{AccelChoice, AccelPlan};
use pinhole::camera::{Camera, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose};
use pinhole::gpu::{Headless, Wait};
use pinhole::image::NO_ID;
use pinhole::render::Studio;
use pinhole::verify::{Outcome, Verdict};
use pinhole::{Film, Image, Integrator, LayerSet, RenderSettings, Scene, View, cpu};

use crate::support::cones::{crowded, hostile, mixed};
use crate::support::effort::share;
use crate::trial;
use crate::verify::judged_by_rays;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("cones::pictures_agree_with_the_reference", agree),
        trial("cones::lists_and_trees_agree", structures),
        trial("cones::pictures_are_proved", proved),
        trial("cones::hostile_scenes_are_proved", hostile_scenes),
        trial("cones::smooth_pictures_agree_with_the_reference", smooth),
    ]
}

fn cameras() -> Vec<Box<dyn Camera>> {
    let pose = |eye| Pose::looking_at(eye, [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    let pinhole = |eye| PinholeCamera::with_vertical_fov(pose(eye), 0.8, 1.0).unwrap();
    vec![
        Box::new(pinhole([1.0, 2.0, 3.0])),
        Box::new(pinhole([0.1, 0.0, 0.2])),
        Box::new(OrthographicCamera::new(pose([4.0, 1.0, 0.5]), [1.3, 1.3]).unwrap()),
        Box::new(FisheyeCamera::new(pose([0.0, 0.3, 2.0]), 2.5, 1.0).unwrap()),
    ]
}

/// A picture by a structure, in bricks whose buffers have at most this size.
fn picture(headless: &Headless, scene: &Scene, view: &View<'_>, choice: AccelChoice, bytes: u64) -> Image {
    let settings = RenderSettings::default();
    let plan = AccelPlan::new(scene.spheres(), choice, bytes).with_cones(scene.cones(), bytes);
    let accel = plan.bricks(scene.spheres()).with_cones(scene.cones()).build();
    let buffers = headless.upload(scene, &accel.into()).wait().unwrap();
    headless
        .render_uploaded(&buffers, view, &settings, LayerSet::ALL, &mut super::pictures::go_on)
        .wait()
        .unwrap()
        .image
}

/// At almost all pixels, a device finds what the reference does.
fn agree(headless: &'static Headless) {
    let film = Film::new(160, 160).unwrap();
    for (spheres, cones, size) in [(200, 400, 0.2), (0, 300, 0.3), (40, 5, 0.5), (0, 1, 1.0), (3000, 2000, 0.05)] {
        let scene = mixed(spheres, cones, size, 7);
        let structure = cpu::SearchStructure::new(&scene).unwrap();
        let (mut hits, mut others) = (0, 0);
        for camera in cameras() {
            let view = View::new(camera.as_ref(), film);
            let image = headless.render(&scene, &view, &RenderSettings::default(), LayerSet::ALL).wait().unwrap();
            let (ids, depths, normals) = (image.id().unwrap(), image.depth().unwrap(), image.normal().unwrap());
            for (at, id) in ids.iter().enumerate() {
                let pixel = [at as u32 % film.width(), at as u32 / film.width()];
                let hit = view.ray_through_center(pixel).and_then(|ray| cpu::trace(&structure, &ray));
                if hit.map_or(NO_ID, |hit| hit.id) != *id {
                    others += 1;
                    continue;
                }
                let Some(hit) = hit else { continue };
                hits += u32::from(hit.id as usize >= spheres);
                let is_near = (f64::from(depths[at]) - hit.t).abs() < 1e-4 * hit.t
                    && hit.normal.distance(normals[at].map(f64::from).into()) < 2e-3;
                others += u32::from(!is_near);
            }
        }
        assert!(hits > 1000, "{spheres} spheres, {cones} cones: {hits}");
        assert!(others * 500 < film.pixel_count() as u32 * 4, "{spheres} spheres, {cones} cones: {others}");
    }
}

/// The checker accuses no picture, and leaves few answers open.
fn proved(headless: &'static Headless) {
    let settings = RenderSettings::default();
    let (mut open, mut all) = (0, 0);
    for (spheres, cones, size) in [(200, 400, 0.2), (0, 300, 0.3), (3000, 2000, 0.05), (1, 1, 0.6)] {
        let scene = mixed(spheres, cones, size, 11);
        for camera in cameras() {
            let view = View::new(camera.as_ref(), Film::new(128, 128).unwrap());
            let certificate = headless.verify(&scene, &view, &settings).wait().unwrap();
            assert!(certificate.outcome() != Outcome::Violated, "{spheres} spheres, {cones} cones: {certificate}");
            open += certificate.undecided();
            all += certificate.verdicts.len();
            // Also by exact rays, like the answers of any renderer.
            let image = headless.render(&scene, &view, &settings, LayerSet::DATA).wait().unwrap();
            let found = judged_by_rays(&scene, view, &image);
            assert!(found.outcome() != Outcome::Violated, "{spheres} spheres, {cones} cones: {found}");
        }
    }
    assert!(open * 200 < all, "{open} of {all} are open");
}

/// The number of hostile scenes, if all of the campaign runs.
const HOSTILE: u64 = 2000;

/// The checker accuses no picture of scenes with everything that is hard, from all cameras, also from inside shapes and along
/// axes, and leaves few answers open. All structures find the same.
fn hostile_scenes(headless: &'static Headless) {
    let settings = RenderSettings::default();
    let film = Film::new(40, 40).unwrap();
    let (mut silhouettes, mut ties, mut all) = (0, 0, 0);
    for seed in share(0..HOSTILE) {
        let mut random = fastrand::Rng::with_seed(seed);
        let (scene, middle, size) = hostile(&mut random);
        let mut eye =
            [0, 1, 2].map(|axis| middle[axis] + size * (random.f64() - 0.5) * [1.0, 8.0, 24.0][seed as usize % 3]);
        let mut target = middle;
        if random.bool() {
            // Along an axis, through places of the grid.
            (eye, target) = (middle.map(|x| x + 0.25 * size), middle.map(|x| x + 0.25 * size));
            eye[random.usize(..3)] += 9.0 * size;
        }
        let pose = Pose::looking_at(eye, target, [0.1, 0.9, 0.3]).unwrap();
        let camera: Box<dyn Camera> = match seed / 3 % 4 {
            0 => Box::new(PinholeCamera::with_vertical_fov(pose, 0.8, 1.0).unwrap()),
            1 => Box::new(OrthographicCamera::new(pose, [4.0 * size; 2]).unwrap()),
            2 => Box::new(FisheyeCamera::new(pose, 2.5, 1.0).unwrap()),
            _ => Box::new(PanoramaCamera::new(pose)),
        };
        let view = View::new(camera.as_ref(), film);
        let certificate = headless.verify(&scene, &view, &settings).wait().unwrap();
        assert!(certificate.outcome() != Outcome::Violated, "seed {seed}: {certificate}");
        let image = headless.render(&scene, &view, &settings, LayerSet::DATA).wait().unwrap();
        let found = judged_by_rays(&scene, view, &image);
        assert!(found.outcome() != Outcome::Violated, "seed {seed}: {found}");
        let [list, tree, grid] = [AccelChoice::List, AccelChoice::Tree, AccelChoice::Grid]
            .map(|choice| picture(headless, &scene, &view, choice, 1 << 27));
        assert!(list.id() == tree.id() && list.depth() == tree.depth(), "seed {seed}: list and tree");
        assert!(list.id() == grid.id() && list.depth() == grid.depth(), "seed {seed}: list and grid");
        let count = |verdict: Verdict| certificate.verdicts.iter().filter(|found| **found == verdict).count();
        silhouettes += count(Verdict::Silhouette);
        ties += count(Verdict::Tie);
        all += certificate.verdicts.len();
    }
    assert!(silhouettes * 1000 < all, "{silhouettes} of {all} may be misses as well");
    // Discs of several shapes are in one plane, so that any of them is legal.
    assert!(ties * 50 < all, "{ties} of {all} may be another shape");
}

/// Pictures by different structures are the same, to the bit, in one brick and in several.
fn structures(headless: &'static Headless) {
    for scene in [mixed(300, 600, 0.15, 8), crowded(8)] {
        for camera in cameras() {
            let view = View::new(camera.as_ref(), Film::new(96, 64).unwrap());
            let list = picture(headless, &scene, &view, AccelChoice::List, 1 << 27);
            for (choice, bytes) in [
                (AccelChoice::Tree, 1 << 27),
                (AccelChoice::Tree, 1 << 14),
                (AccelChoice::Grid, 1 << 27),
                (AccelChoice::Grid, 1 << 19),
                (AccelChoice::Auto, 1 << 27),
            ] {
                let other = picture(headless, &scene, &view, choice, bytes);
                assert!(list.id().unwrap() == other.id().unwrap(), "{choice}, {bytes} bytes");
                assert!(list.depth().unwrap() == other.depth().unwrap(), "{choice}, {bytes} bytes");
            }
        }
    }
}

/// Smooth pictures, whose ids are found by lists for tiles or by trees, are those of the reference.
fn smooth(headless: &'static Headless) {
    let studio = Studio { is_smooth: true, ..Studio::default() };
    let settings = RenderSettings { integrator: Integrator::Studio(studio), ..RenderSettings::default() };
    for (spheres, cones, size) in [(200, 400, 0.2), (0, 300, 0.3), (3000, 2000, 0.05), (3, 4, 0.6), (200, 1, 0.05)] {
        let scene = mixed(spheres, cones, size, 9);
        let structure = cpu::SearchStructure::new(&scene).unwrap();
        for camera in cameras() {
            let view = View::new(camera.as_ref(), Film::new(96, 80).unwrap());
            assert!(settings.is_smooth(&scene, camera.as_ref()));
            let found = headless.render(&scene, &view, &settings, LayerSet::ALL).wait().unwrap();
            let wanted = cpu::render(&structure, &view, &settings, LayerSet::ALL).unwrap();
            let differ = found
                .color()
                .iter()
                .zip(wanted.color())
                .filter(|(a, b)| a.map(f32::to_bits) != b.map(f32::to_bits))
                .count();
            assert!(differ * 300 < found.color().len(), "{spheres} spheres, {cones} cones: {differ}");
        }
    }
}
