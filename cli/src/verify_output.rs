//! Writes the files of `pinhole verify`: all of them, or none.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::args::VerifyArgs;
use super::failure::Failure;
use super::output::{
    NewFolder, check_distinct, check_not_inputs, check_writable, name_all, unnamed, unnamed_with,
};
use super::progress;
use super::verify_kept::Kept;
use super::verify_page::page;
use super::verify_report::Report;
use pinhole::verify::Certificate;
use pinhole::verify::run_file::{self, Run};

/// File name of the page in the folder of a report.
const PAGE: &str = "report.html";

/// The outputs of a check, checked before any work is done.
pub(super) struct VerifyOutputs {
    json: Option<PathBuf>,
    save: Option<PathBuf>,
    folder: Option<NewFolder>,
    page: Option<PathBuf>,
    /// The run file that holds the checked recording, if there is one.
    run: Option<PathBuf>,
}

impl VerifyOutputs {
    pub(super) fn new(args: &VerifyArgs) -> Result<Self, Failure> {
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
        // The name of a folder that does not exist yet must also differ from the others.
        check_distinct(args.json.iter().chain(&args.save).chain(&args.report))?;
        Ok(outputs)
    }

    fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.json.iter().chain(&self.save).chain(&self.page)
    }

    /// Whether a lit picture for people is written, in a page or a run file.
    #[cfg(feature = "gpu")]
    pub(super) fn has_picture(&self) -> bool {
        self.page.is_some() || self.save.is_some()
    }

    /// The run file to be written.
    #[cfg(feature = "gpu")]
    pub(super) fn save(&self) -> Option<&Path> {
        self.save.as_deref()
    }

    /// Refuses to overwrite an input.
    pub(super) fn check_not_inputs(&self, inputs: &[PathBuf]) -> Result<(), Failure> {
        check_not_inputs(self.paths(), inputs)
    }

    /// Encodes and writes all outputs.
    pub(super) fn write(
        &self,
        run: &Run,
        certificate: &Certificate,
        report: &Report,
        kept: &Kept,
    ) -> Result<()> {
        match &self.folder {
            Some(folder) => folder.with(|| self.write_files(run, certificate, report, kept)),
            None => self.write_files(run, certificate, report, kept),
        }
    }

    fn write_files(
        &self,
        run: &Run,
        certificate: &Certificate,
        report: &Report,
        kept: &Kept,
    ) -> Result<()> {
        let mut files = Vec::new();
        if let Some(path) = &self.json {
            progress::stage("writing");
            let json = serde_json::to_string_pretty(report)
                .context("the report cannot be written as JSON")?
                + "\n";
            files.push((path, unnamed(path, json.as_bytes())?));
        }
        if let Some(path) = &self.page {
            progress::stage("drawing the report");
            let page = page(
                run,
                certificate,
                report,
                kept.shown.as_ref(),
                self.run.as_deref().map(Path::display),
            )?;
            files.push((path, unnamed(path, page.as_bytes())?));
        }
        if let Some(path) = &self.save {
            progress::stage("writing the run");
            let Run { scene, recording, provenance } = run;
            let file = unnamed_with(path, |file| {
                let file = file.as_file_mut() as &mut dyn Write;
                run_file::write_with(scene, recording, provenance, kept.extras(), file)
            })?;
            files.push((path, file));
        }
        name_all(files)
    }
}
