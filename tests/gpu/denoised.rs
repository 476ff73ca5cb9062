//! Tests that the checker accepts what this device denoises, and finds faults that are inserted into the denoiser.

use libtest_mimic::{Failed, Trial};
use pinhole::gpu::Headless;
use pinhole::image::denoise::GUIDES;
use pinhole::verify::Outcome;
use pinhole::verify::denoised::{DenoiseCertificate, certify};

use crate::headless;
use crate::light::scenes::{LitView, paths, studios};
use crate::planted::{self, planted};

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (name, view) in studios().into_iter().chain(paths()) {
        trials.push(Trial::test(format!("denoised::legal::{name}"), move || {
            let found = denoised(headless()?, view)?;
            // From inside a sphere, similar pixels are so dark that one in a hundred is undecided.
            match found.violation_count == 0 && found.undecided <= found.pixels / 50 {
                true => Ok(()),
                false => Err(format!("{found:?}").into()),
            }
        }));
    }
    trials.extend(planted::trials("denoised::faults::", planted("denoised"), |fault| {
        let view = paths().swap_remove(1).1;
        let found = denoised(&fault.device()?, view)?;
        println!("{} of {} pixels", found.violation_count, found.pixels);
        match found.outcome() {
            Outcome::Violated => Ok(()),
            outcome => Err(format!("the fault was not found: {outcome}").into()),
        }
    }));
    trials
}

fn denoised(device: &Headless, mut view: LitView) -> Result<DenoiseCertificate, Failed> {
    view.settings.sampling.samples = 4;
    let noisy = device.render(&view.scene, &view.seen(), &view.settings, GUIDES)?;
    Ok(certify(&noisy, &device.denoise(&noisy)?)?)
}
