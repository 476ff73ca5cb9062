//! Tests with adversaries: conforming devices that round in arbitrary ways. The checker must never accuse them, but
//! must accuse devices with larger errors. For more scenes, run `cargo bench --bench verify -- adversary 100`.

mod operations;

use std::fmt::Display;
use std::sync::LazyLock;

use libtest_mimic::{Failed, Trial};
use pinhole::accel::{AccelChoice, AccelPlan};
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::gpu::{Headless, HeadlessOptions, SampleRequest, SelfTestExtent, Wait};
use pinhole::verify::{Certificate, Checker, Deviations, LARGEST_MEAN, LitCertificate, LitRecording, Outcome};
use pinhole::{Film, LinearRgb, RenderSettings, Scene, View};

use crate::any_rounding::{Adversary, Rounding};
use crate::pictures::go_on;
use crate::planted::{Fault, planted};
use crate::support::effort::{share, tries};
use crate::support::{random_light, spheres};
use crate::written::{finished, none_violated};
use crate::{headless, lit_scenes, planted, scenes, support};

/// Number of random lit scenes, and of random studios, if all run.
const SEEDS: u32 = 10;

/// Maximum length of a side of a picture. Larger pictures are cut.
const SIDE: u32 = 64;

/// Views that are also rendered by `render`, without a recording.
const RENDERED: [&str; 3] = ["three_spheres", "coincident_spheres", "on_the_wall_looking_in"];

/// Every operation of kernels of primary rays rounds arbitrarily.
const ALL: Adversary = Adversary::new(Rounding::EachItsOwn, 1);

/// In other kernels, a third of the operations do, because Mesa takes long to compile them.
const PART: Adversary = Adversary { share: 0.34, ..ALL };

/// The error in ULP of devices that do not conform.
const FAULT: u32 = 60;

/// A device that is opened when it is first used, and keeps its pipelines.
type Device = LazyLock<Result<Headless, String>>;

static PRIMARY: Device = LazyLock::new(|| open(ALL));
static LIT: Device = LazyLock::new(|| open(PART));
static FAULTY: Device = LazyLock::new(|| open(Adversary { fault: FAULT, ..PART }));

fn open(adversary: Adversary) -> Result<Headless, String> {
    let rewrite = Some(adversary.rewrite());
    let options = HeadlessOptions { rewrite, ..HeadlessOptions::default() };
    Headless::open(&options).wait().map_err(|error| error.to_string())
}

/// Judges where a device finds hits of rays with cones.
fn cones(adversary: Adversary) -> Result<(), Failed> {
    let report = open(adversary)?.self_test(SelfTestExtent::Full).wait()?;
    match report.properties().iter().find(|property| property.name == "cones") {
        Some(cones) if cones.passed() => Ok(()),
        other => Err(format!("{other:?}").into()),
    }
}

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for rounding in Rounding::ALL {
        let name = format!("adversary::operations::{rounding:?}").to_lowercase();
        trials.push(Trial::test(name, move || {
            operations::are_legal(headless()?, rounding);
            Ok(())
        }));
    }
    for rounding in Rounding::ALL {
        let name = format!("adversary::cones::{rounding:?}").to_lowercase();
        trials.push(Trial::test(name, move || cones(Adversary::new(rounding, 2))));
    }
    trials.push(Trial::test("adversary::cones::wrong", || match cones(Adversary { fault: FAULT, ..ALL }) {
        Ok(()) => Err("wrong results are legal".into()),
        Err(_) => Ok(()),
    }));
    for (name, view) in scenes::all() {
        trials.push(Trial::test(format!("adversary::primary::{name}"), move || {
            let certificate = certify(&PRIMARY, &view, RENDERED.contains(&name))?;
            not_accused(certificate.outcome(), &certificate)
        }));
    }
    for (name, view) in lit_views() {
        trials.push(Trial::test(format!("adversary::{name}"), move || {
            let certificate = certify_lit(&LIT, &view())?;
            not_accused(certificate.outcome(), &certificate)
        }));
    }
    for (name, view) in share(lit_views().into_iter()) {
        trials.push(Trial::test(format!("adversary::finished::{name}"), move || {
            let view = view();
            for is_finished in [false, true] {
                none_violated(&finished(LIT.as_ref()?, &view, is_finished)?)?;
            }
            Ok(())
        }));
    }
    trials.push(Trial::test("adversary::sixty_ulp_are_found", found));
    trials.push(Trial::test("adversary::structures_agree", structures_agree));
    trials.push(Trial::test("bias::none_without_a_fault", clean));
    trials.extend(planted::trials("bias::", planted("small"), is_noted));
    trials
}

pub(crate) type Lazy<T> = Box<dyn FnOnce() -> T + Send>;

