//! `pinhole verify`: checks whether a picture is legal. An adapter renders it now, or it was recorded before.

use std::fmt::Display;

use anyhow::{Context, anyhow};

use crate::proof::verify::args::VerifyArgs;
use crate::proof::verify::output::VerifyJob;
use crate::proof::verify::report::{JudgedLight, Report, open_pixels};
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, answer};
use pinhole::verify::denoised::DenoiseCertificate;
use pinhole::verify::finished::{FinishedCertificate, PixelVerdict};
use pinhole::verify::{Certificate, Checker, LitCertificate, MOST_UNDECIDED, Outcome, Verdict};

pub(crate) mod args;
mod output;
mod page;
mod picture;
#[cfg(feature = "gpu")]
mod record;
pub(crate) mod report;

pub(crate) fn run(args: &VerifyArgs) -> Result<(), Failure> {
    if let (Some(scene), Some(picture)) = (&args.scene, &args.path) {
        return picture::run(args, picture, scene);
    }
    let VerifyJob { run, outputs, light } = match (&args.replay, &args.path) {
        (Some(path), _) => output::replay(path, args)?,
        #[cfg(feature = "gpu")]
        (None, Some(path)) => record::recorded(path, args)?,
        #[cfg(not(feature = "gpu"))]
        (None, Some(_)) => {
            return Err(Failure::usage(
                "this program was built without the feature `gpu`, so it can only check recordings: \
                 `pinhole verify --replay RUN`",
            ));
        }
        (None, None) => return Err(Failure::usage("name a scene or data file, or --replay RUN")),
    };
    progress::stage("checking");
    let checker = Checker::new(&run.scene).context("the checker cannot be prepared")?;
    let certificate = checker.certify(&run.recording);
    let mut report = Report::new(&run, &certificate, light.as_ref());
    report.open = open_pixels(&checker, &run.recording, &certificate);
    drop(checker);
    progress::clear();
    answer(report.table().as_bytes())?;
    outputs.write(&run, &certificate, &report, light.as_ref())?;
    let of_picture = verdict(&certificate);
    let Some(JudgedLight { stages, denoiser, rendered, .. }) = light else { return of_picture };
    let of_light = stages.as_ref().map_or(Ok(()), verdict_of_light);
    let of_denoiser = denoiser.as_ref().map_or(Ok(()), verdict_of_denoiser);
    worse(worse(worse(of_picture, of_light), of_denoiser), verdict_of_rendered(&rendered))
}

/// Returns the first failure, except that a violation takes precedence over an undecided check.
fn worse(first: Result<(), Failure>, second: Result<(), Failure>) -> Result<(), Failure> {
    match (first, second) {
        (Err(Failure::Undecided(_)), Err(worse @ Failure::CheckFailed(_))) => Err(worse),
        (first, second) => first.and(second),
    }
}

fn verdict(certificate: &Certificate) -> Result<(), Failure> {
    if let Some(error) = &certificate.upload {
        return Err(Failure::CheckFailed(anyhow!("the picture is not legal: {error}")));
    }
    if certificate.outcome() == Outcome::Undecided {
        let (count, all) = (certificate.undecided(), certificate.verdicts.len());
        return Err(undecided(&format!("{count} of {all} pixels have several legal answers")));
    }
    let count = format!("{} of {} pixels", certificate.count(Verdict::Violation), certificate.verdicts.len());
    none_illegal("the picture is", &count, certificate.violations.first())
}

/// Returns the failure of a check that found something illegal.
fn none_illegal(what: &str, count: &str, first: Option<&impl Display>) -> Result<(), Failure> {
    let Some(first) = first else { return Ok(()) };
    Err(Failure::CheckFailed(anyhow!("{what} not legal: {count}; the first is {first}")))
}

/// The failure of a check that left too much undecided.
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
    let count = format!("{} of {} stages", certificate.violation_count, certificate.stages().checked);
    none_illegal(what, &count, certificate.violations.first())
}

fn verdict_of_denoiser(certificate: &DenoiseCertificate) -> Result<(), Failure> {
    let DenoiseCertificate { pixels, undecided: vague, violation_count, .. } = *certificate;
    if certificate.outcome() == Outcome::Undecided {
        let what = format!("the bounds of {vague} of {pixels} denoised pixels say little");
        return Err(undecided(&what));
    }
    let count = format!("{violation_count} of {pixels} pixels");
    none_illegal("the denoised picture is", &count, certificate.violations.first())
}

fn verdict_of_rendered(certificate: &FinishedCertificate) -> Result<(), Failure> {
    let all = certificate.verdicts.len();
    let count = |verdict| certificate.count(verdict);
    if certificate.outcome_of_device() == Outcome::Undecided {
        let vague = count(PixelVerdict::Wide) + count(PixelVerdict::Open);
        let first = certificate.open.first().map(|first| format!(", first {first}")).unwrap_or_default();
        let what = "pixels that `render` gives differ from what exact arithmetic gives, with bounds that say little";
        return Err(undecided(&format!("{vague} of {all} {what}{first}")));
    }
    let count = format!("{} of {all} pixels", count(PixelVerdict::Violated));
    none_illegal("the picture that `render` gives is", &count, certificate.violations.first())
}
