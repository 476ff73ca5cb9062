//! Tests of the passes of lit pictures: recorded by an application, without indirect dispatches, and of their sums.

use libtest_mimic::Trial;
use pinhole::accel::AccelChoice;
use pinhole::gpu::{Decision, GpuError, Headless, HeadlessOptions, Progress, SampleRequest, Wait};
use pinhole::image::Layer;
use pinhole::internals::RecordedFilm;
use pinhole::render::{Integrator, Occlusion};
use pinhole::verify::LitRecording;
use pinhole::{Film, LayerSet, LinearRgb, Scene};

use crate::lit_scenes::{self, named, sampled};
use crate::pictures::go_on;
use crate::planted::planted;
use crate::support::View;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("light::passes::one_pass_makes_the_picture_of_several", one_pass),
        trial("light::passes::faults_in_one_pass_change_the_picture", faults),
        trial("light::passes::every_structure_makes_the_same_picture", structures),
        trial("light::passes::a_picture_is_the_sum_of_its_samples_rounded_once", sums),
        trial("light::passes::many_directions_in_a_long_list_are_all_searched", long_list),
        trial("light::passes::noise_is_measured_when_it_is_asked_for", noise),
        trial("light::passes::what_is_finished_within_a_batch_says_how_many_samples_it_has", unfinished),
        trial(
            "light::passes::what_is_finished_within_a_pass_over_whole_samples_has_whole_samples",
            unfinished_in_one_pass,
        ),
        trial("light::passes::what_is_stopped_within_a_sample_gives_no_picture", stopped),
    ]
}

/// Spheres side by side: x, y and z of them along the axes.
fn block([x, y, z]: [u32; 3], step: f32, radius: f32) -> Scene {
    let spheres = (0..x * y * z).map(|i| {
        let [x, y, z] = [i % x, i / x % y, i / (x * y)].map(|c| step * c as f32 - 2.2);
        [x, y, z, radius]
    });
    Scene::from_f32(spheres.collect(), LinearRgb::from_srgb8([200; 3])).unwrap()
}

/// A studio with several tiles. Before the device is known to be fast, even one sample takes several submissions.
fn large_studio() -> View {
    let mut view = named("studio_ambient_occlusion");
    view.scene = block([10, 10, 10], 0.45, 0.25);
    view.film = Film::new(800, 600).unwrap();
    view
}

/// One pass computes every ray in the same way as several passes, and adds light in the same order.
fn one_pass(headless: &'static Headless) {
    let options = HeadlessOptions { one_pass: false, ..HeadlessOptions::default() };
    let several = Headless::open(&options).wait().unwrap();
    for (name, mut view) in lit_scenes::all() {
        view.settings.sampling.samples = 6;
        let mut sharp = view.settings.clone();
        if let Integrator::Studio(studio) = &mut sharp.integrator {
            studio.shadows = false;
        }
        let mut caught = view.settings.clone();
        if let Integrator::Studio(studio) = &mut caught.integrator {
            if let Some(ground) = &mut caught.ground {
                ground.is_shadow_catcher = !ground.is_shadow_catcher;
            }
            // A number of directions whose reciprocal must be rounded.
            if let Some(occlusion) = &mut studio.occlusion {
                occlusion.samples = 5;
            }
        }
        // Only a studio has other settings.
        let mut all = vec![&view.settings, &sharp, &caught];
        all.dedup();
        for (index, settings) in all.into_iter().enumerate() {
            let [one, several] = [headless, &several]
                .map(|device| device.render(&view.scene, &view.seen(), settings, LayerSet::ALL).wait().unwrap());
            let differ = one.color().iter().zip(several.color()).filter(|(a, b)| !a.iter().eq(*b));
            let first: Vec<_> = differ.clone().take(3).collect();
            let count = differ.count();
            assert!(one == several, "{name}, settings {index}: {count} colours differ: {first:?}");
        }
    }
    let mut view = large_studio();
    view.settings.sampling.samples = 1;
    let [one, several] = [headless, &several].map(|device| view.picture(device, LayerSet::ALL));
    assert!(one == several, "the large picture differs");
}

