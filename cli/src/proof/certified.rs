//! The certificate in a picture: `render --certify` makes it, and `verify PICTURE` checks it.

use anyhow::{Context, Result, anyhow};

use crate::flags::settings::Given;
use crate::input::Input;
use crate::output::picture::{Outputs, PictureFormat};
use crate::render::device::OpenDevice;
use crate::render::views::views_of;
use crate::render::{finish_joined, render_part};
use crate::terminal::failure::Failure;
use crate::terminal::progress;
use pinhole::image::Image;
use pinhole::image::encoding::Encoding;
use pinhole::verify::finished::{Annotate, FinishedCertificate, FinishedRequest, LEAST_EXACT, MOST_WIDE, PixelVerdict};
use pinhole::verify::picture_certificate::{PictureCertificate, samples_digest, scene_digest};
use pinhole::verify::written::{Samples, WrittenPicture};
use pinhole::verify::{Checker, Outcome};
use pinhole_figure::read::picture::FileSamples;
use pinhole_figure::settings::Layer;
use pinhole_figure::write::png;

/// A flag that changes no sample of the picture.
const NOT_OF_THE_PICTURE: &str = "dpi";

/// Keys of scene files that name files.
const NAMES_OF_FILES: [&str; 4] = ["data", "file", "topology", "image"];

/// A picture as its file stores it, or will store it.
pub(crate) struct FilePicture {
    pub(crate) size: [u32; 2],
    pub(crate) samples: FileSamples,
}

impl FilePicture {
    /// Returns the samples of an image as a writer would store them.
    pub(crate) fn of(image: &Image, encoding: &Encoding, outputs: &Outputs) -> Result<Self> {
        let size = [image.width(), image.height()];
        let samples = if outputs.format == PictureFormat::Png {
            FileSamples::Encoded {
                bits: encoding.bits,
                has_alpha: encoding.transparent,
                bytes: png::samples_annotated(image, encoding, &outputs.annotations)?,
            }
        } else {
            let alpha = image.alpha().filter(|_| encoding.transparent);
            let with_alpha = |(i, [r, g, b]): (usize, &[f32; 3])| [*r, *g, *b, alpha.map_or(1.0, |alpha| alpha[i])];
            FileSamples::Linear(image.color().iter().enumerate().map(with_alpha).collect())
        };
        Ok(Self { size, samples })
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
}

/// Replaces light of the reference by light that a device found and that is known to be legal; `None` if there is none.
pub(crate) type FindWitness<'a> = dyn Fn(&Checker<'_>, &mut Input, &Image) -> Result<Option<Image>, Failure> + 'a;

/// Judges every pixel of a picture. The reference makes the picture again, with the same random numbers. If the outcome
/// is undecided, as `outcome` says, a witness may replace some of its light.
pub(crate) fn judge(
    input: &mut Input,
    encoding: &Encoding,
    outputs: &Outputs,
    written: &FilePicture,
    outcome: fn(&FinishedCertificate) -> Outcome,
    witness: &FindWitness<'_>,
) -> Result<FinishedCertificate, Failure> {
    let layers = Outputs::unwritten(outputs.format).layers(encoding);
    let images = render_part(input, input.film, layers, &OpenDevice::Cpu)?;
    let scene = input.scene.clone();
    progress::stage("checking");
    let checker = Checker::new(&scene).context("the checker cannot be prepared")?;
    let judged = judge_by(&checker, input, encoding, outputs, written, images.clone())?;
    // Where nothing is random, light follows from hits, and a device has none of its own.
    if let (Outcome::Undecided, true, [image]) = (outcome(&judged), input.has_random_light(), &images[..])
        && let Some(image) = witness(&checker, input, image)?
    {
        return judge_by(&checker, input, encoding, outputs, written, vec![image]);
    }
    Ok(judged)
}

