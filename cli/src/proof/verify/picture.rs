//! `pinhole verify PICTURE --scene SCENE`: checks a picture that `render --certify` wrote, and its certificate.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use serde::Serialize;

use crate::input::{Input, read};
use crate::output::files::{check_not_inputs, check_writable, name_all, unnamed};
use crate::output::picture::{Outputs, PictureFormat};
use crate::proof::certified::{self, FilePicture};
use crate::proof::render_certified::witness;
use crate::proof::verify::args::VerifyArgs;
use crate::proof::verify::report::command_line;
use crate::render::device::Device;
use crate::render::stop_rule::StopRule;
use crate::render::{Job, ghosts};
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, answer};
use crate::terminal::text::{self, in_quotes};
use crate::terminal::threads;
use pinhole::image::Image;
use pinhole::image::encoding::Encoding;
use pinhole::internals::text::{one_line, whole_line};
use pinhole::render::Integrator;
use pinhole::verify::finished::{FinishedCertificate, PixelVerdict};
use pinhole::verify::picture_certificate::PictureCertificate;
use pinhole::verify::{Checker, Outcome};
use pinhole_figure::read::picture::{self, FileSamples};

/// The JSON document of `--json`.
#[derive(Serialize)]
struct Report<'a> {
    version: &'static str,
    picture: String,
    width: u32,
    height: u32,
    adapter: &'a str,
    /// The keys that the certificate says and nothing proves.
    hearsay: [&'static str; 1],
    settings: &'a [[String; 2]],
    exact: usize,
    legal: usize,
    wide: usize,
    open: usize,
    violated: usize,
    violation: Option<String>,
    outcome: Outcome,
    command: String,
}

pub(crate) fn run(args: &VerifyArgs, path: &Path, scene: &Path) -> Result<(), Failure> {
    args.json.as_deref().map_or(Ok(()), check_writable)?;
    threads::start()?;
    let of_picture = || path.display().to_string();
    let file = picture::read(&read(path)?).with_context(of_picture)?;
    let text = file
        .certificate
        .as_deref()
        .ok_or_else(|| anyhow!("{}: the picture has no certificate; render it with --certify", path.display()))?;
    let certificate = PictureCertificate::from_text(text).with_context(of_picture)?;
    let written = FilePicture { size: file.size, samples: file.samples };
    certified::check_samples(&certificate, &written).with_context(of_picture)?;
    // The settings are those of the file, not of the user.
    let unsuited = |failure| match failure {
        Failure::Usage(error) => {
            Failure::from(anyhow!("{}: the certificate's settings do not suit the scene: {error}", path.display()))
        }
        other => other,
    };
    let job = job(path, scene, &certificate, &written.samples).map_err(unsuited)?;
    let mut input = job.source.load().map_err(unsuited)?;
    let files: Vec<_> = input.files.iter().cloned().chain([path.to_path_buf()]).collect();
    check_not_inputs(args.json.iter(), &files)?;
    let note = progress::notes(false);
    input.notes.iter().for_each(|text| note(text));
    ghosts::refuse(&input, &path.display().to_string())?;
    certified::check_scene(&certificate, &input).with_context(of_picture)?;
    let (encoding, annotations) = job.finish(&mut input, note)?;
    let outputs = Outputs { annotations, ..job.outputs };
    check_kind(path, &written, &input, &encoding)?;
    check_work(path, &input, args.work)?;
    // If the reference alone does not decide, an adapter of this machine may give light that is known to be legal.
    let find = |checker: &Checker<'_>, input: &mut Input, exact: &Image| {
        witness(checker, input, exact, &Device::any().open()?)
    };
    let judged = certified::judge(&mut input, &encoding, &outputs, &written, FinishedCertificate::outcome, &find)?;
    progress::clear();
    let shown = |[name, value]: &[String; 2]| format!(" --{name}={}", in_quotes(&one_line(value)));
    let settings = whole_line(&certificate.settings.iter().map(shown).collect::<String>());
    let table = format!("{:<12}{settings}\n{}", "settings", certified::table(&judged));
    answer(table.as_bytes())?;
    if let Some(json) = &args.json {
        let [width, height] = written.size;
        let [exact, legal, wide, open, violated] = [0, 1, 2, 3, 4].map(|index| judged.count(PixelVerdict::ALL[index]));
        let report = Report {
            version: env!("CARGO_PKG_VERSION"),
            picture: path.display().to_string(),
            width,
            height,
            adapter: &one_line(&certificate.adapter),
            hearsay: ["adapter"],
            settings: &certificate.settings,
            exact,
            legal,
            wide,
            open,
            violated,
            violation: judged.violations.first().map(ToString::to_string),
            outcome: judged.outcome(),
            command: command_line(),
        };
        let text = text::json(&report)?;
        name_all(vec![(json, unnamed(json, text.as_bytes())?)])?;
    }
    certified::verdict(&judged)
}