/// All lit scenes whose samples are judged, and random ones.
pub(crate) fn lit_views() -> Vec<(String, Lazy<support::View>)> {
    let mut views: Vec<(String, Lazy<support::View>)> = Vec::new();
    for (suite, of) in [("paths", random_light::view as fn(u64) -> _), ("studio", random_light::studio)] {
        for name in lit_scenes::judged(suite) {
            let full = format!("{suite}::{name}");
            views.push((full, Box::new(move || lit_scenes::view(suite, &name))));
        }
        for seed in 0..u64::from(tries(SEEDS)) {
            views.push((format!("random::{suite}_{seed}"), Box::new(move || of(seed).into())));
        }
    }
    views
}

/// Asserts that a certificate, which is printed, is not violated.
pub(crate) fn not_accused(outcome: Outcome, words: &dyn Display) -> Result<(), Failed> {
    println!("{words}");
    if outcome == Outcome::Violated { Err(words.to_string().into()) } else { Ok(()) }
}

/// Certifies a view that is cut to a small picture, and the picture of `render` too if `is_rendered`.
fn certify(device: &Device, view: &support::View, is_rendered: bool) -> Result<Certificate, Failed> {
    let headless = device.as_ref()?;
    if !is_rendered {
        return certify_on(headless, view, SIDE, AccelChoice::Auto);
    }
    let support::View { scene, camera, film, settings } = view;
    let film = cut(film, SIDE)?;
    Ok(headless.verify(scene, &View::new(camera.as_ref(), film), settings).wait()?)
}

fn cut(film: &Film, side: u32) -> Result<Film, Failed> {
    let film = Film::new(film.width().min(side), film.height().min(side))?.with_y_axis(film.y_axis());
    Ok(film)
}

pub(crate) fn certify_on(
    headless: &Headless,
    view: &support::View,
    side: u32,
    choice: AccelChoice,
) -> Result<Certificate, Failed> {
    let support::View { scene, camera, film, settings } = view;
    let seen = View::new(camera.as_ref(), cut(film, side)?);
    let buffers = headless.upload(scene, &view.planned(headless, choice)).wait()?;
    let recording = headless.record(&buffers, &seen, settings, &mut go_on).wait()?;
    Ok(Checker::new(scene)?.certify(&recording))
}

fn certify_lit(device: &Device, view: &support::View) -> Result<LitCertificate, Failed> {
    certify_lit_on(device.as_ref()?, view, &[0, 1], AccelChoice::Auto)
}

pub(crate) fn certify_lit_on(
    headless: &Headless,
    view: &support::View,
    samples: &[u32],
    choice: AccelChoice,
) -> Result<LitCertificate, Failed> {
    let (scene, settings, seen) = (&view.scene, &view.settings, view.seen());
    let buffers = headless.upload(scene, &view.planned(headless, choice)).wait()?;
    let checker = Checker::new(scene)?;
    let mut certificate = LitCertificate::default();
    let each = &mut |recording: &LitRecording| certificate.join(checker.certify_lit(recording));
    headless.record_lit(&buffers, &seen, settings, SampleRequest::middle(samples), each, &mut go_on).wait()?;
    Ok(certificate)
}

/// Tests that devices with larger errors are accused, in every kind of stage.
fn found() -> Result<(), Failed> {
    let primary = certify(&FAULTY, &support::View::three_spheres(), false)?;
    println!("{primary}");
    let paths = certify_lit(&FAULTY, &random_light::view(1).into())?;
    let studio = certify_lit(&FAULTY, &random_light::studio(1).into())?;
    println!("{paths}\n{studio}");
    for certificate in [&paths, &studio] {
        let mut stages: Vec<_> = certificate.violations.iter().map(|violation| violation.stage).collect();
        stages.dedup();
        println!("{stages:?}");
    }
    let counts = [primary.violations.len() as u64, paths.violation_count, studio.violation_count];
    match counts.iter().all(|count| *count > 20) {
        true => Ok(()),
        false => Err(format!("violations of primary rays, paths and studio: {counts:?}").into()),
    }
}

static ALIKE: Device = Device::new(|| open(Adversary { is_alike: true, ..Adversary::new(Rounding::EachItsOwn, 3) }));

/// The bits of the distance and the id of every pixel's hit. `box_margin` is the margin of boxes for ray queries.
pub(crate) fn hits(
    headless: &Headless,
    scene: &Scene,
    view: &View<'_>,
    choice: AccelChoice,
    box_margin: f32,
) -> Result<Vec<(u32, u32)>, Failed> {
    let plan = AccelPlan::new(scene.spheres(), choice, 1 << 27);
    let plan = plan.with_box_margin(box_margin);
    let buffers = headless.upload(scene, &plan.build(scene.spheres()).into()).wait()?;
    let recording = headless.record(&buffers, view, &RenderSettings::default(), &mut go_on).wait()?;
    Ok(recording.pixels.iter().map(|pixel| (pixel.t.to_bits(), pixel.id)).collect())
}

