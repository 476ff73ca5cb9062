//! `pinhole verify`: checks whether a picture is legal that an adapter renders now, or that was recorded before.

use std::path::Path;

use anyhow::{Context, anyhow};

use super::args::VerifyArgs;
use super::failure::Failure;
use super::speak::answer;
use super::verify_kept::Replayed;
use super::verify_open::open_pixels;
use super::verify_output::VerifyOutputs;
use super::verify_report::Report;
use super::{progress, threads, verify_kept, verify_picture};
use pinhole::verify::denoised::DenoiseCertificate;
use pinhole::verify::{Certificate, Checker, LitCertificate, MOST_UNDECIDED, Outcome, Verdict};
use recorded::Recorded;

#[cfg(not(feature = "gpu"))]
#[path = "verify/no_record.rs"]
mod record;
#[cfg(feature = "gpu")]
mod record;
mod recorded;

pub(super) fn run(args: &VerifyArgs) -> Result<(), Failure> {
    if let (Some(scene), Some(picture)) = (&args.scene, &args.path) {
        return verify_picture::run(args, picture, scene);
    }
    let Recorded { run, outputs, light, denoiser, kept } = match (&args.replay, &args.path) {
        (Some(path), _) => replayed(path, args)?,
        (None, Some(path)) => record::recorded(path, args)?,
        (None, None) => return Err(Failure::usage("name a scene or data file, or --replay RUN")),
    };
    progress::stage("checking");
    let checker = Checker::new(&run.scene).context("the checker cannot be prepared")?;
    let certificate = checker.certify(&run.recording);
    let mut report = Report::new(&run, &certificate, light.as_ref(), denoiser.as_ref());
    report.open = open_pixels(&checker, &run.recording, &certificate);
    drop(checker);
    progress::clear();
    answer(report.table().as_bytes()).context("standard output: cannot be written")?;
    outputs.write(&run, &certificate, &report, &kept)?;
    let of_light = light.as_ref().map_or(Ok(()), verdict_of_light);
    let of_denoiser = denoiser.as_ref().map_or(Ok(()), verdict_of_denoiser);
    worse(worse(verdict(&certificate), of_light), of_denoiser)
}

/// The first failure, but a violation says more than what is undecided.
fn worse(first: Result<(), Failure>, second: Result<(), Failure>) -> Result<(), Failure> {
    match (first, second) {
        (Err(Failure::Undecided(_)), Err(worse @ Failure::CheckFailed(_))) => Err(worse),
        (first, second) => first.and(second),
    }
}

/// Reads a saved recording, and checks its light.
fn replayed(path: &Path, args: &VerifyArgs) -> Result<Recorded, Failure> {
    let outputs = VerifyOutputs::new(args)?;
    outputs.check_not_inputs(&[path.to_path_buf()])?;
    threads::start()?;
    let Replayed { run, light, denoiser, kept } = verify_kept::replay(path)?;
    Ok(Recorded { run, outputs, light, denoiser, kept })
}

fn verdict(certificate: &Certificate) -> Result<(), Failure> {
    if let Some(error) = &certificate.upload {
        return Err(Failure::CheckFailed(anyhow!("the picture is not legal: {error}")));
    }
    if certificate.outcome() == Outcome::Undecided {
        let (count, all) = (certificate.undecided(), certificate.verdicts.len());
        return Err(undecided(&format!("{count} of {all} pixels have several legal answers")));
    }
    match certificate.violations.first() {
        None => Ok(()),
        Some(first) => Err(Failure::CheckFailed(anyhow!(
            "the picture is not legal: {} of {} pixels; the first is {first}",
            certificate.count(Verdict::Violation),
            certificate.verdicts.len()
        ))),
    }
}

/// The failure of a check that says too little.
fn undecided(what: &str) -> Failure {
    let percent = 100.0 * MOST_UNDECIDED;
    Failure::Undecided(anyhow!("no violation was found, but {what}; at most {percent} % may"))
}

fn verdict_of_light(certificate: &LitCertificate) -> Result<(), Failure> {
    let what = if certificate.is_studio { "the studio is" } else { "the paths are" };
    if let Some(error) = &certificate.upload {
        return Err(Failure::CheckFailed(anyhow!("{what} not legal: {error}")));
    }
    if certificate.outcome() == Outcome::Undecided {
        let stages = certificate.stages();
        return Err(undecided(&format!(
            "the bounds of {} of {} stages of light are so wide that they say little",
            stages.undecided, stages.checked
        )));
    }
    match certificate.violations.first() {
        None => Ok(()),
        Some(first) => Err(Failure::CheckFailed(anyhow!(
            "{what} not legal: {} of {} stages; the first is {first}",
            certificate.violation_count,
            certificate.stages().checked
        ))),
    }
}

fn verdict_of_denoiser(certificate: &DenoiseCertificate) -> Result<(), Failure> {
    let DenoiseCertificate { pixels, undecided: vague, violation_count, .. } = *certificate;
    if certificate.outcome() == Outcome::Undecided {
        let what = format!("the bounds of {vague} of {pixels} denoised pixels say little");
        return Err(undecided(&what));
    }
    match certificate.violations.first() {
        None => Ok(()),
        Some(first) => Err(Failure::CheckFailed(anyhow!(
            "the denoised picture is not legal: {violation_count} of {pixels} pixels; the first is {first}"
        ))),
    }
}
