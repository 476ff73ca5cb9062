//! Tests that the checker accepts what this device denoises, and finds faults that are inserted into the denoiser.

use libtest_mimic::{Failed, Trial};
use pinhole::gpu::Headless;
use pinhole::image::denoise::GUIDES;
use pinhole::verify::Outcome;
use pinhole::verify::denoised::{DenoiseCertificate, certify};

use crate::headless;
use crate::light::scenes::{LitView, paths, studios};
use crate::planted::faulty;

const FILE: &str = "primary/denoise.wgsl";

/// Faults: a name, and a text that is replaced by another.
const FAULTS: &[(&str, &str, &str)] = &[
    ("spline_of_another_width", "0.25, distance == 1", "0.26, distance == 1"),
    ("step_forgotten", "* i32(denoise_pass.step)", "* 1"),
    ("a_column_left_out", "dx <= last; dx++", "dx < last; dx++"),
    ("depths_count_less", "0.005 * distance", "0.0055 * distance"),
    ("tints_count_less", "400.0 * dot(tint, tint)", "300.0 * dot(tint, tint)"),
    ("normals_count_less", "alike = c16 * c16 /", "alike = c16 /"),
    ("variance_not_squared", "weight * weight * other.w", "weight * other.w"),
    ("variance_not_divided", "variance / (weights * weights)", "variance / weights"),
    ("noise_of_one_pixel", "(light.w + other.w)", "(light.w + light.w)"),
    ("change_not_squared", "exp(-change * change / noise)", "exp(-abs(change) / noise)"),
    ("edge_counts_twice", "* same, 0.0, !is_in)", "* same, 0.01, !is_in)"),
    ("a_thousandth_lost", "sum / weights,", "sum / (weights * 1.001),"),
    ("quiet_misses_filtered", "select(mean, light, is_quiet)", "mean"),
    (
        "brighter_by_a_pixel",
        "sum += weight * other.rgb;",
        "sum += weight * lights[min(index + 1u, arrayLength(&lights) - 1u)].rgb;",
    ),
];

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
    for (name, find, replace) in FAULTS {
        trials.push(Trial::test(format!("denoised::faults::{name}"), move || {
            let view = paths().swap_remove(1).1;
            let found = denoised(&faulty(FILE, find, replace)?, view)?;
            println!("{} of {} pixels", found.violation_count, found.pixels);
            match found.outcome() {
                Outcome::Violated => Ok(()),
                outcome => Err(format!("the fault was not found: {outcome}").into()),
            }
        }));
    }
    trials
}

fn denoised(device: &Headless, mut view: LitView) -> Result<DenoiseCertificate, Failed> {
    view.settings.sampling.samples = 4;
    let noisy = device.render(&view.scene, &view.seen(), &view.settings, GUIDES)?;
    Ok(certify(&noisy, &device.denoise(&noisy)?)?)
}
