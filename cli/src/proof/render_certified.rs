//! `pinhole render --certify`: judges a picture before it is written, and writes it with its certificate.

use anyhow::{Result, anyhow};

use crate::input::Input;
use crate::output::picture::{Outputs, PictureFormat};
use crate::proof::certified::{self, FilePicture, Judgement};
use crate::render::device::OpenDevice;
use crate::render::stop_rule::StopRule;
use crate::render::views::{Shot, views_of};
use crate::render::{finish, render_joined, render_part};
use crate::terminal::failure::Failure;
use crate::terminal::progress;
use pinhole::image::denoise::GUIDES;
use pinhole::image::encoding::Encoding;
use pinhole::image::{Image, Layer};
use pinhole::verify::denoised;

/// Means need the number of samples that were taken.
const COUNTED: Layer = Layer::Samples;

/// A picture and the result of judging it.
struct JudgedPicture {
    image: Image,
    written: FilePicture,
    judged: Judgement,
}

/// Everything that making a picture needs.
struct Making<'a> {
    stop_rule: StopRule,
    outputs: &'a Outputs,
    encoding: &'a Encoding,
    opened: &'a OpenDevice,
}

/// Renders, judges and writes a picture, and returns whether enough is decided. A picture that is not legal is an error
/// and is not written. If too much is undecided, the certificate records that.
pub(crate) fn run(
    input: &mut Input,
    stop_rule: StopRule,
    outputs: Outputs,
    encoding: &Encoding,
    opened: &OpenDevice,
) -> Result<Result<(), Failure>, Failure> {
    let arguments = certified::arguments()?;
    certified::check(input, !outputs.annotations.is_empty())?;
    let making = Making { stop_rule, outputs: &outputs, encoding, opened };
    let JudgedPicture { image, written, judged } = match input.settings.sampling.denoise {
        true => making.denoised(input)?,
        false => making.plain(input)?,
    };
    let verdict = judged.verdict();
    if let Err(failure @ Failure::CheckFailed(_)) = verdict {
        return Err(failure);
    }
    let adapter = opened.adapter();
    let certificate = certified::certificate(input, &written, &judged, adapter, arguments);
    let text = certificate.to_text().map_err(anyhow::Error::from)?;
    let outputs = Outputs { certificate: Some(text), ..outputs };
    outputs.write(&image, encoding, adapter, None)?;
    Ok(verdict)
}

impl Making<'_> {
    fn plain(&self, input: &mut Input) -> Result<JudgedPicture, Failure> {
        let wanted = self.outputs.layers(self.encoding);
        let (views, layers) = (&views_of(input, input.film), wanted.with(COUNTED));
        let Self { stop_rule, opened, .. } = *self;
        let image = render_joined(&Shot { input, views, layers, stop_rule, opened })?;
        let written = self.written(&image)?;
        let judged = certified::judge(input, self.encoding, wanted, &written)?;
        Ok(JudgedPicture { image, written, judged })
    }

    /// Judges the light before denoising, and the denoiser separately.
    fn denoised(&self, input: &mut Input) -> Result<JudgedPicture, Failure> {
        if let Some(flag) = self.stop_rule.open_end() {
            return Err(Failure::usage(format!(
                "--certify: {flag} and the denoiser exclude each other here; add --denoise=false, or choose --samples N"
            )));
        }
        let layers = self.outputs.layers(self.encoding).with(COUNTED);
        let noisy = render_part(input, input.film, layers, self.opened)?.swap_remove(0);
        let with_guides = input.settings.layers_for(layers);
        let without_noise = input.settings.unfinished().with_denoise(true);
        let quiet = finish(noisy.clone(), &without_noise, with_guides, self.opened)?;
        progress::stage("checking the denoiser");
        let denoiser = denoised::certify(&noisy, &quiet).map_err(anyhow::Error::from)?;
        let with_lines = input.settings.with_denoise(false);
        let image = finish(quiet, &with_lines, layers, self.opened)?;
        let written = self.written(&image)?;
        let means = certified::means_of_light(input, &noisy, GUIDES)?;
        Ok(JudgedPicture { image, written, judged: Judgement::Means(means, Some(denoiser)) })
    }

    /// Returns the samples of an image as they are written.
    fn written(&self, image: &Image) -> Result<FilePicture> {
        let samples = image.samples().unwrap_or_default();
        let first = samples.first().copied().unwrap_or(1);
        if samples.iter().any(|count| *count != first) {
            return Err(anyhow!(
                "--certify: some pixels have more samples than others; let every pixel have as many, without --time"
            ));
        }
        FilePicture::of(image, self.encoding, self.outputs.format == PictureFormat::Png, first)
    }
}
