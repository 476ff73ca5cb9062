//! `pinhole render --certify`: judges a picture before it is written, and writes it with its certificate.

use anyhow::anyhow;

use crate::flags::settings::Given;
use crate::input::Input;
use crate::output::picture::Outputs;
use crate::proof::certified::{self, FilePicture};
use crate::render::device::OpenDevice;
use crate::render::stop_rule::StopRule;
use crate::render::views::{Shot, views_of};
use crate::render::{ghosts, render_joined};
use crate::terminal::failure::Failure;
use crate::terminal::progress;
use pinhole::image::encoding::Encoding;
use pinhole::image::{Image, Layer};
use pinhole::verify::Checker;
use pinhole::verify::finished::FinishedCertificate;

/// Renders, judges and writes a picture. A picture that is not legal is an error and is not written. If some pixels are
/// open, the certificate says so, and the result is the failure of a check that could not decide.
pub(crate) fn run(
    input: &mut Input,
    given: &Given,
    stop_rule: StopRule,
    outputs: Outputs,
    encoding: &Encoding,
    opened: &OpenDevice,
) -> Result<Result<(), Failure>, Failure> {
    ghosts::refuse(input, "--certify")?;
    let layers = outputs.layers(encoding).with(Layer::Samples);
    let image = {
        let views = &views_of(input, input.film);
        render_joined(&Shot::new(input, views, layers, stop_rule, opened))?
    };
    let samples = image.samples().unwrap_or_default();
    let count = samples.first().copied().unwrap_or(1);
    if samples.iter().any(|other| *other != count) {
        let text = "some pixels have more samples than others; let every pixel have as many, without --time";
        return Err(anyhow!("--certify: {text}").into());
    }
    input.settings.sampling.samples = count;
    let written = FilePicture::of(&image, encoding, &outputs)?;
    let judged = certified::judge(
        input,
        encoding,
        &outputs,
        &written,
        FinishedCertificate::outcome,
        &|checker, input, exact| witness(checker, input, exact, opened),
    )?;
    let verdict = certified::verdict(&judged);
    if let Err(failure @ Failure::CheckFailed(_)) = verdict {
        return Err(failure);
    }
    progress::clear();
    let adapter = opened.adapter();
    let certificate = certified::certificate(input, given, &written, &judged, adapter);
    let outputs = Outputs { certificate: Some(certificate.to_text()), ..outputs };
    outputs.write(&image, encoding, adapter, None)?;
    Ok(verdict)
}

/// Light that the device finds, where it is known to be legal.
#[cfg_attr(not(feature = "gpu"), expect(unused_variables, clippy::unnecessary_wraps, reason = "there is no device"))]
pub(crate) fn witness(
    checker: &Checker<'_>,
    input: &mut Input,
    exact: &Image,
    opened: &OpenDevice,
) -> Result<Option<Image>, Failure> {
    match opened {
        #[cfg(feature = "gpu")]
        OpenDevice::Device { headless, choice, .. } => {
            crate::proof::witness::of(headless, checker, input, exact, *choice, opened).map(Some)
        }
        _ => Ok(None),
    }
}
