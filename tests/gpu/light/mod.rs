//! Tests that lit pictures of the GPU agree with those of the CPU reference for the same random numbers.

mod emitters;
mod passes;
pub(crate) mod scenes;

use libtest_mimic::{Failed, Trial};
use pinhole::accel::{AccelChoice, Structure};
use pinhole::camera::PinholeCamera;
use pinhole::gpu::{Decision, GpuError, Headless, Progress};
use pinhole::render::{RenderSettings, Sampling};
use pinhole::verify::LitRecording;
use pinhole::{Film, Image, LayerSet, LinearRgb, Scene, Sphere, View, cpu};

use crate::headless;
use crate::trial;
use scenes::LitView;

/// Minimum peak signal-to-noise ratio in decibels, for a peak of 1.
const LEAST_PSNR: f64 = 60.0;

/// Maximum error of a component of a pixel if all samples took the same path.
const SAME_WAY: f64 = 2e-3;

/// Maximum fraction of pixels of which a sample may have taken another path: at a silhouette, between equally near
/// spheres, or at a random choice.
const MAX_OTHER: f64 = 0.02;

pub(crate) fn trials() -> Vec<Trial> {
    let agreements = scenes::all()
        .into_iter()
        .map(|(name, view)| Trial::test(format!("light::agreement::{name}"), move || agree(&view)));
    let others = [
        trial("light::a_picture_does_not_depend_on_tiles_structures_or_order", structures),
        trial("light::batches_do_not_change_samples", batches),
        trial("light::denoising_is_the_reference's", denoising),
        trial("light::shadows_have_a_structure_of_the_kind_that_is_asked_for", occluders),
        trial("light::a_studio_that_lacks_its_occluders_is_an_error", no_occluders),
        trial("light::only_primary_rays_are_recorded", not_recorded),
    ];
    agreements.chain(others).chain(emitters::trials()).chain(passes::trials()).collect()
}

fn render(view: &LitView) -> Result<Image, Failed> {
    Ok(headless()?.render(&view.scene, &view.seen(), &view.settings, LayerSet::ALL)?)
}

fn agree(view: &LitView) -> Result<(), Failed> {
    let wanted = cpu::render(&view.scene, &view.seen(), &view.settings, LayerSet::ALL)?;
    agree_with(view, &wanted)
}

fn agree_with(view: &LitView, wanted: &Image) -> Result<(), Failed> {
    let found = render(view)?;
    let colors = found.color().iter().zip(wanted.color());
    let differences: Vec<f64> = colors
        .map(|(a, b)| (0..3).map(|c| f64::from((a[c] - b[c]).abs())).fold(0.0, f64::max))
        .collect();
    let squares =
        found.color().iter().zip(wanted.color()).flat_map(|(a, b)| {
            (0..3).map(move |c| f64::from(a[c].min(1.0) - b[c].min(1.0)).powi(2))
        });
    let count = view.film.pixel_count() as f64;
    let mean_square = squares.sum::<f64>() / (3.0 * count);
    let psnr = -10.0 * mean_square.max(1e-20).log10();
    let other = differences.iter().filter(|difference| **difference > SAME_WAY).count();
    let worst = differences.iter().copied().fold(0.0, f64::max);
    let brightest = wanted.color().iter().flatten().copied().fold(0.0, f32::max);
    println!(
        "{psnr:.1} dB, {other} pixels went another way, worst {worst:.2e}, brightest {brightest}"
    );
    let alphas = found.alpha().unwrap_or_default().iter().zip(wanted.alpha().unwrap_or_default());
    let alpha = alphas.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    if psnr < LEAST_PSNR || other as f64 > MAX_OTHER * count || alpha > 0.05 {
        return Err(
            format!("{psnr} dB, {other} pixels differ, by {worst}; alpha by {alpha}").into()
        );
    }
    if found.samples() != wanted.samples() || found.id() != wanted.id() {
        return Err("samples or ids differ".into());
    }
    Ok(())
}