/// Calls `test` with a view of a whole scene.
pub(crate) fn seen<T>(scene: &Scene, test: impl FnOnce(&View<'_>) -> Result<T, Failed>) -> Result<T, Failed> {
    let bounds = scene.bounds_to_frame();
    let (center, size) = (bounds.center(), bounds.size().max_element());
    let eye = center + pinhole::glam::DVec3::new(0.3, 0.2, 0.9) * size;
    let pose = Pose::looking_at(eye, center, [0.1, 1.0, 0.2])?;
    let camera = PinholeCamera::with_vertical_fov(pose, 0.6, 1.0)?;
    test(&View::new(&camera, Film::new(112, 112)?))
}

/// Tests that structures find the same hits as the list, to the bit.
pub(crate) fn agree(
    headless: &Headless,
    name: &str,
    spheres: spheres::Spheres,
    choices: &[AccelChoice],
) -> Result<(), Failed> {
    let scene = Scene::from_f32(spheres, LinearRgb::WHITE)?;
    seen(&scene, |view| {
        let expected = hits(headless, &scene, view, AccelChoice::List, 1.0)?;
        let count = expected.iter().filter(|(_, id)| *id != pinhole::image::NO_ID).count();
        println!("{name}: {count} hits");
        if count < 40 {
            return Err(format!("{name}: few hits").into());
        }
        for choice in choices {
            let found = hits(headless, &scene, view, *choice, 1.0)?;
            let different = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
            if different > 0 {
                return Err(format!("{name}: {different} hits differ in {choice:?}").into());
            }
        }
        Ok(())
    })
}

/// Tests small spheres in a large box, whose margin is not small beside them, and spheres that touch.
fn structures_agree() -> Result<(), Failed> {
    for (name, spheres) in [
        ("small", spheres::random(6000, 5, |_| 1e-3)),
        ("four decades", spheres::four_decades(3000)),
        ("a line that touches", spheres::line(300)),
        ("mirrored pairs", spheres::mirrored(1000)),
    ] {
        agree(ALIKE.as_ref()?, name, spheres, &[AccelChoice::Grid, AccelChoice::Tree])?;
    }
    Ok(())
}

/// The mean deviations of a device without a fault are below `CLEAN` if there are at least `MANY` results.
const CLEAN: f64 = LARGEST_MEAN / 2.0;
const MANY: u64 = 20_000;

/// The deviations of a picture of primary rays.
fn of_picture(headless: &Headless) -> Result<Deviations, Failed> {
    let mut scenes = scenes::all().into_iter();
    let (_, view) = scenes.find(|(name, _)| *name == "random_pinhole_y_up").unwrap();
    let certificate = certify_on(headless, &view, 160, AccelChoice::Auto)?;
    println!("{certificate}");
    Ok(certificate.deviations)
}

/// The deviations of paths between mirrors, and of studios.
fn of_light(headless: &Headless) -> Result<Deviations, Failed> {
    let mut all = pinhole::verify::LitCertificate::default();
    for (name, view) in lit_views() {
        if ["paths::lobes", "paths::metals", "paths::matt", "studio::lamps_of_all_kinds"].contains(&name.as_str()) {
            all.join(certify_lit_on(headless, &view(), &(0..8).collect::<Vec<_>>(), AccelChoice::Auto)?);
        }
    }
    println!("{all}");
    Ok(all.deviations)
}

fn clean() -> Result<(), Failed> {
    let headless = headless()?;
    let mut failed = Vec::new();
    for deviations in [of_picture(headless)?, of_light(headless)?] {
        for one in deviations.iter() {
            println!("{one}");
            if one.is_biased() || (one.count() >= MANY && one.mean().abs() > CLEAN) {
                failed.push(one.to_string());
            }
        }
    }
    if failed.is_empty() { Ok(()) } else { Err(failed.join("\n").into()) }
}

/// Tests that a fault that is smaller than its bound is noted.
fn is_noted(fault: &Fault) -> Result<(), Failed> {
    let headless = fault.device()?;
    let deviations = match fault.setup() {
        ["lit"] => of_light(&headless)?,
        ["primary"] => of_picture(&headless)?,
        other => return Err(format!("{other:?}").into()),
    };
    let biased: Vec<_> = deviations.biased().map(ToString::to_string).collect();
    println!("{}", biased.join("\n"));
    if biased.is_empty() { Err("nothing is biased".into()) } else { Ok(()) }
}
