//! Parts of the samples have on a device the samples of the whole, and their mean is its picture.

use libtest_mimic::Trial;
use pinhole::accel::AccelChoice;
use pinhole::gpu::Headless;
use pinhole::image::SampleMean;
use pinhole::render::{Decision, Sampling};
use pinhole::{Image, LayerSet, RenderSettings};

use crate::headless;
use crate::light::scenes::{self, LitView};

const SAMPLES: u32 = 7;

pub(crate) fn trials() -> Vec<Trial> {
    let lit = scenes::all().into_iter().map(|(name, view)| {
        Trial::test(format!("sample_parts::{name}"), move || {
            check(headless()?, &view, name);
            Ok(())
        })
    });
    lit.collect()
}

/// The pixels of a picture, whose parts are pictures of their own.
fn check(device: &Headless, view: &LitView, name: &str) {
    let sampling = Sampling { samples: SAMPLES, ..view.settings.sampling };
    let settings = RenderSettings { sampling, is_denoised: false, ..view.settings.clone() };
    let plan =
        device.plan(&view.scene, &view.seen(), &settings, LayerSet::ALL, AccelChoice::Auto, 0);
    let scene = device.upload(&view.scene, &plan.build(&view.scene)).unwrap();
    let of = |settings: &RenderSettings| {
        let go_on = &mut |_: &_| Decision::GoOn;
        let seen = view.seen();
        device.render_uploaded(&scene, &seen, settings, LayerSet::ALL, go_on).unwrap().image
    };
    let in_parts = |settings: &RenderSettings, samples_per_part: u32| {
        let mut last = 0.0;
        let watch = &mut |progress: &pinhole::render::Progress| {
            assert!(progress.total == SAMPLES && progress.part >= last, "{progress:?}");
            last = progress.part;
            // There is nothing to measure, and nothing ends early.
            if last > 0.5 { Decision::Finish } else { Decision::MeasureNoise }
        };
        let (seen, layers) = (view.seen(), LayerSet::ALL);
        let picture =
            device.render_in_parts(&scene, &seen, settings, layers, samples_per_part, watch);
        let picture = picture.unwrap();
        assert_eq!((picture.samples, picture.noise, last), (SAMPLES, None, 1.0));
        picture.image
    };
    let whole = of(&settings);
    assert!(in_parts(&settings, SAMPLES).to_le_bytes() == whole.to_le_bytes());
    for samples_per_part in [1, 3, 5] {
        let parts: Vec<Sampling> = sampling.parts(samples_per_part).collect();
        let picture =
            |sampling: &Sampling| of(&RenderSettings { sampling: *sampling, ..settings.clone() });
        let mut mean = SampleMean::new(picture(&parts[0]), parts[0].samples);
        for part in &parts[1..] {
            mean.add(&picture(part), part.samples).unwrap();
        }
        let found = in_parts(&settings, samples_per_part);
        assert!(found.to_le_bytes() == mean.into_image().to_le_bytes(), "{samples_per_part}");
        compare(&found, &whole, samples_per_part);
    }
    // What looks at neighbours is done once, at the end.
    let denoised = RenderSettings { is_denoised: true, ..settings.clone() };
    let (found, before) = (in_parts(&denoised, 3), in_parts(&settings, 3));
    let finished = device.finish(before, &denoised, LayerSet::ALL).unwrap();
    assert!(found.to_le_bytes() == finished.to_le_bytes());
    // Without random numbers of their own, the parts are not the picture.
    if name != "studio_without_light" {
        let other = Sampling { first: 1, ..sampling };
        let other = of(&RenderSettings { sampling: other, ..settings });
        assert_ne!(other.color(), whole.color());
    }
}

/// Each value of a whole and of a mean of parts is a sum of numbers from 0 up, rounded to f32 after at most `2 · SAMPLES`
/// operations, and one more times the background, which is at most 1 and is seen through what is not opaque.
fn compare(found: &Image, whole: &Image, samples_per_part: u32) {
    let bound = f64::from(2 * SAMPLES + 4) * f64::from(f32::EPSILON) / 2.0;
    let near = |a: f32, b: f32| {
        let (a, b) = (f64::from(a), f64::from(b));
        (a - b).abs() <= bound * (a.abs().max(b.abs()) + 1.0)
    };
    for (a, b) in found.color().iter().zip(whole.color()) {
        assert!((0..3).all(|i| near(a[i], b[i])), "{samples_per_part}: {a:?} {b:?}");
    }
    for (a, b) in found.alpha().unwrap().iter().zip(whole.alpha().unwrap()) {
        assert!(near(*a, *b), "{samples_per_part}: {a} {b}");
    }
    for (a, b) in found.albedo().unwrap().iter().zip(whole.albedo().unwrap()) {
        assert!((0..3).all(|i| near(a[i], b[i])), "{samples_per_part}: {a:?} {b:?}");
    }
    assert_eq!(found.samples(), whole.samples());
    assert_eq!((found.depth(), found.id()), (whole.depth(), whole.id()));
}