/// A grid, a tree, a list, and bricks, on a device with the limits of WebGPU.
fn structures(_: &'static Headless) {
    let device = headless().unwrap();
    for (name, view) in [scenes::studios().swap_remove(2), scenes::paths().swap_remove(2)] {
        let LitView { scene, settings, .. } = &view;
        let pictures = [AccelChoice::List, AccelChoice::Tree, AccelChoice::Grid].map(|choice| {
            let plan = device.plan(scene, &view.seen(), settings, LayerSet::COLOR, choice, 0);
            let buffers = device.upload(scene, &plan.build(scene)).unwrap();
            let go_on = &mut |_: &Progress| Decision::GoOn;
            device
                .render_uploaded(&buffers, &view.seen(), settings, LayerSet::COLOR, go_on)
                .unwrap()
                .image
        });
        assert_eq!(pictures[0], pictures[1], "{name}");
        assert_eq!(pictures[0], pictures[2], "{name}");
    }
}

/// A picture that is finished early is identical to one that was requested with that number of samples.
fn batches(device: &'static Headless) {
    let (_, mut view) = scenes::paths().swap_remove(1);
    view.settings.sampling.samples = 1000;
    let LitView { scene, settings, .. } = &view;
    let accel = device.plan_accel(scene, AccelChoice::Auto).build(scene.spheres());
    let buffers = device.upload(scene, &accel.into()).unwrap();
    let enough = &mut |progress: &Progress| {
        if progress.samples >= 8 { Decision::Finish } else { Decision::GoOn }
    };
    let early =
        device.render_uploaded(&buffers, &view.seen(), settings, LayerSet::COLOR, enough).unwrap();
    assert!((8..=64).contains(&early.samples), "{}", early.samples);
    let mut asked = settings.clone();
    asked.sampling.samples = early.samples;
    let whole = device.render(scene, &view.seen(), &asked, LayerSet::COLOR).unwrap();
    assert_eq!(early.image, whole);
}

fn denoising(device: &'static Headless) {
    let (_, mut view) = scenes::paths().swap_remove(1);
    view.settings.sampling.samples = 4;
    let noisy = render(&view).unwrap();
    let quiet = device.denoise(&noisy).unwrap();
    let wanted = cpu::denoise(&noisy).unwrap();
    for (a, b) in quiet.color().iter().zip(wanted.color()) {
        for c in 0..3 {
            assert!((a[c] - b[c]).abs() <= 1e-4 * b[c].max(1.0), "{a:?} {b:?}");
        }
    }
    view.settings.sampling.samples = 512;
    let reference = render(&view).unwrap();
    let error = |image: &Image| {
        let squares = image.color().iter().zip(reference.color());
        squares
            .map(|(a, b)| (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>())
            .sum::<f64>()
    };
    assert!(error(&quiet) < 0.5 * error(&noisy), "{} of {}", error(&quiet), error(&noisy));
}

/// Spheres of which every second is not opaque. There are so many that every structure pays off.
fn translucent() -> Scene {
    let spheres: Vec<Sphere> = (0..400)
        .map(|i| {
            let center = [f64::from(i % 20), f64::from(i / 20), 0.0];
            let sphere = Sphere::new(center, 0.4, LinearRgb::from_srgb8([128; 3]));
            if i % 2 == 0 { sphere.with_opacity(0.5) } else { sphere }
        })
        .collect();
    Scene::new(&spheres).unwrap()
}

fn occluders(device: &'static Headless) {
    let scene = translucent();
    let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.0).unwrap();
    let view = View::new(&camera, Film::new(32, 32).unwrap());
    let mut studio = RenderSettings::studio();
    studio.sampling.samples = 2;
    let mut images = Vec::new();
    for (choice, structure) in
        [(AccelChoice::Tree, Structure::WideTree), (AccelChoice::List, Structure::List)]
    {
        let plan = device.plan(&scene, &view, &studio, LayerSet::COLOR, choice, 0);
        let occluders = plan.occluders.as_ref().unwrap();
        assert_eq!((plan.accel.structure, occluders.structure), (structure, structure));
        assert_eq!(occluders.statistics.count, 200);
        let structures = plan.build(&scene);
        assert_eq!(structures.occluders.as_ref().unwrap().structure(), structure);
        let buffers = device.upload(&scene, &structures).unwrap();
        let planned: u64 = plan.scene_buffers.iter().map(|buffer| buffer.bytes).sum();
        // The plan does not count the records of bricks and the single appearance words.
        assert!(buffers.bytes() <= planned + 400, "{} of {planned}", buffers.bytes());
        let go_on = &mut |_: &_| Decision::GoOn;
        images.push(device.render_uploaded(&buffers, &view, &studio, LayerSet::COLOR, go_on));
    }
    assert!(images[0].is_ok() && images.iter().all(|image| *image == images[0]));
    for settings in [RenderSettings::default(), RenderSettings::path()] {
        let choice = AccelChoice::Tree;
        let plan = device.plan(&scene, &view, &settings, LayerSet::COLOR, choice, 0);
        assert!(plan.occluders.is_none(), "{}", settings.integrator.name());
    }
    // If all spheres are opaque, one structure suffices.
    let opaque =
        Scene::from_f32(scene.spheres().to_vec(), LinearRgb::from_srgb8([128; 3])).unwrap();
    let plan = device.plan(&opaque, &view, &studio, LayerSet::COLOR, AccelChoice::Tree, 0);
    assert!(plan.occluders.is_none());
}

