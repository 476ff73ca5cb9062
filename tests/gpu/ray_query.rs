//! Tests that ray queries find the same hits as other structures. If the adapter has no ray queries, these tests count
//! as ignored. Debian's Mesa 22.3 has none. `tests/drivers/run.sh` runs the tests with other drivers.

use std::sync::LazyLock;

use libtest_mimic::{Failed, Trial};
use pinhole::accel::AccelChoice;
use pinhole::gpu::{GpuError, Headless, HeadlessOptions, LimitChoice, SceneBuffers, Wait};
use pinhole::{LinearRgb, Scene};

use crate::adversary::{agree, certify_lit_on, certify_on, hits, lit_views, not_accused, seen};
use crate::harness::trial_unless;
use crate::support::spheres;
use crate::{headless, scenes};

static DEVICE: LazyLock<Result<Headless, GpuError>> =
    LazyLock::new(|| Headless::open(&HeadlessOptions { ray_query: true, ..HeadlessOptions::default() }).wait());

/// Margins of boxes that are too small, as a multiple of the margin in use: the boxes cut spheres.
const TOO_SMALL: f32 = -60.0;

fn device() -> Result<&'static Headless, Failed> {
    DEVICE.as_ref().map_err(|error| error.to_string().into())
}

fn lacking(_: &'static Headless) -> Option<String> {
    let has_none = matches!(&*DEVICE, Err(GpuError::NoRayQuery));
    has_none.then(|| "this adapter has no ray queries".to_owned())
}

fn trial(name: &str, test: impl FnOnce() -> Result<(), Failed> + Send + 'static) -> Trial {
    trial_unless(format!("ray_query::{name}"), lacking, |_| test())
}

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = vec![
        trial("finds_what_the_list_finds", finds_the_same),
        trial("boxes_that_cut_spheres_are_found", cut_spheres_are_found),
        Trial::test("ray_query::a_device_without_them_says_so", refused),
    ];
    for (name, view) in scenes::all() {
        trials.push(trial(&format!("primary::{name}"), move || {
            let certificate = certify_on(device()?, &view, 96, AccelChoice::RayQuery)?;
            not_accused(certificate.outcome(), &certificate)
        }));
    }
    for (name, view) in lit_views() {
        trials.push(trial(&name, move || {
            let certificate = certify_lit_on(device()?, &view(), &[0, 1], AccelChoice::RayQuery)?;
            not_accused(certificate.outcome(), &certificate)
        }));
    }
    trials
}

/// Ray queries choose which spheres are tested. The results of the tests have the same bits.
fn finds_the_same() -> Result<(), Failed> {
    for (name, spheres) in [
        ("small", spheres::random(6000, 5, |_| 1e-3)),
        ("large", spheres::random(3000, 6, |rng| 0.02 + 0.1 * rng.f32())),
        ("four decades", spheres::four_decades(3000)),
        ("a line that touches", spheres::line(300)),
        ("mirrored pairs", spheres::mirrored(1000)),
        ("equal pairs", spheres::twice(1000)),
        ("coincident", spheres::coincident(50)),
    ] {
        agree(device()?, name, spheres, &[AccelChoice::RayQuery])?;
    }
    Ok(())
}

fn cut_spheres_are_found() -> Result<(), Failed> {
    let scene = Scene::from_f32(spheres::random(3000, 6, |_| 0.03), LinearRgb::WHITE)?;
    seen(&scene, |view| {
        let all = hits(device()?, &scene, view, AccelChoice::List, 1.0)?;
        let cut = hits(device()?, &scene, view, AccelChoice::RayQuery, TOO_SMALL)?;
        if all == cut { Err("no hit differs, although boxes cut spheres".into()) } else { Ok(()) }
    })
}

/// A device that was opened without ray queries, or that has none, returns an error that names them.
fn refused() -> Result<(), Failed> {
    let webgpu = HeadlessOptions { limits: LimitChoice::WebGpu, ..HeadlessOptions::default() };
    let scene = Scene::from_f32(spheres::random(300, 6, |_| 0.03), LinearRgb::WHITE)?;
    for headless in [headless()?, &Headless::open(&webgpu).wait()?] {
        let structures = headless.plan_accel(&scene, AccelChoice::RayQuery).build(scene.spheres());
        let refusal = headless.upload(&scene, &structures.into()).wait().map(|_: SceneBuffers| ());
        if refusal != Err(GpuError::NoRayQuery) {
            return Err(format!("{refusal:?}").into());
        }
    }
    Ok(())
}
