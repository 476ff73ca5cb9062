//! Pictures in files, and denoised pictures. Those of a conforming device are never accused, and planted faults are
//! found.

use pinhole::camera::{PinholeCamera, Pose};
use pinhole::image::denoise::GUIDES;
use pinhole::image::encoding::Bits;
use pinhole::image::tone::ToneCurve;
use pinhole::render::{PathTracing, PrimarySettings, Sampling};
use pinhole::verify::denoised::certify;
use pinhole::verify::written::{Samples, WrittenCertificate, WrittenPicture};
use pinhole::verify::{Checker, Outcome, Verdict};
use pinhole::{Encoding, Film, Image, Integrator, LayerSet, LinearRgb, RenderSettings, Scene, Shading, View, cpu};
use pinhole_figure::write::png;

use crate::scene::colored;
use crate::support::spheres;

/// Every kind of encoding.
fn encodings() -> Vec<Encoding> {
    let plain = Encoding::default();
    let exposed = |tone| {
        let mut exposed = plain.with_exposure(-0.7).unwrap();
        exposed.tone = tone;
        exposed
    };
    let fine = |mut encoding: Encoding| {
        encoding.bits = Bits::Sixteen;
        encoding
    };
    let mut over_white = exposed(ToneCurve::Agx);
    over_white.background = Some(LinearRgb::WHITE);
    vec![
        plain,
        fine(plain),
        fine(exposed(ToneCurve::None)),
        fine(exposed(ToneCurve::Filmic)),
        exposed(ToneCurve::Agx),
        over_white,
    ]
}

fn certified(
    checker: &Checker<'_>,
    view: &View<'_>,
    primary: &PrimarySettings,
    (encoding, bytes): (&Encoding, &[u8]),
) -> WrittenCertificate {
    let size = [view.film.width(), view.film.height()];
    let picture = WrittenPicture { size, samples: Samples::Encoded(bytes), encoding };
    checker.certify_written(view, primary, &picture).unwrap()
}

fn linear(image: &Image) -> Vec<[f32; 4]> {
    image.color().iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect()
}

/// Checks that a device's picture is not accused, neither as light nor in one of the encodings.
pub(crate) fn assert_is_not_accused(name: &str, scene: &Scene, view: &View<'_>, image: &Image) {
    let checker = Checker::new(scene).unwrap();
    let primary = PrimarySettings::default();
    let linear = linear(image);
    let size = [image.width(), image.height()];
    let plain = Encoding::default();
    let picture = WrittenPicture { size, samples: Samples::Linear(&linear), encoding: &plain };
    let found = checker.certify_written(view, &primary, &picture).unwrap();
    assert_eq!(found.violations, [], "{name}, linear");
    let encodings = encodings();
    let encoding = &encodings[(image.color()[0][0].to_bits() as usize + name.len()) % 4];
    let bytes = png::samples(image, encoding).unwrap();
    let found = certified(&checker, view, &primary, (encoding, &bytes));
    assert_eq!(found.violations, [], "{name}, {encoding:?}");
}

fn scene() -> Scene {
    let spheres = spheres::random(60, 1, |rng| 0.02 + 0.1 * rng.f32());
    colored(&spheres, |i| [3, 5, 7].map(|k| ((i * k) % 17 + 1) as f32 / 18.0))
}

fn camera(scene: &Scene) -> PinholeCamera {
    let bounds = scene.bounds_to_frame();
    let eye = bounds.center() + pinhole::glam::DVec3::new(0.9, 0.5, 1.4) * bounds.size().max_element();
    let pose = Pose::looking_at(eye, bounds.center(), [0.1, 1.0, 0.2]).unwrap();
    PinholeCamera::with_vertical_fov(pose, 0.7, 1.3).unwrap()
}

fn film() -> Film {
    Film::new(78, 60).unwrap()
}

fn settings(shading: Shading, is_transparent: bool) -> RenderSettings {
    let background = LinearRgb::new([0.2, 0.5, 0.9]).unwrap();
    let integrator = Integrator::Primary(shading);
    RenderSettings { integrator, background, is_transparent, ..RenderSettings::default() }
}

/// Bytes of the reference's picture, with the data for judging them.
struct Picture {
    scene: Scene,
    camera: PinholeCamera,
    settings: RenderSettings,
    encoding: Encoding,
    image: Image,
    bytes: Vec<u8>,
}