/// Tests that the comparison with several passes finds faults.
fn faults(headless: &'static Headless) {
    for fault in planted("one_pass") {
        let [scene] = fault.setup();
        let view = sampled(scene, 6);
        let faulty = fault.device().unwrap();
        let [right, wrong] = [headless, &faulty].map(|device| view.picture(device, LayerSet::ALL));
        assert!(right != wrong, "{}", fault.name);
    }
}

/// Some structures are searched in one pass, and others in several.
fn structures(device: &'static Headless) {
    for (name, samples) in [
        ("studio_ambient_occlusion", 3),
        ("studio_shadow_catcher", 3),
        ("studio_near_occlusion", 64),
        ("path_glass", 64),
    ] {
        let view = sampled(name, samples);
        let pictures = [AccelChoice::Auto, AccelChoice::Grid, AccelChoice::Tree, AccelChoice::List].map(|choice| {
            let buffers = device.upload(&view.scene, &view.planned(device, choice)).wait().unwrap();
            view.watched(device, &buffers, LayerSet::COLOR, &mut go_on).unwrap().image
        });
        assert!(pictures.iter().all(|picture| *picture == pictures[0]), "{name}");
    }
}

/// Samples that are recorded one by one, pass by pass, have the same sums as the picture. Neither the number of samples
/// in flight, nor the sizes of batches, nor passes over whole samples change them.
fn sums(headless: &'static Headless) {
    const SAMPLES: u32 = 11;
    let samples: Vec<u32> = (0..SAMPLES).collect();
    for (name, mut view) in lit_scenes::all() {
        view.settings.sampling.samples = SAMPLES;
        view.settings.sampling.denoise = false;
        let View { scene, settings, .. } = &view;
        let structures = view.planned(headless, AccelChoice::Auto);
        let buffers = headless.upload(scene, &structures).wait().unwrap();
        let mut film = RecordedFilm::default();
        let mut each = |recording: &LitRecording| {
            let one = &recording.samples[0].film;
            assert!(film.after.is_empty() || film.after == one.before, "{name}");
            film = one.clone();
        };
        let request = SampleRequest::middle(&samples);
        headless.record_lit(&buffers, &view.seen(), settings, request, &mut each, &mut go_on).wait().unwrap();
        let wanted: Vec<[f32; 3]> = film
            .after
            .iter()
            .map(|[color, rest, _]| {
                [0, 1, 2].map(|c| {
                    let sum = [color[c], rest[c]].map(|bits| f64::from(f32::from_bits(bits)));
                    ((sum[0] + sum[1]) / f64::from(SAMPLES)) as f32
                })
            })
            .collect();
        assert!(view.picture(headless, LayerSet::COLOR).color() == wanted, "{name}");
    }
}

/// Sixteen directions with 9,000 spheres each exceed the iteration limit of some devices.
fn long_list(headless: &'static Headless) {
    let mut view = named("studio_ambient_occlusion");
    view.scene = block([30, 30, 10], 0.15, 0.07);
    view.film = Film::new(40, 32).unwrap();
    view.settings.sampling.samples = 1;
    let Integrator::Studio(studio) = &mut view.settings.integrator else { panic!("no studio") };
    studio.occlusion = Some(Occlusion { radius: None, samples: 16 });
    let pictures = [AccelChoice::List, AccelChoice::Grid].map(|choice| {
        let buffers = view.uploaded(headless, choice);
        view.watched(headless, &buffers, LayerSet::COLOR, &mut go_on).unwrap().image
    });
    assert_eq!(pictures[0], pictures[1]);
}

