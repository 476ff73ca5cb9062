//! What the checker says of the paths of this device, and of faults that are planted in it.

mod scenes;

use libtest_mimic::{Failed, Trial};
use pinhole::accel::AccelChoice;
use pinhole::gpu::{Headless, LitDecision};
use pinhole::verify::{Checker, PathCertificate, PathRecording};

use crate::headless;
use scenes::LitView;

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (name, view) in scenes::all() {
        trials.push(Trial::test(format!("paths::legal::{name}"), move || legal(&view())));
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
    println!("{certificate}\n{certificate:#?}");
    if certificate.is_legal() { Ok(()) } else { Err(certificate.to_string().into()) }
}
