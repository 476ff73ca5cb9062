//! The checks of `pinhole verify`, and its output files, which are written all or none.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::input::read_file::open_seekable;
use crate::output::files::{
    NewFolder, check_distinct, check_not_inputs, check_writable, name_all, unnamed, unnamed_with,
};
use crate::proof::verify::args::VerifyArgs;
use crate::proof::verify::page::page;
use crate::proof::verify::report::{self, Report};
use crate::terminal::failure::Failure;
use crate::terminal::text::json;
use crate::terminal::{progress, threads};
use pinhole::image::Image;
use pinhole::verify::denoised::DenoiseCertificate;
use pinhole::verify::finished::FinishedCertificate;
use pinhole::verify::run_file::{self, Extras, FinalPicture, LitSamples, Run, RunFile};
use pinhole::verify::{Certificate, Checker, LitCertificate};

/// A recording to check, and the outputs to write.
pub(crate) struct VerifyJob {
    pub(crate) run: Run,
    pub(crate) outputs: VerifyOutputs,
    /// The certificate of the light, if it was checked.
    pub(crate) light: Option<LitCertificate>,
    /// The certificate of the denoiser, if the scene asks for it.
    pub(crate) denoiser: Option<DenoiseCertificate>,
    /// The verdicts about the picture that `render` makes with light, if it was judged.
    pub(crate) rendered: Option<FinishedCertificate>,
    /// Data about the light, for a run file and the page.
    pub(crate) kept: KeptLight,
}

/// Data of a lit picture that are kept.
#[derive(Default)]
pub(crate) struct KeptLight {
    /// The recorded samples, if a run file is written.
    pub(crate) samples: Option<LitSamples>,
    /// The noisy picture and the denoised one.
    pub(crate) denoised: Option<[Image; 2]>,
    /// The lit picture to show.
    pub(crate) shown: Option<FinalPicture>,
}

/// Reads a run file and judges the light in it, sample by sample.
pub(crate) fn replay(path: &Path, args: &VerifyArgs) -> Result<VerifyJob, Failure> {
    let outputs = VerifyOutputs::new(args)?;
    outputs.check_not_inputs(&[path.to_path_buf()])?;
    threads::start()?;
    progress::stage(format!("reading {}", path.display()));
    let mut source = open_seekable(path)?;
    let of_file = || path.display().to_string();
    let file = RunFile::open(&mut source).with_context(of_file)?;
    let run = file.run().with_context(of_file)?;
    let checker = Checker::new(&run.scene).context("the checker cannot be prepared")?;
    progress::stage("checking light");
    let mut certificate = LitCertificate::default();
    let has_light = file.light(&run, &mut |recording| {
        certificate.join(checker.certify_lit(recording));
    });
    let has_light = has_light.with_context(of_file)?;
    drop(checker);
    let denoised = file.denoised().with_context(of_file)?;
    let denoiser = denoised.as_ref().map(report::judge).transpose()?;
    let kept = KeptLight { shown: file.shown().with_context(of_file)?, ..KeptLight::default() };
    Ok(VerifyJob { run, outputs, light: has_light.then_some(certificate), denoiser, rendered: None, kept })
}

const PAGE: &str = "report.html";

/// The outputs of a check, checked before any work is done.
pub(crate) struct VerifyOutputs {
    json: Option<PathBuf>,
    save: Option<PathBuf>,
    folder: Option<NewFolder>,
    page: Option<PathBuf>,
    /// The run file of the checked recording, if there is one.
    run: Option<PathBuf>,
}

impl VerifyOutputs {
    pub(crate) fn new(args: &VerifyArgs) -> Result<Self, Failure> {
        for path in args.json.iter().chain(&args.save) {
            check_writable(path)?;
        }
        let folder = args.report.as_deref().map(|path| NewFolder::new(path, PAGE)).transpose()?;
        let outputs = Self {
            json: args.json.clone(),
            save: args.save.clone(),
            folder,
            page: args.report.as_deref().map(|folder| folder.join(PAGE)),
            run: args.replay.clone().or(args.save.clone()),
        };
        check_distinct(outputs.paths())?;
        // A folder that does not exist yet must also have a name that differs from the others.
        check_distinct(args.json.iter().chain(&args.save).chain(&args.report))?;
        Ok(outputs)
    }

    fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.json.iter().chain(&self.save).chain(&self.page)
    }

    pub(crate) fn check_not_inputs(&self, inputs: &[PathBuf]) -> Result<(), Failure> {
        check_not_inputs(self.paths(), inputs)
    }

    pub(crate) fn write(
        &self,
        run: &Run,
        certificate: &Certificate,
        report: &Report<'_>,
        kept: &KeptLight,
    ) -> Result<()> {
        let write = || {
            let mut files = Vec::new();
            if let Some(path) = &self.json {
                progress::stage("writing");
                let text = json(report)?;
                files.push((path, unnamed(path, text.as_bytes())?));
            }
            if let Some(path) = &self.page {
                progress::stage("drawing the report");
                let page = page(run, certificate, report, kept.shown.as_ref(), self.run.as_deref().map(Path::display))?;
                files.push((path, unnamed(path, page.as_bytes())?));
            }
            if let Some(path) = &self.save {
                progress::stage("writing the run");
                let extras = Extras {
                    light: kept.samples.as_ref(),
                    denoised: kept.denoised.as_ref().map(|[noisy, quiet]| [noisy, quiet]),
                    shown: kept.shown.as_ref(),
                };
                let Run { scene, recording, provenance } = run;
                let file = unnamed_with(path, |file| {
                    let file = file.as_file_mut() as &mut dyn Write;
                    run_file::write_with(scene, recording, provenance, extras, file)
                })?;
                files.push((path, file));
            }
            name_all(files)
        };
        match &self.folder {
            Some(folder) => folder.with(write),
            None => write(),
        }
    }
}
