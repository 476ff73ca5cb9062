//! The certificate in a picture: `render --certify` makes it, and `verify PICTURE` checks it.

use anyhow::{Context, Result, anyhow};
use clap::parser::ValueSource;
use clap::{ArgMatches, CommandFactory};

use crate::flags::render::RenderLine;
use crate::input::Input;
use crate::render;
use crate::render::device::OpenDevice;
use crate::terminal::failure::Failure;
use crate::terminal::progress;
use pinhole::image::denoise;
use pinhole::image::encoding::Encoding;
use pinhole::image::{Image, LayerSet};
use pinhole::verify::denoised::DenoiseCertificate;
use pinhole::verify::means::{Estimates, Means};
use pinhole::verify::picture_certificate::{JudgedBy, PictureCertificate, samples_digest, scene_digest};
use pinhole::verify::written::{Samples, WrittenCertificate, WrittenPicture};
use pinhole::verify::{Checker, MOST_UNDECIDED, Outcome, Verdict};
use pinhole_figure::read::picture::FileSamples;
use pinhole_figure::write::png;

/// Arguments of `render` that do not change the samples of the picture, or that name files and devices.
const NOT_OF_THE_PICTURE: [&str; 16] = [
    "path",
    "output",
    "certify",
    "layers",
    "backend",
    "adapter",
    "limits",
    "accel",
    "time",
    "noise",
    "keep_partial",
    "print_scene",
    "save_scene",
    "quiet",
    "profile",
    "dpi",
];

/// A number that is added to the seed for the reference's picture, so that its noise differs.
const OTHER_SEED: u32 = 0x9e37_79b9;

/// A picture as its file stores it, or will store it.
pub(crate) struct FilePicture {
    pub(crate) size: [u32; 2],
    pub(crate) samples: FileSamples,
    pub(crate) per_pixel: u32,
}

/// The result of judging a picture.
pub(crate) enum Judgement {
    /// A judgement of each sample.
    Intervals(WrittenCertificate),
    /// A judgement of the means of samples. For a denoised picture, it judges light before denoising, and the denoiser.
    Means(Means, Option<DenoiseCertificate>),
}

impl FilePicture {
    /// Returns the samples of an image as a writer would store them.
    pub(crate) fn of(image: &Image, encoding: &Encoding, is_png: bool, per_pixel: u32) -> Result<Self> {
        let size = [image.width(), image.height()];
        let samples = if is_png {
            FileSamples::Encoded {
                bits: encoding.bits,
                has_alpha: encoding.transparent,
                bytes: png::samples(image, encoding)?,
            }
        } else {
            let alpha = image.alpha().filter(|_| encoding.transparent);
            let with_alpha = |(i, [r, g, b]): (usize, &[f32; 3])| [*r, *g, *b, alpha.map_or(1.0, |alpha| alpha[i])];
            FileSamples::Linear(image.color().iter().enumerate().map(with_alpha).collect())
        };
        Ok(Self { size, samples, per_pixel })
    }

    fn digest(&self) -> String {
        match &self.samples {
            FileSamples::Encoded { bytes, .. } => samples_digest(self.size, bytes),
            FileSamples::Linear(pixels) => {
                let bytes: Vec<u8> = pixels.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
                samples_digest(self.size, &bytes)
            }
        }
    }

    fn picture<'a>(&'a self, encoding: &'a Encoding) -> WrittenPicture<'a> {
        let samples = match &self.samples {
            FileSamples::Encoded { bytes, .. } => Samples::Encoded(bytes),
            FileSamples::Linear(pixels) => Samples::Linear(pixels),
        };
        WrittenPicture { size: self.size, samples, encoding }
    }

    /// Red, green and blue of each pixel, with white at 1.
    fn colors(&self, encoding: &Encoding) -> Result<Vec<[f64; 3]>> {
        Ok(self.picture(encoding).colors()?)
    }
}

/// Refuses pictures that cannot be certified.
pub(crate) fn check(input: &Input, has_annotations: bool) -> Result<(), Failure> {
    let refusal = if has_annotations {
        "annotations are drawn over the picture; certify the picture without legends, scale bars and labels"
    } else if input.eyes.is_some() {
        "a stereo picture cannot be certified; certify one eye"
    } else {
        return Ok(());
    };
    Err(Failure::usage(format!("--certify: {refusal}")))
}

pub(crate) fn judge(
    input: &mut Input,
    encoding: &Encoding,
    layers: LayerSet,
    written: &FilePicture,
) -> Result<Judgement, Failure> {
    progress::stage("checking");
    let checked = |scene| Checker::new(scene).context("the checker cannot be prepared");
    if let Some(primary) = input.settings.primary() {
        let certificate = checked(&input.scene)?
            .certify_written(&input.view(), &primary, &written.picture(encoding))
            .map_err(anyhow::Error::from)?;
        return Ok(Judgement::Intervals(certificate));
    }
    let is_png = matches!(written.samples, FileSamples::Encoded { .. });
    let per_pixel = written.per_pixel;
    let reference = other_estimate(input, per_pixel, |input| {
        let image = render::render(input, layers, &OpenDevice::Cpu)?;
        Ok(FilePicture::of(&image, encoding, is_png, per_pixel)?.colors(encoding)?)
    })?;
    let reach = if input.settings.sampling.denoise { denoise::REACH } else { 0 };
    let found = written.colors(encoding)?;
    Ok(Judgement::Means(means(input, (per_pixel, reach), &found, &reference)?, None))
}

