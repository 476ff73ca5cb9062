//! Tests that results of a device without a fault are not to one side of the middle of their bounds, and that faults
//! which stay within the bounds are noted.

use libtest_mimic::Failed;
use pinhole::accel::AccelChoice;
use pinhole::gpu::Headless;
use pinhole::verify::{Deviations, LARGEST_MEAN};

use super::{certify_lit_on, certify_on};
use crate::planted::Fault;
use crate::{headless, scenes};

/// The mean deviations of a device without a fault are below this, where there are this many results.
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
    for (name, view) in super::lit_views() {
        if ["paths::lobes", "paths::metals", "paths::matt", "studio::lamps_of_all_kinds"]
            .contains(&name.as_str())
        {
            all.join(certify_lit_on(
                headless,
                &view(),
                &(0..8).collect::<Vec<_>>(),
                AccelChoice::Auto,
            )?);
        }
    }
    println!("{all}");
    Ok(all.deviations)
}

pub(super) fn clean() -> Result<(), Failed> {
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

/// A fault that is smaller than its bound is noted.
pub(super) fn is_noted(fault: &Fault) -> Result<(), Failed> {
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
