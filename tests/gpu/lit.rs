//! What tests of certificates of paths and of studios share.

use libtest_mimic::Failed;
use pinhole::gpu::Headless;
use pinhole::verify::{LitCertificate, Outcome};

use crate::light::scenes::LitView;
use crate::planted::{Fault, named};

/// Makes a view.
type Make = fn() -> LitView;

/// Asserts that the fault is found in the stage in which it was inserted.
pub(crate) fn is_found(
    fault: &Fault,
    views: &[(&str, Make)],
    certify: impl Fn(&Headless, &LitView) -> Result<LitCertificate, Failed>,
) -> Result<(), Failed> {
    let [view, stage] = fault.setup();
    let certificate = certify(&fault.device()?, &named(views, view)())?;
    println!("{certificate}");
    match certificate.violations.first() {
        None => Err(format!("the fault was not found: {certificate}").into()),
        Some(first) if format!("{:?}", first.stage) != stage => {
            Err(format!("elsewhere: {certificate}").into())
        }
        Some(_) => Ok(()),
    }
}

/// Asserts that a certificate is violated, and not only undecided.
pub(crate) fn is_violated(certificate: &LitCertificate) -> Result<(), Failed> {
    match certificate.outcome() {
        Outcome::Violated => Ok(()),
        _ => Err(format!("the fault was not found: {certificate}").into()),
    }
}

/// Asserts that a recording is legal, and that the check is meaningful: most stages have a single legal result.
pub(crate) fn is_legal(certificate: &LitCertificate) -> Result<(), Failed> {
    let stages = certificate.stages();
    let is_telling = stages.checked > 10_000
        && stages.decided + stages.open > stages.checked / 1000 * 999
        && stages.open < stages.checked / 20;
    println!("{certificate}");
    if certificate.is_legal() && is_telling {
        Ok(())
    } else {
        Err(format!("{certificate}\n{:#?}\n{certificate:#?}", certificate.named()).into())
    }
}
