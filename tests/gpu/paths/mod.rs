//! What the checker says of the paths of this device, and of faults that are planted in it.

mod faults;
mod scenes;

use std::path::Path;

use libtest_mimic::{Failed, Trial};
use pinhole::accel::AccelChoice;
use pinhole::gpu::{Headless, HeadlessOptions, LitDecision, ShaderEdit};
use pinhole::verify::{Checker, PathCertificate, PathRecording};

use crate::headless;
use faults::Fault;
use scenes::LitView;

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (name, view) in scenes::all() {
        trials.push(Trial::test(format!("paths::legal::{name}"), move || legal(&view())));
    }
    for fault in faults::all() {
        let name = format!("paths::faults::{}", fault.name);
        trials.push(Trial::test(name, move || is_found(&fault)));
    }
    trials
}

fn record(headless: &Headless, view: &LitView) -> Result<PathRecording, Failed> {
    let LitView { scene, camera, film, lighting } = view;
    let accel = headless.plan(scene, AccelChoice::Auto).build(scene.spheres());
    let buffers = headless.upload_lit(scene, &accel)?;
    let go_on = &mut |_: &_| LitDecision::GoOn;
    let seen = (camera.as_ref(), film);
    Ok(headless.record_paths(scene, &buffers, seen, lighting, 0..2, go_on)?)
}

fn certify(view: &LitView, recording: &PathRecording) -> PathCertificate {
    Checker::new(&view.scene).unwrap().certify_paths(recording)
}

fn legal(view: &LitView) -> Result<(), Failed> {
    let certificate = certify(view, &record(headless()?, view)?);
    if certificate.is_legal() { Ok(()) } else { Err(certificate.to_string().into()) }
}

/// By the stage that it is a fault of.
fn is_found(fault: &Fault) -> Result<(), Failed> {
    let Fault { file, find, replace, stage, .. } = *fault;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders").join(file);
    if !std::fs::read_to_string(path)?.contains(find) {
        return Err(format!("{file} has no `{find}`").into());
    }
    let edit = ShaderEdit { file: file.into(), find: find.into(), replace: replace.into() };
    let options = HeadlessOptions { edits: vec![edit], ..HeadlessOptions::default() };
    let view = (fault.view)();
    let certificate = certify(&view, &record(&Headless::open(&options)?, &view)?);
    match certificate.violations.first() {
        None => Err(format!("the fault was not found: {certificate}").into()),
        Some(first) if first.stage != stage => Err(format!("elsewhere: {certificate}").into()),
        Some(_) => Ok(()),
    }
}
