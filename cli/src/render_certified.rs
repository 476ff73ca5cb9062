//! `pinhole render --certify`: judges a picture before it is written, and writes it with its certificate.

use anyhow::{Result, anyhow};

use super::certified::{self, Judged, Written};
use super::device::Opened;
use super::failure::Failure;
use super::input::Input;
use super::picture::{Outputs, PictureFormat};
use super::progress;
use super::render::{finish_views, render_joined, render_part};
use super::stop_rule::StopRule;
use super::views::Views;
use pinhole::image::denoise::GUIDES;
use pinhole::image::encoding::Encoding;
use pinhole::image::{Image, Layer};
use pinhole::render::Integrator;
use pinhole::verify::denoised;

/// A picture and what was found about it.
struct Made {
    image: Image,
    written: Written,
    judged: Judged,
}

/// Renders, judges and writes a picture, and returns whether enough is decided. A picture that is not legal is an error
/// and is not written; the certificate of one of which too much is undecided says so.
pub(super) fn run(
    input: &mut Input,
    stop_rule: &StopRule,
    outputs: Outputs,
    encoding: &Encoding,
    opened: &Opened,
) -> Result<Result<(), Failure>, Failure> {
    let arguments = certified::arguments()?;
    certified::check(input, !outputs.annotations().is_empty())?;
    let Made { image, written, judged } = match input.settings.is_denoised {
        true => denoised(input, stop_rule, &outputs, encoding, opened)?,
        false => plain(input, stop_rule, &outputs, encoding, opened)?,
    };
    let verdict = judged.verdict();
    if let Err(failure @ Failure::CheckFailed(_)) = verdict {
        return Err(failure);
    }
    let adapter = opened.adapter();
    let certificate = certified::certificate(input, &written, &judged, adapter, arguments);
    let text = certificate.to_text().map_err(anyhow::Error::from)?;
    outputs.with_certificate(text).write(&image, encoding, adapter, None)?;
    Ok(verdict)
}

fn plain(
    input: &mut Input,
    stop_rule: &StopRule,
    outputs: &Outputs,
    encoding: &Encoding,
    opened: &Opened,
) -> Result<Made, Failure> {
    // Means are of as many samples as were taken.
    let layers = outputs.layers(encoding).with(Layer::Samples);
    let views = Views::of(input);
    let image = render_joined(input, stop_rule, &views, layers, opened)?;
    let written = written(&image, outputs, encoding)?;
    let judged = certified::judge(input, encoding, outputs.layers(encoding), &written)?;
    Ok(Made { image, written, judged })
}

/// Judges the light before the denoiser, and the denoiser by itself.
fn denoised(
    input: &mut Input,
    stop_rule: &StopRule,
    outputs: &Outputs,
    encoding: &Encoding,
    opened: &Opened,
) -> Result<Made, Failure> {
    if let Some(flag) = stop_rule.flag() {
        return Err(Failure::usage(format!(
            "--certify: {flag} and the denoiser exclude each other here; add --denoise=false, or choose --samples N"
        )));
    }
    let layers = outputs.layers(encoding).with(Layer::Samples);
    let noisy = one(render_part(input, input.film, layers, opened)?);
    let finish =
        |settings| finish_views(Views::One(noisy.clone()), settings, layers, opened).map(one);
    let image = finish(&input.settings)?;
    let mut without_lines = input.settings.clone();
    if let Integrator::Studio(studio) = &mut without_lines.integrator {
        studio.outline = None;
    }
    let quiet = finish(&without_lines)?;
    progress::stage("checking the denoiser");
    let denoiser = denoised::certify(&noisy, &quiet).map_err(anyhow::Error::from)?;
    let written = written(&image, outputs, encoding)?;
    let means = certified::means_of_light(input, &noisy, GUIDES)?;
    Ok(Made { image, written, judged: Judged::Denoised(means, denoiser) })
}

fn one(images: Views<Image>) -> Image {
    match images {
        Views::One(image) | Views::Two([image, _]) => image,
    }
}

/// The samples that are written of an image.
fn written(image: &Image, outputs: &Outputs, encoding: &Encoding) -> Result<Written> {
    let samples = image.samples().unwrap_or_default();
    let first = samples.first().copied().unwrap_or(1);
    if samples.iter().any(|count| *count != first) {
        return Err(anyhow!(
            "--certify: some pixels have more samples than others; let every pixel have as many, without --time"
        ));
    }
    Written::of(image, encoding, outputs.format() == PictureFormat::Png, first)
}
