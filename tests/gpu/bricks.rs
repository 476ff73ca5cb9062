//! Tests that scenes in several bricks have the pictures of one brick, to the bit, wherever the bricks are seen.

use libtest_mimic::Trial;
use pinhole::accel::{Accel, AccelChoice, AccelPlan};
use pinhole::camera::{Camera, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera};
use pinhole::gpu::{
    ColorTarget, Decision, GpuError, Headless, PictureRequest, RenderPlan, RendererOptions, SceneBuffers,
    StructurePlans, UploadProgress, UploadStep, Wait, wgpu,
};
use pinhole::{Film, Image, LayerSet, LinearRgb, RenderSettings, Scene};

use crate::host_program::{Drawing, Host};
use crate::pictures::go_on;
use crate::support::{View, spheres};
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("bricks::every_camera", every_camera),
        trial("bricks::more_bricks_than_records", many),
        trial("bricks::bands_of_a_host", bands),
        trial("bricks::one_picture_of_bricks_that_are_dropped", one_picture),
        trial("bricks::only_what_is_shown_is_built", built),
        trial("bricks::an_upload_can_be_stopped", stopped),
    ]
}

fn scene() -> Scene {
    Scene::from_f32(spheres::random(3_000, 7, |_| 0.02), LinearRgb::WHITE).unwrap()
}

/// The scene in trees: in one brick, and in bricks for a binding of `bytes` bytes.
fn trees(scene: &Scene, bytes: u64) -> [Accel; 2] {
    [1 << 27, bytes].map(|bytes| AccelPlan::new(scene.spheres(), AccelChoice::Tree, bytes).build(scene.spheres()))
}

/// Cameras around and inside of the scene, which is the unit cube. Some see only a part of it.
fn cameras() -> Vec<Box<dyn Camera>> {
    let up = [0.0, 1.0, 0.2];
    let poses = [
        Pose::looking_at([2.0, 1.5, 3.0], [0.5; 3], up).unwrap(),
        Pose::looking_at([0.4, 0.6, 0.5], [0.9, 0.1, 0.8], up).unwrap(),
        Pose::looking_at([0.2, 0.2, 1.5], [0.25, 0.2, 0.0], up).unwrap(),
        Pose::looking_along([1.2, 0.5, 0.5], [1.0, 0.1, 0.0], up).unwrap(),
    ];
    let of = |pose: Pose| -> Vec<Box<dyn Camera>> {
        let pinhole = |fov| PinholeCamera::with_vertical_fov(pose, fov, 1.5).unwrap();
        vec![
            Box::new(pinhole(0.6)),
            Box::new(pinhole(0.03)),
            Box::new(pinhole(2.4)),
            Box::new(OrthographicCamera::new(pose, [0.45, 0.3]).unwrap()),
            Box::new(ThinLensCamera::new(pinhole(0.6), 0.01, 1.0).unwrap()),
            Box::new(PanoramaCamera::new(pose)),
            Box::new(FisheyeCamera::new(pose, 3.0, 1.5).unwrap()),
        ]
    };
    poses.into_iter().flat_map(of).collect()
}

fn view(scene: &Scene, camera: Box<dyn Camera>, [width, height]: [u32; 2]) -> View {
    let (film, settings) = (Film::new(width, height).unwrap(), RenderSettings::default());
    View { scene: scene.clone(), camera, film, settings }
}

fn views(scene: &Scene, size: [u32; 2]) -> impl Iterator<Item = View> {
    cameras().into_iter().map(move |camera| view(scene, camera, size))
}

fn every_camera(headless: &'static Headless) {
    let scene = scene();
    let accels = trees(&scene, 16 * 300);
    assert!(accels[1].bricks().len() >= 10);
    let mut seen = 0;
    for view in views(&scene, [93, 62]) {
        let [one, several] = accels.each_ref().map(|accel| view.traced(headless, accel).unwrap());
        let kind = view.camera.kind();
        assert!(one == several, "{kind:?}");
        seen += usize::from(one.id().unwrap().iter().any(|id| *id != u32::MAX));
        // The recording has all rays, and they are legal.
        let buffers = headless.upload(&scene, &accels[1].clone().into()).wait().unwrap();
        let (seen, settings) = (view.seen(), &view.settings);
        let recording = headless.record_and_render(&buffers, &seen, settings, &mut go_on).wait().unwrap();
        let checker = pinhole::verify::Checker::new(&scene).unwrap();
        assert!(checker.certify(&recording).is_legal(), "{kind:?}");
    }
    assert!(seen >= 20, "{seen}");
}

fn many(headless: &'static Headless) {
    let scene = scene();
    let accels = trees(&scene, 16 * 40);
    assert!(accels[1].bricks().len() > 64, "{}", accels[1].bricks().len());
    for view in views(&scene, [61, 40]) {
        let [one, several] = accels.each_ref().map(|accel| view.traced(headless, accel).unwrap());
        assert!(one == several, "{:?}", view.camera.kind());
    }
}

/// A picture whose hits do not fit into one binding of the host.
fn bands(_: &'static Headless) {
    let limits = wgpu::Limits { max_storage_buffer_binding_size: 1 << 16, ..wgpu::Limits::default() };
    let host = Host::with_limits(limits);
    let scene = scene();
    let accels = trees(&scene, 16 * 300);
    let options = RendererOptions {
        color: ColorTarget::Linear32,
        structures: vec![accels[0].structure()],
        ..RendererOptions::default()
    };
    let mut drawing = Drawing::new(&host, &options, [150, 100]);
    let uploaded = accels.each_ref().map(|accel| {
        let Host { device, queue } = &host;
        SceneBuffers::with_accel(&drawing.renderer, device, queue, &scene, accel).wait().unwrap()
    });
    for view in views(&scene, [150, 100]) {
        let pictures = uploaded.each_ref().map(|scene| {
            let encoder = drawing.record(&host, scene, &view.seen(), &view.settings);
            host.submit_and_read::<u8>(encoder, &drawing.layers.color)
        });
        assert!(pictures[0] == pictures[1], "{:?}", view.camera.kind());
    }
}