fn no_occluders(device: &'static Headless) {
    let scene = translucent();
    let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.0).unwrap();
    let view = View::new(&camera, Film::new(8, 8).unwrap());
    let accel = device.plan_accel(&scene, AccelChoice::Auto).build(scene.spheres());
    let buffers = device.upload(&scene, &accel.into()).unwrap();
    let render = |settings: RenderSettings| {
        let settings =
            RenderSettings { sampling: Sampling { samples: 1, ..settings.sampling }, ..settings };
        let go_on = &mut |_: &_| Decision::GoOn;
        device.render_uploaded(&buffers, &view, &settings, LayerSet::COLOR, go_on)
    };
    let error = render(RenderSettings::studio()).unwrap_err();
    assert_eq!(error, GpuError::NoOccluders);
    assert!(error.to_string().contains("RenderPlan::build"), "{error}");
    // Other integrators do not need the occluders.
    assert_eq!(render(RenderSettings::path()).unwrap().samples, 1);
    let primary = render(RenderSettings::default()).unwrap();
    assert_eq!((primary.samples, primary.noise, primary.hits), (1, None, None));
}

fn not_recorded(device: &'static Headless) {
    let scene = translucent();
    let camera = PinholeCamera::framing_from_the_front(scene.bounds_to_frame(), 1.0).unwrap();
    let view = View::new(&camera, Film::new(8, 8).unwrap());
    let accel = device.plan_accel(&scene, AccelChoice::Auto).build(scene.spheres());
    let buffers = device.upload(&scene, &accel.into()).unwrap();
    let go_on = &mut |_: &_| Decision::GoOn;
    let refused = |integrator| Some(GpuError::NotPrimary { integrator });
    let recording = device.record(&buffers, &view, &RenderSettings::path(), go_on);
    assert_eq!(recording.err(), refused("path"));
    let certificate = device.verify(&scene, &view, &RenderSettings::studio());
    assert_eq!(certificate.err(), refused("studio"));
    let each = &mut |_: LitRecording<'_>| {};
    let light = device.record_lit(&buffers, &view, &RenderSettings::default(), &[0], (each, go_on));
    assert_eq!(light.err(), Some(GpuError::NotLit));
}