impl Picture {
    fn new(settings: RenderSettings, mut encoding: Encoding) -> Self {
        let scene = scene();
        let camera = camera(&scene);
        encoding.background = encoding.background.and(settings.visible_background());
        encoding.transparent = settings.is_transparent;
        let layers = encoding.layers();
        let image = cpu::render(&scene, &View::new(&camera, film()), &settings, layers).unwrap();
        let bytes = png::samples(&image, &encoding).unwrap();
        Self { scene, camera, settings, encoding, image, bytes }
    }

    fn plain() -> Self {
        Self::new(settings(Shading::Headlight, false), Encoding::default())
    }

    fn judge(&self, bytes: &[u8]) -> WrittenCertificate {
        let checker = Checker::new(&self.scene).unwrap();
        let primary = self.settings.primary().unwrap();
        certified(&checker, &View::new(&self.camera, film()), &primary, (&self.encoding, bytes))
    }
}

#[test]
fn the_references_picture_is_proved_in_every_encoding() {
    for shading in [Shading::Headlight, Shading::Flat] {
        for is_transparent in [false, true] {
            for encoding in encodings() {
                let made = Picture::new(settings(shading, is_transparent), encoding);
                let found = made.judge(&made.bytes);
                let name = format!("{shading:?}, {is_transparent}, {encoding:?}");
                assert_eq!(found.outcome(), Outcome::Proved, "{name}: {:?}", found.violations.first());
                assert!(found.count(Verdict::Decided) > 4600, "{name}: {found:?}");
            }
        }
    }
}

/// The legal range of a byte is narrow: nearly every byte that is two steps away is not legal.
#[test]
fn a_byte_two_steps_away_is_found() {
    let made = Picture::plain();
    let mut brighter = made.bytes.clone();
    brighter.iter_mut().for_each(|byte| *byte = byte.saturating_add(2));
    let found = made.judge(&brighter);
    assert!(found.count(Verdict::Violation) > 4200, "{}", found.count(Verdict::Violation));
    let one = 3 * (78 * 30 + 39);
    let mut spoilt = made.bytes.clone();
    spoilt[one + 1] ^= 8;
    let found = made.judge(&spoilt);
    assert_eq!(found.violations.len(), 1);
    let violation = &found.violations[0];
    assert_eq!((violation.pixel, violation.channel), ([39, 30], 1));
    assert!(violation.to_string().starts_with("pixel (39, 30): green is "), "{violation}");
}

#[test]
fn pictures_of_another_size_are_refused() {
    let made = Picture::plain();
    let checker = Checker::new(&made.scene).unwrap();
    let view = View::new(&made.camera, film());
    let primary = PrimarySettings::default();
    let judged = |size, bytes| {
        let samples = Samples::Encoded(bytes);
        checker.certify_written(&view, &primary, &WrittenPicture { size, samples, encoding: &made.encoding })
    };
    let error = judged([60, 78], &made.bytes).unwrap_err().to_string();
    assert_eq!(error, "the picture is 60x78 pixels, but the view is 78x60");
    let error = judged([78, 60], &made.bytes[1..]).unwrap_err().to_string();
    let (found, expected) = (made.bytes.len() - 1, made.bytes.len());
    assert_eq!(error, format!("the picture has {found} samples; {expected} are expected"));
}

#[test]
fn linear_light_is_judged_more_narrowly_than_bytes() {
    let made = Picture::new(settings(Shading::Headlight, false), Encoding::default());
    let view = View::new(&made.camera, film());
    let image = cpu::render(&made.scene, &view, &made.settings, LayerSet::COLOR).unwrap();
    assert_eq!(image.color(), made.image.color());
    let checker = Checker::new(&made.scene).unwrap();
    let primary = made.settings.primary().unwrap();
    let judged = |factor: f32| {
        let mut pixels = linear(&image);
        pixels.iter_mut().for_each(|pixel| (0..3).for_each(|i| pixel[i] *= factor));
        let samples = Samples::Linear(&pixels);
        let picture = WrittenPicture { size: [78, 60], samples, encoding: &made.encoding };
        checker.certify_written(&view, &primary, &picture).unwrap()
    };
    assert_eq!(judged(1.0).outcome(), Outcome::Proved);
    let found = judged(1.0 + 3e-5);
    assert!(found.count(Verdict::Violation) > 3000, "{}", found.count(Verdict::Violation));
}

fn noisy(samples: u32, seed: u32) -> Image {
    let spheres = spheres::random(30, 1, |rng| 0.1 + 0.2 * rng.f32());
    let scene = colored(&spheres, |i| [3, 5, 2].map(|k| ((i * k) % 7) as f32 / 7.0));
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
    // The noisy picture itself is not accepted as denoised.
    assert_eq!(certify(&noisy, &noisy).unwrap().outcome(), Outcome::Violated);
}
