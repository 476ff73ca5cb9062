//! Tests that the checker never accuses devices that conform to WGSL and yet round as they like, and that it accuses
//! those whose results are farther off. For more scenes, run `cargo bench --bench verify -- adversary 100`.

mod bias;
mod operations;
pub(crate) mod structures;

use std::sync::LazyLock;

use libtest_mimic::{Failed, Trial};
use pinhole::accel::AccelChoice;
use pinhole::gpu::{Decision, Headless, HeadlessOptions};
use pinhole::verify::{Certificate, Checker, LitCertificate, LitRecording, Outcome};
use pinhole::{Film, LayerSet, Scene, View};

use crate::any_rounding::{Adversary, Rounding};
use crate::planted::{self, planted};
use crate::support::effort::tries;
use crate::support::random_light::{self, RandomView};
use crate::{headless, light, paths, scenes, studio, support};

/// How many random lit scenes, and random studios, there are if all run.
const SEEDS: u32 = 10;

/// The longest side of pictures, which are cut to it.
const SIDE: u32 = 64;

/// Views whose pictures are also those of `render`, without a recording.
const RENDERED: [&str; 3] = ["three_spheres", "coincident_spheres", "on_the_wall_looking_in"];

/// Every operation of kernels of primary rays rounds as it likes.
const ALL: Adversary = Adversary::new(Rounding::EachItsOwn, 1);

/// A third of the operations of other kernels do, because Mesa compiles them for long.
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
    Headless::open(&options).map_err(|error| error.to_string())
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
    for (name, view) in scenes::all() {
        trials.push(Trial::test(format!("adversary::primary::{name}"), move || {
            not_accused(certify(&PRIMARY, &view, RENDERED.contains(&name))?.outcome_in_words())
        }));
    }
    for (name, view) in lit_views() {
        trials.push(Trial::test(format!("adversary::{name}"), move || {
            not_accused(certify_lit(&LIT, &view())?.outcome_in_words())
        }));
    }
    trials.push(Trial::test("adversary::sixty_ulp_are_found", found));
    trials.push(Trial::test("adversary::structures_agree", structures::agree));
    trials.push(Trial::test("bias::none_without_a_fault", bias::clean));
    trials.extend(planted::trials("bias::", planted("small"), bias::is_noted));
    trials
}

pub(crate) type Lazy<T> = Box<dyn FnOnce() -> T + Send>;

/// All lit scenes of the tests that a device of its own bits is legal, and random ones.
pub(crate) fn lit_views() -> Vec<(String, Lazy<RandomView>)> {
    let mut views: Vec<(String, Lazy<RandomView>)> = Vec::new();
    let name = String::new;
    for (of, view) in paths::scenes::all() {
        let view = move || {
            let crate::light::scenes::LitView { scene, camera, film, settings } = view();
            RandomView { scene, camera, film, settings, name: name() }
        };
        views.push((format!("paths::{of}"), Box::new(view)));
    }
    let studios = light::scenes::studios().into_iter();
    let more = studio::scenes::ALL.iter().map(|(name, view)| (*name, view()));
    for (of, view) in studios.chain(more) {
        let light::scenes::LitView { scene, camera, film, settings } = view;
        let view = RandomView { scene, camera, film, settings, name: name() };
        views.push((format!("studio::{of}"), Box::new(move || view)));
    }
    for seed in 0..u64::from(tries(SEEDS)) {
        views.push((format!("random::paths_{seed}"), Box::new(move || random_light::view(seed))));
        views
            .push((format!("random::studio_{seed}"), Box::new(move || random_light::studio(seed))));
    }
    views
}

trait InWords {
    /// The outcome, and the certificate in words.
    fn outcome_in_words(self) -> (Outcome, String);
}

impl InWords for Certificate {
    fn outcome_in_words(self) -> (Outcome, String) {
        (self.outcome(), self.to_string())
    }
}

impl InWords for LitCertificate {
    fn outcome_in_words(self) -> (Outcome, String) {
        (self.outcome(), self.to_string())
    }
}

fn not_accused((outcome, words): (Outcome, String)) -> Result<(), Failed> {
    println!("{words}");
    if outcome == Outcome::Violated { Err(words.into()) } else { Ok(()) }
}

fn go_on() -> impl FnMut(&pinhole::gpu::Progress) -> Decision {
    |_: &_| Decision::GoOn
}

/// Certifies a view that is cut to a small picture, and perhaps also what `render` makes of it.
fn certify(
    device: &Device,
    view: &support::View,
    is_rendered: bool,
) -> Result<Certificate, Failed> {
    let headless = device.as_ref()?;
    if !is_rendered {
        return certify_on(headless, view, SIDE, AccelChoice::Auto);
    }
    let support::View { scene, camera, film, settings } = view;
    let film = cut(film, SIDE)?;
    Ok(headless.verify(scene, &View::new(camera.as_ref(), film), settings)?)
}

fn cut(film: &Film, side: u32) -> Result<Film, Failed> {
    let film =
        Film::new(film.width().min(side), film.height().min(side))?.with_y_axis(film.y_axis());
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
    let buffers = upload(headless, scene, &seen, settings, choice)?;
    let recording = headless.record(&buffers, &seen, settings, &mut go_on())?;
    Ok(Checker::new(scene)?.certify(&recording))
}

fn upload(
    headless: &Headless,
    scene: &Scene,
    seen: &View<'_>,
    settings: &pinhole::RenderSettings,
    choice: AccelChoice,
) -> Result<pinhole::gpu::SceneBuffers, Failed> {
    let plan = headless.plan(scene, seen, settings, LayerSet::DATA, choice, 0);
    Ok(headless.upload(scene, &plan.build(scene))?)
}

fn certify_lit(device: &Device, view: &RandomView) -> Result<LitCertificate, Failed> {
    certify_lit_on(device.as_ref()?, view, &[0, 1], AccelChoice::Auto)
}

pub(crate) fn certify_lit_on(
    headless: &Headless,
    view: &RandomView,
    samples: &[u32],
    choice: AccelChoice,
) -> Result<LitCertificate, Failed> {
    let RandomView { scene, camera, film, settings, .. } = view;
    let seen = View::new(camera.as_ref(), *film);
    let buffers = upload(headless, scene, &seen, settings, choice)?;
    let checker = Checker::new(scene)?;
    let mut certificate = LitCertificate::default();
    let each = &mut |recording: LitRecording<'_>| certificate.join(checker.certify_lit(recording));
    headless.record_lit(&buffers, &seen, settings, samples, (each, &mut go_on()))?;
    Ok(certificate)
}

/// Devices whose results are farther off are accused, in every kind of stage.
fn found() -> Result<(), Failed> {
    let primary = certify(&FAULTY, &support::View::three_spheres(), false)?;
    println!("{primary}");
    let paths = certify_lit(&FAULTY, &random_light::view(1))?;
    let studio = certify_lit(&FAULTY, &random_light::studio(1))?;
    println!("{paths}\n{studio}");
    for certificate in [&paths, &studio] {
        let mut stages: Vec<_> =
            certificate.violations.iter().map(|violation| violation.stage).collect();
        stages.dedup();
        println!("{stages:?}");
    }
    let counts = [primary.violations.len() as u64, paths.violation_count, studio.violation_count];
    match counts.iter().all(|count| *count > 20) {
        true => Ok(()),
        false => Err(format!("violations of primary rays, paths and studio: {counts:?}").into()),
    }
}
