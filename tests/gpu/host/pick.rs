//! What is at a pixel, some frames later.

use libtest_mimic::Trial;
use pinhole::Film;
use pinhole::gpu::{Headless, PickError, Picker, Targets, wgpu};

use super::depth_out::pixel_is_near_a_silhouette;
use super::stage::{SIZE, Stage};
use crate::support::hosts::Convention;
use crate::trial;

pub(crate) fn trials() -> Vec<Trial> {
    vec![
        trial("host::pick::gives_id_distance_and_place", picks),
        trial("host::pick::what_cannot_be_picked_is_an_error", errors),
    ]
}

fn wait(stage: &Stage) {
    stage.host.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
}

fn picks(_: &'static Headless) {
    for convention in [Convention::Perspective, Convention::OrthographicReversed] {
        let stage = Stage::new(convention);
        let mut picker = Picker::new(&stage.host.device, 3).unwrap();
        let mut random = fastrand::Rng::with_seed(5);
        let (mut hits, mut asked) = (0, Vec::new());
        for frame in 0..120 {
            let mut encoder = stage.host.encoder();
            stage.trace(&mut encoder);
            let pixel = [random.u32(0..SIZE[0]), random.u32(0..SIZE[1])];
            stage
                .layers
                .with(|targets| picker.record(&mut encoder, targets, &stage.view(), pixel))
                .unwrap();
            asked.push(pixel);
            // Nothing is there before the submission.
            if asked.len() == 1 {
                assert_eq!(picker.take(), Ok(None));
            }
            stage.host.queue.submit([encoder.finish()]);
            // The program waits only now and then.
            if frame % 3 == 2 {
                wait(&stage);
                for pixel in asked.drain(..) {
                    let picked = picker.take().unwrap().unwrap();
                    assert_eq!(picked.pixel, pixel);
                    if pixel_is_near_a_silhouette(&stage, pixel) {
                        continue;
                    }
                    let truth = stage.truth(pixel);
                    assert_eq!(picked.hit.map(|hit| hit.id as usize), truth.map(|truth| truth.id));
                    let Some((hit, truth)) = picked.hit.zip(truth) else { continue };
                    assert!((f64::from(hit.distance) - truth.distance).abs() < 1e-4);
                    assert!((hit.place - truth.point).length() < 1e-4);
                    hits += 1;
                }
                assert_eq!(picker.take(), Ok(None));
            }
        }
        assert!(hits > 20, "{hits}");
    }
}

fn errors(_: &'static Headless) {
    let stage = Stage::new(Convention::Perspective);
    let mut picker = Picker::new(&stage.host.device, 2).unwrap();
    let mut encoder = stage.host.encoder();
    stage.trace(&mut encoder);
    let mut record = |view: &pinhole::View<'_>, pixel, has_data| {
        stage.layers.with(|targets| {
            let data = targets.data.filter(|_| has_data);
            let targets = Targets { data, ..*targets };
            picker.record(&mut encoder, &targets, view, pixel)
        })
    };
    let view = stage.view();
    for pixel in [[SIZE[0], 0], [0, SIZE[1]], [u32::MAX, 0]] {
        assert_eq!(record(&view, pixel, true), Err(PickError::Outside { pixel, size: SIZE }));
    }
    assert_eq!(record(&view, [0, 0], false), Err(PickError::NoDataLayers));
    let other = pinhole::View::new(&stage.camera, Film::new(8, 9).unwrap());
    let refused = Err(PickError::OtherFilm { film: [8, 9], size: SIZE });
    assert_eq!(record(&other, [0, 0], true), refused);
    assert_eq!(record(&view, [0, 0], true), Ok(()));
    assert_eq!(record(&view, [1, 0], true), Ok(()));
    assert_eq!(record(&view, [2, 0], true), Err(PickError::Full { capacity: 2 }));
    // The commands are never executed.
    drop(encoder);
    assert_eq!(picker.take(), Err(PickError::Lost { pixel: [0, 0] }));
    assert_eq!(picker.take(), Err(PickError::Lost { pixel: [1, 0] }));
    assert_eq!(picker.take(), Ok(None));

    // The ring is usable again.
    let mut encoder = stage.host.encoder();
    stage.trace(&mut encoder);
    let pixel = [SIZE[0] / 2, SIZE[1] / 2];
    stage
        .layers
        .with(|targets| picker.record(&mut encoder, targets, &stage.view(), pixel))
        .unwrap();
    stage.host.queue.submit([encoder.finish()]);
    wait(&stage);
    assert_eq!(picker.take().unwrap().unwrap().pixel, pixel);
}
