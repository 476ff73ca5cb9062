//! The checks of `pinhole verify`, and its output files, which are written all or none.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::input::read_file::open_seekable;
use crate::output::files::{
    NewFolder, check_distinct, check_not_inputs, check_writable, name_all, unnamed, unnamed_with,
};
use crate::proof::verify::args::VerifyArgs;
use crate::proof::verify::page::page;
use crate::proof::verify::report::{JudgedLight, Report};
use crate::terminal::failure::Failure;
use crate::terminal::text::json;
use crate::terminal::{progress, threads};
use pinhole::verify::Certificate;
use pinhole::verify::run_file::{self, Run};

/// A recording to check, and the outputs to write.
pub(crate) struct VerifyJob {
    pub(crate) run: Run,
    pub(crate) outputs: VerifyOutputs,
    /// The light of a scene with lighting, if it was rendered now.
    pub(crate) light: Option<JudgedLight>,
}

/// Reads a run file.
pub(crate) fn replay(path: &Path, args: &VerifyArgs) -> Result<VerifyJob, Failure> {
    let outputs = VerifyOutputs::new(args)?;
    outputs.check_not_inputs(&[path.to_path_buf()])?;
    threads::start()?;
    progress::stage(format!("reading {}", path.display()));
    let run = run_file::read_from(&mut open_seekable(path)?).with_context(|| path.display().to_string())?;
    Ok(VerifyJob { run, outputs, light: None })
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
        light: Option<&JudgedLight>,
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
                let shown = light.map(|light| &light.shown);
                let page = page(run, certificate, report, shown, self.run.as_deref().map(Path::display))?;
                files.push((path, unnamed(path, page.as_bytes())?));
            }
            if let Some(path) = &self.save {
                progress::stage("writing the run");
                let Run { scene, recording, provenance } = run;
                let file =
                    unnamed_with(path, |file| run_file::write(scene, recording, provenance, file.as_file_mut()))?;
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
