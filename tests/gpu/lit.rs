//! What tests of certificates of paths and of studios share.

use libtest_mimic::Failed;
use pinhole::gpu::Headless;
use pinhole::verify::{LitCertificate, LitStage, Outcome};

use crate::light::scenes::LitView;
use crate::planted::faulty;

/// A shader edit that is a fault, with a view in which it is visible, and the stage in which it must be found.
#[derive(Clone, Copy)]
pub(crate) struct Fault {
    pub(crate) name: &'static str,
    stage: LitStage,
    view: fn() -> LitView,
    file: &'static str,
    find: &'static str,
    replace: &'static str,
}

/// A fault as a row of a table: its name, stage, view, file, and the text that is replaced by another.
pub(crate) type Row =
    (&'static str, LitStage, fn() -> LitView, &'static str, &'static str, &'static str);

pub(crate) fn faults<'a>(tables: &'a [&'a [Row]]) -> impl Iterator<Item = Fault> + 'a {
    tables.iter().copied().flatten().map(|&(name, stage, view, file, find, replace)| Fault {
        name,
        stage,
        view,
        file,
        find,
        replace,
    })
}

/// Asserts that the fault is found in the stage in which it was inserted.
pub(crate) fn is_found(
    fault: &Fault,
    certify: impl Fn(&Headless, &LitView) -> Result<LitCertificate, Failed>,
) -> Result<(), Failed> {
    let view = (fault.view)();
    let certificate = certify(&faulty(fault.file, fault.find, fault.replace)?, &view)?;
    println!("{certificate}");
    match certificate.violations.first() {
        None => Err(format!("the fault was not found: {certificate}").into()),
        Some(first) if first.stage != fault.stage => {
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
