//! `pinhole verify PICTURE --scene SCENE`: checks a picture that `render --certify` wrote, and its certificate.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use clap::Parser;
use serde::Serialize;

use crate::flags::render::{RenderCommand, RenderLine};
use crate::input::read;
use crate::output::files::{check_not_inputs, check_writable, name_all, unnamed};
use crate::output::picture::{Outputs, PictureFormat};
use crate::proof::certified::{self, FilePicture};
use crate::proof::verify::args::VerifyArgs;
use crate::proof::verify::report::command_line;
use crate::render::Job;
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, answer};
use crate::terminal::text::{self, in_quotes};
use crate::terminal::threads;
use pinhole::image::encoding::Encoding;
use pinhole::internals::text::{one_line, whole_line};
use pinhole::verify::Outcome;
use pinhole::verify::picture_certificate::PictureCertificate;
use pinhole_figure::read::picture::{self, FileSamples};

/// The JSON document of `--json`.
#[derive(Serialize)]
struct Report<'a> {
    version: &'static str,
    picture: String,
    width: u32,
    height: u32,
    adapter: &'a str,
    samples_per_pixel: u32,
    judged_by: &'static str,
    proved: u64,
    undecided: u64,
    violated: u64,
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
    let written = FilePicture { size: file.size, samples: file.samples, per_pixel: certificate.samples_per_pixel };
    certified::check_samples(&certificate, &written).with_context(of_picture)?;
    let (job, flags) = job(path, scene, &certificate, &written.samples)?;
    let mut input = job.source.load()?;
    let files: Vec<_> = input.files.iter().cloned().chain([path.to_path_buf()]).collect();
    check_not_inputs(args.json.iter(), &files)?;
    let note = progress::notes(false);
    input.notes.iter().for_each(|text| note(text));
    certified::check_scene(&certificate, &input).with_context(of_picture)?;
    let (encoding, _) = job.finish(&mut input, note)?;
    check_kind(path, &written.samples, &encoding)?;
    let layers = job.outputs.layers(&encoding);
    let judged = certified::judge(&mut input, &encoding, layers, &written)?;
    progress::clear();
    let table = format!("{:<12}{flags}\n{}", "rendered by", judged.table());
    answer(table.as_bytes())?;
    if let Some(json) = &args.json {
        let ([width, height], [proved, undecided, violated]) = (written.size, judged.counts());
        let report = Report {
            version: env!("CARGO_PKG_VERSION"),
            picture: path.display().to_string(),
            width,
            height,
            adapter: &one_line(&certificate.adapter),
            samples_per_pixel: written.per_pixel,
            judged_by: judged.by().name(),
            proved,
            undecided,
            violated,
            violation: judged.violation(),
            outcome: judged.outcome(),
            command: command_line(),
        };
        let text = text::json(&report)?;
        name_all(vec![(json, unnamed(json, text.as_bytes())?)])?;
    }
    judged.verdict()
}

/// Makes the job from the certificate's arguments for this scene, with its command line.
fn job(
    path: &Path,
    scene: &Path,
    certificate: &PictureCertificate,
    samples: &FileSamples,
) -> Result<(Job, String), Failure> {
    let words = ["pinhole", "render"].map(std::ffi::OsString::from);
    let flags = certificate.arguments.iter().map(Into::into);
    let ends = ["-o".into(), "-".into(), "--".into(), scene.as_os_str().to_owned()];
    let refused = || {
        anyhow!(
            "{}: this program does not understand the arguments in the certificate; use version {}",
            path.display(),
            certificate.version
        )
    };
    let parsed = RenderLine::try_parse_from(words.into_iter().chain(flags).chain(ends));
    let Ok(RenderLine { command: RenderCommand::Render(args) }) = parsed else {
        return Err(refused().into());
    };
    if !args.layers.is_empty() {
        return Err(refused().into());
    }
    let format = match samples {
        FileSamples::Encoded { .. } => PictureFormat::Png,
        FileSamples::Linear(_) => PictureFormat::Exr,
    };
    let job = Job::with_outputs(&args, Outputs::unwritten(format))?;
    let flags = certificate.arguments.iter().map(|word| in_quotes(word)).collect::<Vec<_>>().join(" ");
    Ok((job, whole_line(&format!("pinhole render {} {}", in_quotes(&scene.to_string_lossy()), one_line(&flags)))))
}

/// Refuses a picture whose samples have another kind than the arguments imply.
fn check_kind(path: &Path, samples: &FileSamples, encoding: &Encoding) -> Result<()> {
    let FileSamples::Encoded { bits, has_alpha, .. } = samples else { return Ok(()) };
    if (*bits, *has_alpha) == (encoding.bits, encoding.transparent) {
        return Ok(());
    }
    Err(anyhow!(
        "{}: the samples have {} bits {} alpha, but the certificate's arguments ask for {} {}",
        path.display(),
        bits.count(),
        if *has_alpha { "with" } else { "without" },
        encoding.bits.count(),
        if encoding.transparent { "with it" } else { "without it" }
    ))
}