/// Judges the light of a picture before denoising and other finishing.
pub(crate) fn means_of_light(input: &mut Input, image: &Image, layers: LayerSet) -> Result<Means, Failure> {
    progress::stage("checking");
    let colors = |image: &Image| -> Vec<[f64; 3]> { image.color().iter().map(|rgb| rgb.map(f64::from)).collect() };
    let per_pixel = image.samples().and_then(|samples| samples.first().copied()).unwrap_or(1);
    let reference = other_estimate(input, per_pixel, |input| {
        let film = input.film;
        Ok(colors(&render::render_part(input, film, layers, &OpenDevice::Cpu)?[0]))
    })?;
    means(input, (per_pixel, 0), &colors(image), &reference)
}

/// Renders the reference's picture with other random numbers.
fn other_estimate(
    input: &mut Input,
    per_pixel: u32,
    render: impl FnOnce(&mut Input) -> Result<Vec<[f64; 3]>, Failure>,
) -> Result<Vec<[f64; 3]>, Failure> {
    let sampling = input.settings.sampling;
    input.settings.sampling.seed = sampling.seed.wrapping_add(OTHER_SEED);
    input.settings.sampling.samples = per_pixel;
    let reference = render(input);
    input.settings.sampling = sampling;
    reference
}

fn means(
    input: &Input,
    (samples, reach): (u32, u32),
    found: &[[f64; 3]],
    expected: &[[f64; 3]],
) -> Result<Means, Failure> {
    let checker = Checker::new(&input.scene).context("the checker cannot be prepared")?;
    let ties = checker.ties(&input.view());
    let size = [input.film.width(), input.film.height()];
    Ok(Estimates { size, samples, reach, found, expected, ties: &ties }.compare())
}

impl Judgement {
    pub(crate) fn by(&self) -> JudgedBy {
        match self {
            Self::Intervals(_) => JudgedBy::Intervals,
            Self::Means(..) => JudgedBy::Means,
        }
    }

    pub(crate) fn outcome(&self) -> Outcome {
        match self {
            Self::Intervals(certificate) => certificate.outcome(),
            Self::Means(means, denoiser) => {
                let of_denoiser = denoiser.as_ref().map(DenoiseCertificate::outcome);
                means.outcome().max(of_denoiser.unwrap_or(Outcome::Proved))
            }
        }
    }

    /// The numbers of proved, undecided and violated pixels, or means.
    pub(crate) fn counts(&self) -> [u64; 3] {
        match self {
            Self::Intervals(certificate) => [
                certificate.count(Verdict::Decided) as u64,
                certificate.undecided() as u64,
                certificate.count(Verdict::Violation) as u64,
            ],
            Self::Means(means, _) => {
                [Outcome::Proved, Outcome::Undecided, Outcome::Violated].map(|outcome| means.count(outcome) as u64)
            }
        }
    }

    /// The first violation, or the worst.
    pub(crate) fn violation(&self) -> Option<String> {
        match self {
            Self::Intervals(certificate) => certificate.violations.first().map(ToString::to_string),
            Self::Means(means, denoiser) => {
                let worst = means.worst().filter(|worst| worst.outcome == Outcome::Violated);
                let denoiser = denoiser.as_ref().and_then(|denoiser| denoiser.violations.first());
                worst.map(ToString::to_string).or(denoiser.map(ToString::to_string))
            }
        }
    }

    fn unit(&self) -> &'static str {
        match self {
            Self::Intervals(_) => "pixels",
            Self::Means(..) => "means of regions",
        }
    }

    pub(crate) fn table(&self) -> String {
        let counts = self.counts();
        let all = counts.iter().sum::<u64>().max(1) as f64;
        let mut table = format!("{:<12}{:>12}\n", "judged by", self.by().name());
        for (name, count) in ["proved", "undecided", "violated"].into_iter().zip(counts) {
            let percent = 100.0 * count as f64 / all;
            table += &format!("{name:<12}{count:>12}  {percent:8.4} %  of {}\n", self.unit());
        }
        if let Self::Means(means, None) = self {
            let worst = means.worst().map_or(0.0, pinhole::verify::means::RegionMean::fraction);
            table += &format!("{:<12}{worst:>12.4}  of its bound\n", "worst mean");
            table += &format!("{:<12}{:>12.4}  of white\n", "widest bound", means.widest());
        }
        table
    }

    /// Returns a failure unless the picture is proved.
    pub(crate) fn verdict(&self) -> Result<(), Failure> {
        let [_, undecided, violated] = self.counts();
        let unit = self.unit();
        match self.outcome() {
            Outcome::Proved => Ok(()),
            Outcome::Undecided => Err(Failure::Undecided(anyhow!(
                "no violation was found, but {undecided} {unit} are undecided; at most {}",
                match self {
                    Self::Intervals(_) => format!("{} % may be", 100.0 * MOST_UNDECIDED),
                    Self::Means(..) =>
                        "half of them may be; more samples, a larger picture or --denoise=false decide more".to_owned(),
                }
            ))),
            Outcome::Violated => Err(Failure::CheckFailed(anyhow!(
                "the picture is not legal: {violated} {unit}; {}",
                self.violation().unwrap_or_default()
            ))),
        }
    }
}

