//! Lit pictures of the GPU are those of the CPU reference, of the same random numbers.

pub(crate) mod scenes;

use libtest_mimic::{Failed, Trial};
use pinhole::{Image, LayerSet, cpu};

use crate::headless;
use crate::trial;
use scenes::LitView;

/// In decibels, of a peak of 1.
const LEAST_PSNR: f64 = 60.0;

/// What a component of a pixel may be off by where every sample took the same way.
const SAME_WAY: f64 = 2e-3;

/// The most pixels, in parts of all, of which a sample may have gone another way: at a silhouette, between spheres
/// that are as near, or at a choice by chance.
const MAX_OTHER: f64 = 0.02;

pub(crate) fn trials() -> Vec<Trial> {
    let agreements = scenes::all()
        .into_iter()
        .map(|(name, view)| Trial::test(format!("light::agreement::{name}"), move || agree(&view)));
    let others = [
        trial("light::a_picture_does_not_depend_on_tiles_structures_or_order", structures),
        trial("light::what_casts_shadows_is_in_the_structure_that_was_asked_for", occluders),
        trial("light::batches_do_not_change_samples", batches),
        trial("light::denoising_is_the_reference's", denoising),
    ];
    agreements.chain(others).collect()
}

fn render(view: &LitView) -> Result<Image, Failed> {
    let LitView { scene, camera, film, lighting } = view;
    Ok(headless()?.render_lit(scene, camera.as_ref(), film, lighting, LayerSet::ALL)?)
}

fn agree(view: &LitView) -> Result<(), Failed> {
    let LitView { scene, camera, film, lighting } = view;
    let found = render(view)?;
    let wanted = cpu::render_lit(scene, camera.as_ref(), film, lighting, LayerSet::ALL)?;
    let colors = found.color().iter().zip(wanted.color());
    let differences: Vec<f64> = colors
        .map(|(a, b)| (0..3).map(|c| f64::from((a[c] - b[c]).abs())).fold(0.0, f64::max))
        .collect();
    let squares =
        found.color().iter().zip(wanted.color()).flat_map(|(a, b)| {
            (0..3).map(move |c| f64::from(a[c].min(1.0) - b[c].min(1.0)).powi(2))
        });
    let count = film.pixel_count() as f64;
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

/// A grid, a tree and a list, and bricks, on a device of WebGPU's limits.
fn structures(_: &'static pinhole::gpu::Headless) {
    use pinhole::accel::AccelChoice;
    use pinhole::gpu::{LitDecision, LitProgress};
    let device = headless().unwrap();
    for (name, view) in [scenes::studios().swap_remove(2), scenes::paths().swap_remove(2)] {
        let LitView { scene, camera, film, lighting } = &view;
        let pictures = [AccelChoice::List, AccelChoice::Tree, AccelChoice::Grid].map(|choice| {
            let accel = device.plan(scene, choice).build(scene.spheres());
            let buffers = device.upload_lit(scene, &accel).unwrap();
            let go_on = &mut |_: &LitProgress| LitDecision::GoOn;
            let view = (camera.as_ref(), film);
            let layers = LayerSet::COLOR;
            device
                .render_lit_uploaded(scene, &buffers, view, lighting, layers, go_on)
                .unwrap()
                .image
        });
        assert_eq!(pictures[0], pictures[1], "{name}");
        assert_eq!(pictures[0], pictures[2], "{name}");
    }
}

/// Not in the one that would suit it, which may be one in which rays take too many steps.
fn occluders(device: &'static pinhole::gpu::Headless) {
    use pinhole::accel::AccelChoice;
    use pinhole::{LinearRgb, Scene, Sphere};
    let sphere = |i: u32| {
        let center = [i % 9, i / 9 % 9, i / 81].map(f64::from);
        Sphere::new(center, 0.3, LinearRgb::WHITE).with_opacity(if i < 100 { 0.5 } else { 1.0 })
    };
    let spheres: Vec<Sphere> = (0..600).map(sphere).collect();
    let (all, opaque) = (Scene::new(&spheres).unwrap(), Scene::new(&spheres[100..]).unwrap());
    for choice in [AccelChoice::List, AccelChoice::Tree, AccelChoice::Grid] {
        let build = |scene: &Scene| device.plan(scene, choice).build(scene.spheres());
        let bytes = |scene: &Scene| device.upload(scene, &build(scene)).unwrap().bytes();
        let both = device.upload_lit(&all, &build(&all)).unwrap();
        assert_eq!(both.bytes(), bytes(&all) + bytes(&opaque), "{choice}");
    }
}

/// A picture that is finished early is the one that was asked for with so many samples.
fn batches(device: &'static pinhole::gpu::Headless) {
    use pinhole::accel::AccelChoice;
    use pinhole::gpu::{LitDecision, LitProgress};
    let (_, mut view) = scenes::paths().swap_remove(1);
    view.lighting.sampling.samples = 1000;
    let LitView { scene, camera, film, lighting } = &view;
    let accel = device.plan(scene, AccelChoice::Auto).build(scene.spheres());
    let buffers = device.upload_lit(scene, &accel).unwrap();
    let enough = &mut |progress: &LitProgress| {
        if progress.samples >= 8 { LitDecision::Finish } else { LitDecision::GoOn }
    };
    let seen = (camera.as_ref(), film);
    let early = device
        .render_lit_uploaded(scene, &buffers, seen, lighting, LayerSet::COLOR, enough)
        .unwrap();
    assert!((8..=64).contains(&early.samples), "{}", early.samples);
    let mut asked = lighting.clone();
    asked.sampling.samples = early.samples;
    let whole = device.render_lit(scene, camera.as_ref(), film, &asked, LayerSet::COLOR).unwrap();
    assert_eq!(early.image, whole);
}

fn denoising(device: &'static pinhole::gpu::Headless) {
    let (_, mut view) = scenes::paths().swap_remove(1);
    view.lighting.sampling.samples = 4;
    let noisy = render(&view).unwrap();
    let quiet = device.denoise(&noisy).unwrap();
    let wanted = cpu::denoise(&noisy).unwrap();
    for (a, b) in quiet.color().iter().zip(wanted.color()) {
        for c in 0..3 {
            assert!((a[c] - b[c]).abs() <= 1e-4 * b[c].max(1.0), "{a:?} {b:?}");
        }
    }
    view.lighting.sampling.samples = 512;
    let reference = render(&view).unwrap();
    let error = |image: &Image| {
        let squares = image.color().iter().zip(reference.color());
        squares
            .map(|(a, b)| (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>())
            .sum::<f64>()
    };
    assert!(error(&quiet) < 0.5 * error(&noisy), "{} of {}", error(&quiet), error(&noisy));
}
