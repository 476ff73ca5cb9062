//! Certificates of denoised pictures: the reference is never accused, and other filters are found.

use pinhole::camera::PinholeCamera;
use pinhole::image::denoise::GUIDES;
use pinhole::render::{Integrator, PathTracing, Sampling};
use pinhole::verify::Outcome;
use pinhole::verify::denoised::certify;
use pinhole::{Film, Image, LinearRgb, RenderSettings, Scene, Sphere, View, cpu};

use crate::support::spheres;

fn noisy(samples: u32, seed: u32) -> Image {
    let colored = |(i, [x, y, z, r]): (usize, &[f32; 4])| {
        let level = |k: usize| ((i * k) % 7) as f32 / 7.0;
        let color = LinearRgb::new([level(3), level(5), level(2)]).unwrap();
        Sphere::new([*x, *y, *z].map(f64::from), f64::from(*r), color)
    };
    let spheres = spheres::random(30, 1, |rng| 0.1 + 0.2 * rng.f32());
    let scene = Scene::new(&spheres.iter().enumerate().map(colored).collect::<Vec<_>>()).unwrap();
    let camera = PinholeCamera::framing_from_the_front(scene.subject(), 64.0 / 48.0).unwrap();
    let settings = RenderSettings {
        integrator: Integrator::Path(PathTracing::default()),
        sampling: Sampling { samples, seed, ..Sampling::default() },
        ..RenderSettings::default()
    };
    let film = Film::new(64, 48).unwrap();
    cpu::render(&scene, &View::new(&camera, film), &settings, GUIDES).unwrap()
}

#[test]
fn the_references_filter_is_proved() {
    for (samples, seed) in [(1, 0), (4, 1), (16, 2)] {
        let noisy = noisy(samples, seed);
        let found = certify(&noisy, &cpu::denoise(&noisy).unwrap()).unwrap();
        assert_eq!(found.outcome(), Outcome::Proved, "{samples}: {found:?}");
        assert_eq!(found.pixels, 64 * 48);
    }
}

#[test]
fn what_is_off_by_a_thousandth_is_found() {
    let noisy = noisy(4, 3);
    let denoised = cpu::denoise(&noisy).unwrap();
    let changed = |change: &dyn Fn(usize, f32) -> f32| {
        let colors = denoised.color().iter().enumerate();
        let color = colors.map(|(index, rgb)| rgb.map(|c| change(index, c))).collect();
        let count = denoised.color().len();
        let (depth, normal, id) = (vec![0.0; count], vec![[0.0; 3]; count], vec![0; count]);
        certify(&noisy, &Image::from_layers([64, 48], color, depth, normal, id).unwrap()).unwrap()
    };
    assert_eq!(changed(&|_, c| c).outcome(), Outcome::Proved);
    let found = changed(&|_, c| c * 1.001);
    assert!(found.violation_count > 2000, "{}", found.violation_count);
    let found = changed(&|index, c| if index == 64 * 24 + 30 { c + 0.01 } else { c });
    assert_eq!((found.violation_count, found.outcome()), (1, Outcome::Violated));
    assert!(found.violations[0].to_string().starts_with("pixel (30, 24): red is "));
    assert_eq!(changed(&|_, _| f32::NAN).outcome(), Outcome::Violated);
    // The noisy picture itself is none that was denoised.
    assert_eq!(certify(&noisy, &noisy).unwrap().outcome(), Outcome::Violated);
}