pub(crate) fn certificate(
    input: &Input,
    written: &FilePicture,
    judged: &Judgement,
    adapter: Option<&str>,
    arguments: Vec<String>,
) -> PictureCertificate {
    let [proved, undecided, _] = judged.counts();
    PictureCertificate {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        adapter: adapter.unwrap_or("cpu").to_owned(),
        arguments,
        scene: scene_digest(&input.scene),
        samples: written.digest(),
        samples_per_pixel: written.per_pixel,
        judged_by: judged.by(),
        outcome: judged.outcome(),
        counts: [proved, undecided],
    }
}

/// Refuses a certificate that belongs to other samples.
pub(crate) fn check_samples(certificate: &PictureCertificate, written: &FilePicture) -> Result<()> {
    if certificate.samples == written.digest() {
        return Ok(());
    }
    Err(anyhow!("the certificate is of other samples; the picture was changed after it was certified"))
}

/// Refuses a certificate that belongs to another scene.
pub(crate) fn check_scene(certificate: &PictureCertificate, input: &Input) -> Result<()> {
    if certificate.scene == scene_digest(&input.scene) {
        return Ok(());
    }
    Err(anyhow!(
        "the certificate is of other data than {}, or the data were changed since; render the picture again",
        input.report.path
    ))
}

/// The arguments of this process that determine the picture, apart from the scene.
pub(crate) fn arguments() -> Result<Vec<String>> {
    let command = RenderLine::command();
    let matches = command.clone().try_get_matches_from(std::env::args_os())?;
    let of_render = matches.subcommand_matches("render");
    of_render.map_or_else(|| Ok(Vec::new()), |matches| picture_arguments(&command, matches))
}

fn picture_arguments(command: &clap::Command, matches: &ArgMatches) -> Result<Vec<String>> {
    let mut words = Vec::new();
    let render = command.find_subcommand("render").map(clap::Command::get_arguments);
    for argument in render.into_iter().flatten() {
        let id = argument.get_id().as_str();
        let is_given = matches.value_source(id) == Some(ValueSource::CommandLine);
        let Some(name) = argument.get_long().filter(|_| is_given) else { continue };
        if NOT_OF_THE_PICTURE.contains(&id) {
            continue;
        }
        for values in matches.get_raw_occurrences(id).into_iter().flatten() {
            let values: Option<Vec<&str>> = values.map(std::ffi::OsStr::to_str).collect();
            let values = values.ok_or_else(|| {
                anyhow!("--{name}: a value that is not UTF-8 cannot be part of a certificate; rename the file")
            })?;
            let takes_values = argument.get_action().takes_values();
            match (takes_values, argument.get_value_delimiter()) {
                (false, _) => words.push(format!("--{name}")),
                (true, Some(delimiter)) => {
                    words.push(format!("--{name}={}", values.join(&delimiter.to_string())));
                }
                (true, None) if values.len() == 1 => words.push(format!("--{name}={}", values[0])),
                (true, None) => {
                    words.push(format!("--{name}"));
                    words.extend(values.into_iter().map(str::to_owned));
                }
            }
        }
    }
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_exists() {
        let command = RenderLine::command();
        let render = command.find_subcommand("render").unwrap();
        let is_built = |id: &&str| cfg!(feature = "gpu") || *id != "profile";
        for id in NOT_OF_THE_PICTURE.into_iter().filter(is_built) {
            assert!(render.get_arguments().any(|argument| argument.get_id() == id), "{id}");
        }
    }

    #[test]
    fn arguments_mean_the_same_when_they_are_given_again() {
        let command = RenderLine::command();
        let given = "pinhole render a.csv -o b.png --eye 1,2,3 --size=30x20 --columns x,y,z --transparent \
                     --exposure -1.5 --certify --quiet --adapter gpu";
        let matches = command.clone().try_get_matches_from(given.split_whitespace()).unwrap();
        let matches = matches.subcommand_matches("render").unwrap();
        let words = picture_arguments(&command, matches).unwrap();
        assert!(words.iter().any(|word| word == "--eye=1,2,3"), "{words:?}");
        for absent in ["--quiet", "--adapter", "--certify", "a.csv"] {
            assert!(!words.iter().any(|word| word.contains(absent)), "{words:?}");
        }
        let again = ["pinhole", "render", "a.csv", "-o", "-"].into_iter().map(str::to_owned);
        let matches = command.clone().try_get_matches_from(again.chain(words.iter().cloned())).unwrap();
        let matches = matches.subcommand_matches("render").unwrap();
        assert_eq!(picture_arguments(&command, matches).unwrap(), words);
    }
}