/// Judges a picture by the unfinished pictures of the reference for each eye.
fn judge_by(
    checker: &Checker<'_>,
    input: &Input,
    encoding: &Encoding,
    outputs: &Outputs,
    written: &FilePicture,
    images: Vec<Image>,
) -> Result<FinishedCertificate, Failure> {
    let layers = Outputs::unwritten(outputs.format).layers(encoding);
    let views = &views_of(input, input.film);
    let image = finish_joined(images, &input.settings, layers, &OpenDevice::Cpu)?;
    let annotations = &outputs.annotations;
    let plain = Outputs::unwritten(outputs.format);
    let exact = FilePicture::of(&image, encoding, &plain)?;
    progress::stage("checking");
    let draw = |samples: &mut [u8]| annotations.draw_over([image.width(), image.height()], encoding, samples);
    let [picture, exact] = [written, &exact].map(|picture| picture.picture(encoding));
    let annotate = (!annotations.is_empty()).then_some(&draw as &Annotate<'_>);
    let (settings, picture, exact) = (&input.settings, &picture, &exact);
    let judged = checker.certify_finished(FinishedRequest { views, settings, picture, exact, annotate });
    Ok(judged.map_err(anyhow::Error::from)?)
}

/// The verdicts as a table.
pub(crate) fn table(judged: &FinishedCertificate) -> String {
    let all = judged.verdicts.len().max(1) as f64;
    let row = |verdict: &PixelVerdict| {
        let count = judged.count(*verdict);
        format!("{:<12}{count:>12}  {:8.4} %  of pixels\n", verdict.name(), 100.0 * count as f64 / all)
    };
    PixelVerdict::ALL.iter().map(row).collect()
}

/// Returns a failure unless the picture is proved.
pub(crate) fn verdict(judged: &FinishedCertificate) -> Result<(), Failure> {
    let [wide, open, violated] =
        [PixelVerdict::Wide, PixelVerdict::Open, PixelVerdict::Violated].map(|verdict| judged.count(verdict));
    let all = judged.verdicts.len();
    match judged.outcome() {
        Outcome::Proved => Ok(()),
        Outcome::Violated => {
            let first = judged.violations.first().map(ToString::to_string).unwrap_or_default();
            // Of many pixels that differ, a part is followed.
            let least = if open > 0 { "at least " } else { "" };
            Err(Failure::CheckFailed(anyhow!("the picture is not legal: {least}{violated} of {all} pixels; {first}")))
        }
        Outcome::Undecided => Err(Failure::Undecided(match judged.open.first() {
            Some(first) if open == 0 && wide as f64 > MOST_WIDE * all as f64 => anyhow!(
                "no violation was found, but {wide} of {all} pixels differ from what exact arithmetic gives, with bounds \
                 so wide that they say little; at most {} % may; the first is {first}",
                100.0 * MOST_WIDE
            ),
            Some(first) if open > 0 => anyhow!(
                "{open} of {all} pixels differ from what exact arithmetic gives, and nothing says whether rounding may \
                 lead there; the first is {first}"
            ),
            _ => anyhow!(
                "no violation was found, but fewer than {} % of the pixels are what exact arithmetic gives",
                100.0 * LEAST_EXACT
            ),
        })),
    }
}

/// Makes the certificate of a picture.
pub(crate) fn certificate(
    input: &Input,
    given: &Given,
    written: &FilePicture,
    judged: &FinishedCertificate,
    adapter: Option<&str>,
) -> PictureCertificate {
    PictureCertificate {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        adapter: adapter.unwrap_or("cpu").to_owned(),
        settings: settings(input, given),
        scene: scene_digest(&input.scene),
        samples: written.digest(),
        outcome: judged.outcome(),
        counts: [0, 1, 2, 3].map(|index| judged.count(PixelVerdict::ALL[index]) as u64),
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

/// Refuses flags that a certificate cannot have.
pub(crate) fn check(given: &Given) -> Result<(), Failure> {
    names_files(given)?.map_or(Ok(()), |flag| {
        Err(Failure::usage(format!(
            "--certify: {flag} names a file, which a certificate cannot; write it into a scene file, and render that"
        )))
    })
}

/// The settings of a picture that the command line gave, and the number of samples that were taken.
fn settings(input: &Input, given: &Given) -> Vec<[String; 2]> {
    let samples = (!input.settings.integrator.is_primary()).then(|| input.settings.sampling.samples.to_string());
    let given = given.clone().with("samples", samples.filter(|samples| given.get("samples") != Some(samples)));
    let of_picture = given.all().filter(|(name, _)| *name != NOT_OF_THE_PICTURE);
    of_picture.map(|(name, value)| [name, value].map(str::to_owned)).collect()
}

/// Reads the settings of a certificate; `None` if this program does not know one, or one names a file.
pub(crate) fn given(certificate: &PictureCertificate) -> Option<Given> {
    let mut given = Given::default();
    for [name, value] in &certificate.settings {
        let count = given.all().count();
        given = given.with(name, Some(value.clone()));
        (given.all().count() > count).then_some(())?;
    }
    names_files(&given).ok()?.is_none().then_some(given)
}

/// The first flag that names a file.
fn names_files(given: &Given) -> Result<Option<&'static str>, Failure> {
    fn has_name(value: &toml::Value) -> bool {
        match value {
            toml::Value::Table(table) => {
                table.iter().any(|(key, value)| NAMES_OF_FILES.contains(&&**key) || has_name(value))
            }
            toml::Value::Array(values) => values.iter().any(has_name),
            _ => false,
        }
    }
    let is_of_file = |layer: &Layer| layer.text.parse::<toml::Table>().is_ok_and(|table| has_name(&table.into()));
    Ok(given.layers()?.iter().find(|layer| is_of_file(layer)).map(|layer| layer.flag))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_that_name_files_are_known() {
        for (name, value, is_file) in [
            ("topology", "a.pdb", true),
            ("set", "data=\"a.pdb\"", true),
            ("set", "sky={image=\"a.hdr\"}", true),
            ("set", "data.topology=\"a.pdb\"", true),
            ("set", "film.width=30", false),
            ("label", "data = file@top", false),
            ("select", "element C", false),
        ] {
            let given = Given::default().with(name, Some(value.to_owned()));
            assert_eq!(names_files(&given).unwrap().is_some(), is_file, "{name} {value}");
        }
    }
}