/// The device computes the noise during a render, and the host at the end. Both must agree.
fn noise(headless: &'static Headless) {
    let view = sampled("path_emissive_both", 16);
    let buffers = view.uploaded(headless, AccelChoice::Auto);
    let told = |wanted: Decision| {
        let mut told = Vec::new();
        let watch = &mut |progress: &Progress| {
            told.push((progress.samples, progress.noise));
            wanted
        };
        let picture = view.watched(headless, &buffers, LayerSet::COLOR, watch);
        (told, picture.unwrap().noise.unwrap())
    };
    let (told_nothing, at_end) = told(Decision::GoOn);
    assert!(told_nothing.iter().all(|(_, noise)| noise.is_none()), "{told_nothing:?}");
    let (told, same) = told(Decision::MeasureNoise);
    assert_eq!(at_end.to_bits(), same.to_bits());
    let (samples, last) = told[told.len() - 1];
    assert_eq!(samples, 16);
    let last = last.unwrap();
    assert!((last / at_end - 1.0).abs() < 1e-4, "{last} {at_end}");
    let (_, early) = told.iter().find(|(samples, _)| *samples == 4).unwrap();
    assert!(early.unwrap() > last, "{told:?}");
}

/// If a render finishes within a batch, some tiles have more samples than others. Each pixel is identical to the pixel
/// of a picture with its number of samples.
fn unfinished(headless: &'static Headless) {
    let mut view = named("path_emissive_both");
    view.film = Film::new(900, 500).unwrap();
    finish_within_a_batch(headless, &mut view, 4, 1);
}

/// Like [`unfinished`], with passes over whole samples. A slice of such a pass covers some pixels of a tile. The render
/// does not finish while some of these pixels have more samples than others.
fn unfinished_in_one_pass(headless: &'static Headless) {
    let mut view = large_studio();
    // Three tiles, with so many rays that a slow device takes several submissions for a sample of one of them. The
    // first call in the second tile comes before its slices, and the second call after them.
    view.film = Film::new(800, 1300).unwrap();
    let Integrator::Studio(studio) = &mut view.settings.integrator else { panic!("no studio") };
    studio.occlusion = Some(Occlusion { radius: None, samples: 24 });
    finish_within_a_batch(headless, &mut view, 1, 2);
}

/// Finishes a render within a batch, at call `call` after at least `first` samples, and compares its pixels with
/// pictures that were requested with as many samples.
fn finish_within_a_batch(headless: &'static Headless, view: &mut View, first: u32, call: usize) {
    view.settings.sampling.samples = 64;
    let layers = LayerSet::COLOR.with(Layer::Samples);
    let buffers = view.uploaded(headless, AccelChoice::Auto);
    // Each batch has as many samples as all batches before it.
    let (mut finished_at, mut calls) = (None, 0);
    let watch = &mut |progress: &Progress| {
        let Progress { samples, total, part, .. } = *progress;
        let of_batch = part * f64::from(total) / f64::from(samples.max(1)) - 1.0;
        if samples >= first && (0.3..0.7).contains(&of_batch) {
            calls += 1;
            if calls == call {
                finished_at = Some(samples);
                return Decision::Finish;
            }
        }
        Decision::GoOn
    };
    let early = view.watched(headless, &buffers, layers, watch).unwrap();
    let least = finished_at.unwrap();
    assert_eq!(early.samples, least);
    let counts = early.image.samples().unwrap();
    let most = *counts.iter().max().unwrap();
    assert!(counts.contains(&least) && most > least, "{least} to {most}");
    for samples in least..=most {
        if !counts.contains(&samples) {
            continue;
        }
        view.settings.sampling.samples = samples;
        let whole = view.picture(headless, LayerSet::COLOR);
        let pixels = counts.iter().zip(early.image.color()).zip(whole.color());
        for ((count, found), wanted) in pixels {
            let is_same = found.map(f32::to_bits) == wanted.map(f32::to_bits);
            assert!(*count != samples || is_same, "{samples}: {found:?} {wanted:?}");
        }
    }
}

fn stopped(headless: &'static Headless) {
    let mut view = named("path_emissive_both");
    view.film = Film::new(1500, 1200).unwrap();
    let buffers = view.uploaded(headless, AccelChoice::Auto);
    for decision in [Decision::Stop, Decision::Finish] {
        let mut calls = 0;
        let watch = &mut |progress: &Progress| {
            calls += 1;
            if progress.samples == 0 { decision } else { Decision::GoOn }
        };
        let picture = view.watched(headless, &buffers, LayerSet::COLOR, watch);
        assert_eq!(picture.unwrap_err(), GpuError::Stopped, "{decision:?}");
        assert_eq!(calls, 1);
    }
}
