//! Tests that the checker accepts the paths of this device, and finds faults that are inserted.

mod inputs;
mod random;
pub(crate) mod scenes;

use libtest_mimic::{Failed, Trial};
use pinhole::accel::{Accel, AccelChoice, AccelPlan, Brick};
use pinhole::camera::OrthographicCamera;
use pinhole::gpu::{Decision, GpuError, Headless, SceneBuffers};
use pinhole::verify::{Checker, LitCertificate, LitRecording, PathRecording};
use pinhole::{Film, View};

use crate::light::scenes::LitView;
use crate::lit::{is_found, is_legal, is_violated};
use crate::planted::{self, planted};
use crate::{headless, replayed, trial};

/// Maximum size of a binding in bytes for which a scene of 300 spheres has four bricks.
const SMALL_BINDING: u64 = 16 * 100;

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (name, view) in scenes::all() {
        trials.push(Trial::test(format!("paths::legal::{name}"), move || legal(&view())));
    }
    for choice in [AccelChoice::List, AccelChoice::Grid, AccelChoice::Tree] {
        let name = format!("paths::legal::in_a_{choice:?}").to_lowercase();
        trials.push(Trial::test(name, move || legal_in(choice, 1 << 27)));
    }
    trials.push(Trial::test("paths::legal::in_bricks", || {
        legal_in(AccelChoice::List, SMALL_BINDING)
    }));
    for choice in [AccelChoice::List, AccelChoice::Grid, AccelChoice::Tree] {
        let name = format!("paths::legal::equal_spheres_in_bricks_{choice:?}").to_lowercase();
        trials.push(Trial::test(name, move || {
            let view = scenes::thrice();
            let accel = in_bricks(&view, choice);
            is_legal(&certify(&view, &record_in(headless()?, &view, accel)?))
        }));
    }
    let group = "paths::faults::";
    trials.extend(planted::trials(group, planted("paths"), |fault| {
        let certify = |device: &_, view: &_| Ok(certify(view, &record(device, view)?));
        is_found(fault, &scenes::of_faults(), certify)
    }));
    trials.extend(planted::trials(group, planted("paths_by_id"), |fault| {
        is_found(fault, &[("thrice", scenes::thrice)], |device, view| {
            let accel = in_bricks(view, AccelChoice::Tree);
            Ok(certify(view, &record_in(device, view, accel)?))
        })
    }));
    for (name, spoil) in inputs::ALL {
        let name = format!("paths::faults::input_{name}");
        trials.push(Trial::test(name, move || input_fault_is_found(*spoil)));
    }
    trials.push(Trial::test("paths::faults::film_of_one_pixel_more", part_of_a_large_film));
    trials.extend(random::trials());
    trials.push(trial("paths::stops_when_told", stops_when_told));
    trials
}

fn record(headless: &Headless, view: &LitView) -> Result<PathRecording, Failed> {
    let spheres = view.scene.spheres();
    record_in(headless, view, headless.plan_accel(&view.scene, AccelChoice::Auto).build(spheres))
}

fn record_in(headless: &Headless, view: &LitView, accel: Accel) -> Result<PathRecording, Failed> {
    let buffers = headless.upload(&view.scene, &accel.into())?;
    Ok(recorded(headless, &buffers, view, &[0, 1])?)
}

/// Records samples of all paths.
pub(crate) fn recorded(
    headless: &Headless,
    buffers: &SceneBuffers,
    LitView { camera, film, settings, .. }: &LitView,
    samples: &[u32],
) -> Result<PathRecording, GpuError> {
    let mut all: Option<PathRecording> = None;
    let mut each = |recording: LitRecording<'_>| {
        let LitRecording::Paths(one) = recording else { panic!("not of paths") };
        match &mut all {
            None => all = Some(one.clone()),
            Some(all) => all.samples.extend(one.samples.iter().cloned()),
        }
    };
    let go_on = &mut |_: &_| Decision::GoOn;
    let view = View::new(camera.as_ref(), *film);
    headless.record_lit(buffers, &view, settings, samples, (&mut each, go_on))?;
    Ok(all.unwrap())
}

fn certify(view: &LitView, recording: &PathRecording) -> LitCertificate {
    let certificate = Checker::new(&view.scene).unwrap().certify_paths(recording);
    replayed::gives(&view.scene, LitRecording::Paths(recording), &certificate);
    certificate
}

fn legal(view: &LitView) -> Result<(), Failed> {
    is_legal(&certify(view, &record(headless()?, view)?))
}

/// Paths are legal with every structure.
fn legal_in(choice: AccelChoice, binding_bytes: u64) -> Result<(), Failed> {
    let view = scenes::many();
    let spheres = view.scene.spheres();
    let accel = AccelPlan::new(spheres, choice, binding_bytes).build(spheres);
    is_legal(&certify(&view, &record_in(headless()?, &view, accel)?))
}

/// Paths are legal in several bricks between which equal spheres are divided.
fn in_bricks(view: &LitView, choice: AccelChoice) -> Accel {
    let spheres = view.scene.spheres();
    let accel = AccelPlan::new(spheres, choice, SMALL_BINDING).build(spheres);
    let brick_of = |sphere: &[f32; 4]| {
        let place = |brick: &Brick| brick.spheres.iter().any(|other| other[..3] == sphere[..3]);
        accel.bricks().iter().filter(|brick| place(brick)).count()
    };
    assert!(spheres.iter().any(|sphere| brick_of(sphere) > 1), "none is in several");
    accel
}

/// The device was given other inputs than the requested ones.
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

/// For a large film the rectangle in the middle is recorded. Its paths are not legal for another rectangle.
fn part_of_a_large_film() -> Result<(), Failed> {
    let pose = pinhole::camera::Pose::looking_at([0.5, 1.5, 7.0], [0.0; 3], [0.1, 1.0, 0.0])?;
    let camera = OrthographicCamera::new(pose, [5.0, 4.5])?;
    let film = Film::new(300, 270)?;
    let view = LitView { camera: Box::new(camera), film, ..scenes::matt() };
    let mut recording = record(headless()?, &view)?;
    if recording.given.origin != [38, 23] || recording.given.size != [224, 224] {
        return Err(format!("{:?}, {:?}", recording.given.origin, recording.given.size).into());
    }
    is_legal(&certify(&view, &recording))?;
    recording.given.origin[0] += 1;
    is_violated(&certify(&view, &recording))
}

fn stops_when_told(headless: &'static Headless) {
    let view = scenes::matt();
    let accel = headless.plan_accel(&view.scene, AccelChoice::Auto).build(view.scene.spheres());
    let buffers = headless.upload(&view.scene, &accel.into()).unwrap();
    let stop = &mut |_: &_| Decision::Stop;
    let each = &mut |_: LitRecording<'_>| {};
    let stopped = headless.record_lit(&buffers, &view.seen(), &view.settings, &[0], (each, stop));
    assert_eq!(stopped.unwrap_err(), GpuError::Stopped);
}
