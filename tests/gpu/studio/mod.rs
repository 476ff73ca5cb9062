//! Tests that the checker accepts the studios of this device, and finds faults that are inserted.

mod inputs;
pub(crate) mod scenes;

use libtest_mimic::{Failed, Trial};
use pinhole::LayerSet;
use pinhole::accel::{Accel, AccelChoice, AccelPlan};
use pinhole::gpu::{Decision, Headless, SceneBuffers};
use pinhole::verify::{Checker, LitCertificate, LitRecording, StudioRecording};

use crate::headless;
use crate::light::scenes::{LitView, studios};
use crate::lit::{is_found, is_legal, is_violated};
use crate::planted::{self, planted};
use crate::replayed;
use crate::support::effort::tries;
use crate::support::random_light;

/// Maximum size of a binding in bytes for which a scene of 300 spheres has four bricks.
const SMALL_BINDING: u64 = 16 * 100;

/// How many random scenes there are if all run, with one test for each.
const SEEDS: u32 = 48;

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (name, view) in studios() {
        trials.push(Trial::test(format!("studio::legal::{name}"), move || legal(&view)));
    }
    for (name, view) in scenes::ALL {
        trials.push(Trial::test(format!("studio::legal::{name}"), move || legal(&view())));
    }
    for choice in [AccelChoice::List, AccelChoice::Grid, AccelChoice::Tree] {
        let name = format!("studio::legal::in_a_{choice:?}").to_lowercase();
        trials.push(Trial::test(name, move || legal_in(choice, 1 << 27)));
    }
    trials.push(Trial::test("studio::legal::in_bricks", || {
        legal_in(AccelChoice::List, SMALL_BINDING)
    }));
    for seed in 0..u64::from(tries(SEEDS)) {
        trials.push(Trial::test(format!("studio::random::seed_{seed}"), move || random(seed)));
    }
    trials.extend(planted::trials("studio::faults::", planted("studio"), |fault| {
        let certify = |device: &_, view: &_| Ok(certify(view, &record(device, view)?));
        is_found(fault, scenes::ALL, certify)
    }));
    for (name, spoil) in inputs::ALL {
        let name = format!("studio::faults::input_{name}");
        trials.push(Trial::test(name, move || input_fault_is_found(*spoil)));
    }
    trials
}

/// The samples that are recorded: the first, one in between, and the last of a picture of many.
const SAMPLES: [u32; 3] = [0, 37, 63];

fn record(headless: &Headless, view: &LitView) -> Result<StudioRecording, Failed> {
    let (scene, layers) = (&view.scene, LayerSet::COLOR);
    let plan = headless.plan(scene, &view.seen(), &view.settings, layers, AccelChoice::Auto, 0);
    record_from(headless, &headless.upload(scene, &plan.build(scene))?, view)
}

fn record_in(headless: &Headless, view: &LitView, accel: Accel) -> Result<StudioRecording, Failed> {
    record_from(headless, &headless.upload(&view.scene, &accel.into())?, view)
}

/// Records some samples.
fn record_from(
    headless: &Headless,
    buffers: &SceneBuffers,
    view: &LitView,
) -> Result<StudioRecording, Failed> {
    let mut all: Option<StudioRecording> = None;
    let each = &mut |recording: LitRecording<'_>| {
        let LitRecording::Studio(one) = recording else { panic!("not of a studio") };
        match &mut all {
            None => all = Some(one.clone()),
            Some(all) => all.samples.extend(one.samples.iter().cloned()),
        }
    };
    let go_on = &mut |_: &_| Decision::GoOn;
    headless.record_lit(buffers, &view.seen(), &view.settings, &SAMPLES, (each, go_on))?;
    Ok(all.unwrap())
}

fn certify(view: &LitView, recording: &StudioRecording) -> LitCertificate {
    let certificate = Checker::new(&view.scene).unwrap().certify_studio(recording);
    replayed::gives(&view.scene, LitRecording::Studio(recording), &certificate);
    certificate
}

fn legal(view: &LitView) -> Result<(), Failed> {
    is_legal(&certify(view, &record(headless()?, view)?))
}

/// Studios are legal with every structure.
fn legal_in(choice: AccelChoice, binding_bytes: u64) -> Result<(), Failed> {
    let view = scenes::many();
    let spheres = view.scene.spheres();
    let accel = AccelPlan::new(spheres, choice, binding_bytes).build(spheres);
    is_legal(&certify(&view, &record_in(headless()?, &view, accel)?))
}

/// Random scenes in random studios are legal. For more scenes, run `cargo bench --bench verify -- studio-campaign 500`.
fn random(seed: u64) -> Result<(), Failed> {
    let random_light::RandomView { scene, camera, film, settings, name } =
        random_light::studio(seed);
    let view = LitView { scene, camera, film, settings };
    let certificate = certify(&view, &record(headless()?, &view)?);
    let stages = certificate.stages();
    println!("seed {seed}: {name}: {certificate}");
    if certificate.is_legal() && stages.decided + stages.open > stages.checked / 10 * 9 {
        Ok(())
    } else {
        let named = certificate.named();
        Err(format!("seed {seed}: {name}: {certificate}\n{named:#?}").into())
    }
}

/// The device was given other inputs than the requested ones, or the recording is damaged.
fn input_fault_is_found(spoil: inputs::Spoil) -> Result<(), Failed> {
    let view = inputs::view();
    let mut given = inputs::view();
    let mut spoilt = None;
    match spoil {
        inputs::Spoil::Given(change) => change(&mut given),
        inputs::Spoil::Said(change) => spoilt = Some(change),
    }
    let mut recording = record(headless()?, &given)?;
    recording.given.settings = view.settings.clone();
    if let Some(change) = spoilt {
        change(&mut recording);
    }
    is_violated(&certify(&view, &recording))
}