/// A plan with bricks for a binding of `bytes` bytes.
fn planned(headless: &Headless, view: &View, choice: AccelChoice, bytes: u64) -> RenderPlan {
    let request = PictureRequest {
        is_only: false,
        is_shaded: true,
        scene: &view.scene,
        view: view.seen(),
        settings: &view.settings,
        layers: LayerSet::ALL,
        host_bytes_per_pixel: 0,
    };
    let accel = AccelPlan::new(view.scene.spheres(), choice, bytes);
    let structures = StructurePlans { accel, occluders: None };
    RenderPlan::new(&request, structures, &headless.device_limits())
}

/// Renders without keeping bricks, and returns the picture and the number of bricks that were built.
fn dropped(headless: &Headless, view: &View, plan: &RenderPlan) -> (Image, usize) {
    let mut built = 0;
    let count = &mut |progress: &UploadProgress| {
        built += usize::from(progress.step == UploadStep::Building);
        Decision::GoOn
    };
    let mut parts = Vec::new();
    let watch = &mut |progress: &pinhole::gpu::Progress| {
        parts.push(progress.part);
        Decision::GoOn
    };
    let seen = view.seen();
    let request = PictureRequest::new(&view.scene, &seen, &view.settings, LayerSet::ALL);
    let picture = headless.render_planned(&request, plan, count, watch).wait();
    let picture = picture.unwrap();
    assert!(parts.is_sorted() && parts.last() == Some(&1.0), "{parts:?}");
    (picture.image, built)
}

fn one_picture(headless: &'static Headless) {
    // Some bricks have nested grids, and others do not.
    let mut clusters = spheres::clusters(10, 200);
    clusters.extend(spheres::random(2_000, 2, |_| 0.02));
    let scenes = [spheres::random(3_000, 7, |_| 0.05), clusters, vec![[0.5, 0.5, 0.5, 0.2]; 900]];
    for spheres in scenes {
        let scene = Scene::from_f32(spheres, LinearRgb::WHITE).unwrap();
        let [one, _] = trees(&scene, 16 * 300);
        for view in views(&scene, [93, 62]) {
            let expected = view.traced(headless, &one).unwrap();
            for (choice, bytes) in
                [(AccelChoice::Tree, 16 * 300), (AccelChoice::Grid, 4 * 68 * 600), (AccelChoice::List, 4800)]
            {
                let plan = planned(headless, &view, choice, bytes);
                assert!(plan.accel.brick_count > 1);
                let (found, built) = dropped(headless, &view, &plan);
                assert!(found == expected, "{choice} {:?}", view.camera.kind());
                assert!((1..=plan.accel.brick_count).contains(&built));
            }
        }
    }
}

/// A slab of spheres hides the spheres behind it, and a narrow view leaves out the spheres beside it.
fn built(headless: &'static Headless) {
    let mut all = spheres::random(4_000, 7, |_| 0.02);
    // Large spheres before all others.
    for i in 0..64_u8 {
        let [x, y] = [i % 8, i / 8].map(|at| f32::from(at) / 4.0 - 0.375);
        all.push([x, y, 3.0, 0.3]);
    }
    let scene = Scene::from_f32(all, LinearRgb::WHITE).unwrap();
    let bricks = |eye: [f64; 3], toward: [f64; 3], half: f64| {
        let pose = Pose::looking_at(eye, toward, [0.0, 1.0, 0.0]).unwrap();
        let camera = OrthographicCamera::new(pose, [half, half]).unwrap();
        let view = view(&scene, Box::new(camera), [64, 64]);
        let plan = planned(headless, &view, AccelChoice::Tree, 16 * 300);
        let (image, built) = dropped(headless, &view, &plan);
        let [one, _] = trees(&scene, 16 * 300);
        assert!(image == view.traced(headless, &one).unwrap());
        (built, plan.accel.brick_count)
    };
    let (wide, all) = bricks([0.5, 0.5, -9.0], [0.5, 0.5, 0.0], 1.0);
    assert!(wide + 1 >= all, "{wide} of {all}");
    let (hidden, _) = bricks([0.5, 0.5, 9.0], [0.5, 0.5, 0.0], 1.0);
    assert!(hidden <= 2, "{hidden} of {all}");
    let (narrow, _) = bricks([0.2, 0.2, -9.0], [0.2, 0.2, 0.0], 0.05);
    assert!(narrow < all / 2, "{narrow} of {all}");
}

fn stopped(headless: &'static Headless) {
    let scene = scene();
    let accel = AccelPlan::new(scene.spheres(), AccelChoice::Tree, 16 * 300);
    let plans = StructurePlans { accel, occluders: None };
    for step in [UploadStep::Building, UploadStep::Copying] {
        let mut told = Vec::new();
        let watch = &mut |progress: &UploadProgress| {
            told.push(*progress);
            if (progress.step, progress.brick) == (step, 2) { Decision::Stop } else { Decision::GoOn }
        };
        let uploaded = headless.upload_planned(&scene, &plans, watch).wait();
        assert_eq!(uploaded.err(), Some(GpuError::Stopped));
        assert_eq!(told.len(), if step == UploadStep::Building { 5 } else { 6 });
        assert!(told.iter().all(|progress| progress.bricks == plans.accel.brick_count));
    }
}
