//! Pictures that are rendered batch by batch, with a caller who watches and may finish early.

use pinhole::cpu::{self, RenderError, SearchStructure};
use pinhole::image::Layer;
use pinhole::render::{Decision, Progress};
use pinhole::{Film, Image, LayerSet, LinearRgb, RenderSettings, Scene, Sphere, View};

use crate::support::random_light;

/// A picture of several strips and tiles, and of pieces of them.
const FILM: [u32; 2] = [37, 29];

/// A picture for which a batch of samples takes a while.
const TALL: [u32; 2] = [37, 1601];

/// Calls `test` with a picture of paths and one of a studio.
fn with_lit(samples: u32, test: impl Fn(&SearchStructure<'_>, &View<'_>, &RenderSettings)) {
    with_lit_of(FILM, samples, test);
}

fn with_lit_of(
    [width, height]: [u32; 2],
    samples: u32,
    test: impl Fn(&SearchStructure<'_>, &View<'_>, &RenderSettings),
) {
    let view = random_light::view(3);
    for mut settings in [view.settings.clone(), RenderSettings::studio()] {
        settings.sampling.samples = samples;
        let tree = SearchStructure::new(&view.scene).unwrap();
        let film = Film::new(width, height).unwrap();
        test(&tree, &View::new(view.camera.as_ref(), film), &settings);
    }
}

/// The picture that is rendered pixel by pixel.
fn whole(
    tree: &SearchStructure<'_>,
    view: &View<'_>,
    settings: &RenderSettings,
    count: u32,
) -> Image {
    let mut settings = settings.clone();
    settings.sampling.samples = count;
    cpu::render(tree, view, &settings, LayerSet::ALL).unwrap()
}

#[test]
fn batches_give_the_picture_of_all_samples_at_once() {
    for samples in [1, 2, 7, 40] {
        with_lit(samples, |tree, view, settings| {
            for is_denoised in [false, true] {
                let settings = RenderSettings { is_denoised, ..settings.clone() };
                let watch = &mut |_: &Progress| Decision::MeasureNoise;
                let found = cpu::render_watched(tree, view, &settings, LayerSet::ALL, watch);
                let found = found.unwrap();
                assert!(found.image == whole(tree, view, &settings, samples), "{samples}");
                assert_eq!(found.samples, samples);
            }
        });
    }
}

/// What is told rises to the end, and each batch is told of.
#[test]
fn the_caller_is_told_of_every_batch() {
    with_lit(9, |tree, view, settings| {
        for settings in [settings, &RenderSettings::default()] {
            let mut told = Vec::new();
            let watch = &mut |progress: &Progress| {
                told.push(*progress);
                Decision::GoOn
            };
            let done = cpu::render_watched(tree, view, settings, LayerSet::COLOR, watch).unwrap();
            assert!(told.is_sorted_by(|a, b| a.part <= b.part && a.samples <= b.samples));
            let last = told.last().unwrap();
            let total = if settings.integrator.is_primary() { 1 } else { 9 };
            assert_eq!((last.samples, last.total, done.samples), (total, total, total));
            assert!(last.part >= 1.0 && last.noise.is_none());
            for samples in [1, 2, 4, 8, 9].into_iter().filter(|samples| *samples <= total) {
                assert!(told.iter().any(|progress| progress.samples == samples), "{samples}");
            }
        }
    });
}

#[test]
fn a_level_of_noise_ends_a_picture() {
    with_lit(1000, |tree, view, settings| {
        let mut noises = Vec::new();
        let watch = &mut |progress: &Progress| {
            noises.extend(progress.noise.map(|noise| (progress.samples, noise)));
            if progress.samples >= 16 { Decision::Finish } else { Decision::MeasureNoise }
        };
        let found = cpu::render_watched(tree, view, settings, LayerSet::ALL, watch).unwrap();
        assert_eq!(found.samples, 16);
        assert!(found.image == whole(tree, view, settings, 16));
        assert_eq!(noises.last(), found.noise.map(|noise| (16, noise)).as_ref());
        // The noise is that of the layers, which are narrower.
        let variance = found.image.variance().unwrap().iter().map(|v| f64::from(*v)).sum::<f64>();
        let colors = found.image.color().iter().map(|color| color.map(f64::from));
        let light: f64 = colors.map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b).sum();
        let count = f64::from(FILM[0] * FILM[1]);
        if light > 0.0 {
            let wanted = (variance / count).sqrt() / (light / count);
            let noise = found.noise.unwrap();
            assert!((noise / wanted - 1.0).abs() < 1e-3, "{noise} and {wanted}");
        }
    });
}

/// A picture that is finished within a batch keeps what the batch has done.
#[test]
fn every_pixel_has_the_samples_that_the_layer_says() {
    with_lit_of(TALL, 4000, |tree, view, settings| {
        let is_within = |progress: &Progress| {
            let samples = f64::from(progress.samples);
            progress.samples > 0 && progress.part * f64::from(progress.total) > samples + 0.5
        };
        let watch = &mut |progress: &Progress| {
            if is_within(progress) { Decision::Finish } else { Decision::GoOn }
        };
        let layers = LayerSet::COLOR.with(Layer::Samples).with(Layer::Variance);
        let settings = RenderSettings { is_denoised: false, ..settings.clone() };
        let found = cpu::render_watched(tree, view, &settings, layers, watch).unwrap();
        let counts = found.image.samples().unwrap();
        assert_eq!(counts.iter().min(), Some(&found.samples));
        let most = *counts.iter().max().unwrap();
        assert!(most > found.samples, "{most}");
        let whole = [found.samples, most].map(|count| whole(tree, view, &settings, count));
        for (index, count) in counts.iter().enumerate() {
            let whole = if *count == most { &whole[1] } else { &whole[0] };
            assert_eq!(found.image.color()[index], whole.color()[index], "{index}: {count}");
        }
    });
}

#[test]
fn the_caller_may_stop() {
    with_lit(9, |tree, view, settings| {
        for settings in [settings, &RenderSettings::default()] {
            let stop = &mut |_: &Progress| Decision::Stop;
            let done = cpu::render_watched(tree, view, settings, LayerSet::ALL, stop);
            assert_eq!(done.err(), Some(RenderError::Stopped));
        }
        // Without a sample there is no picture, whether it is to be finished or not.
        let mut calls = 0;
        let finish = &mut |progress: &Progress| {
            calls += 1;
            if progress.samples == 0 { Decision::Finish } else { Decision::GoOn }
        };
        let done = cpu::render_watched(tree, view, settings, LayerSet::COLOR, finish);
        assert_eq!(done.err(), Some(RenderError::Stopped));
        assert_eq!(calls, 1);
    });
}

/// The sums need more than the picture, and a refusal is no panic.
#[test]
fn a_picture_without_memory_is_refused() {
    let scene = Scene::new(&[Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE)]).unwrap();
    let view = random_light::view(3);
    let film = Film::new(Film::MAX_SIDE, Film::MAX_SIDE).unwrap();
    let view = View::new(view.camera.as_ref(), film);
    let settings = RenderSettings::studio();
    let go_on = &mut |_: &Progress| Decision::GoOn;
    let done = cpu::render_watched(&scene, &view, &settings, LayerSet::COLOR, go_on);
    assert!(matches!(done, Err(RenderError::Image(_))));
}