/// Makes the job of the certificate's settings for this scene.
fn job(path: &Path, scene: &Path, certificate: &PictureCertificate, samples: &FileSamples) -> Result<Job, Failure> {
    let refused = || {
        let [path, version] = [path.display().to_string(), one_line(&certificate.version)];
        anyhow!("{path}: this program does not understand the settings in the certificate; use version {version}")
    };
    let given = certified::given(certificate).ok_or_else(refused)?;
    let format = match samples {
        FileSamples::Encoded { .. } => PictureFormat::Png,
        FileSamples::Linear(_) => PictureFormat::Exr,
    };
    let job = Job::on_cpu(scene, &given, StopRule::default(), Outputs::unwritten(format))?;
    Ok(Job { source: job.source.without_bricks("`verify`")?, ..job })
}

/// Refuses a picture whose samples have another size or kind than the settings imply.
fn check_kind(path: &Path, written: &FilePicture, input: &Input, encoding: &Encoding) -> Result<()> {
    let eyes = if input.eyes.is_some() { 2 } else { 1 };
    let [width, height] = [input.film.width() * eyes, input.film.height()];
    let [across, down] = written.size;
    let path = path.display();
    if [width, height] != written.size {
        return Err(anyhow!(
            "{path}: the picture is {across}x{down}, but the certificate's settings ask for {width}x{height}"
        ));
    }
    let FileSamples::Encoded { bits, has_alpha, .. } = &written.samples else { return Ok(()) };
    if (*bits, *has_alpha) == (encoding.bits, encoding.transparent) {
        return Ok(());
    }
    Err(anyhow!(
        "{path}: the samples have {} bits {} alpha, but the certificate's settings ask for {} {}",
        bits.count(),
        if *has_alpha { "with" } else { "without" },
        encoding.bits.count(),
        if encoding.transparent { "with it" } else { "without it" }
    ))
}

/// Refuses a picture for which the reference would compute longer than the user allows.
fn check_work(path: &Path, input: &Input, most: f64) -> Result<()> {
    let settings = &input.settings;
    let rays_of_sample = match &settings.integrator {
        Integrator::Primary(_) => 1,
        Integrator::Studio(studio) => {
            let are_opaque = input.scene.appearance().surfaces().iter().all(|surface| surface.opacity >= 1.0);
            let surfaces = if are_opaque { 1 } else { studio.max_surfaces as usize };
            surfaces * (1 + settings.lights.len() + studio.occlusion.map_or(0, |occlusion| occlusion.samples as usize))
        }
        Integrator::Path(path) => 2 * path.max_depth as usize,
    };
    let samples = if settings.integrator.is_primary() { 1 } else { settings.sampling.samples };
    let rays = input.film.pixel_count() as f64 * f64::from(samples) * rays_of_sample as f64;
    if rays <= most {
        return Ok(());
    }
    Err(anyhow!(
        "{}: checking this picture takes up to {rays:.1e} rays, and --work allows {most:.1e}; if the certificate's \
         settings are what you want, add --work {rays:.1e}",
        path.display()
    ))
}
