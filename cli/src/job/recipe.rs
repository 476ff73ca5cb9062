//! A job as flags of `render`: the arguments that it was split with, for another output.

use std::path::Path;

use anyhow::{Context, anyhow};
use clap::{Parser, Subcommand};

use super::args::{JobArgs, JobCommand, SplitArgs};
use super::manifest::Manifest;
use crate::device::Device;
use crate::failure::Failure;
use crate::frames::Wanted;
use crate::input::Input;
use crate::render::Job;
use crate::render_args::RenderArgs;

/// A command line of `job`, without the other commands.
#[derive(Debug, Parser)]
struct JobLine {
    #[command(subcommand)]
    command: OnlyJob,
}

#[derive(Debug, Subcommand)]
enum OnlyJob {
    Job(JobArgs),
}

/// The flags of `split` that a job keeps.
pub(super) fn split_args(arguments: &[String]) -> Result<SplitArgs, Failure> {
    let parsed = JobLine::try_parse_from(arguments).ok().map(|parsed| parsed.command);
    match parsed {
        Some(OnlyJob::Job(JobArgs { command: JobCommand::Split(args) })) => Ok(*args),
        _ => Err(Failure::Job(anyhow!(
            "the job has arguments that this program does not know; split it again"
        ))),
    }
}

/// The pictures of a job, as `render` would make them.
pub(super) struct Recipe {
    pub(super) args: RenderArgs,
    /// `None` for a single picture.
    pub(super) wanted: Option<Wanted>,
    pub(super) job: Job,
}

impl Recipe {
    /// The pictures without a place where they are written. `folder` is one that exists and in which files can be
    /// created.
    pub(super) fn of_parts(
        arguments: &[String],
        folder: &Path,
        quiet: bool,
    ) -> Result<Self, Failure> {
        let SplitArgs { mut render, exr, .. } = split_args(arguments)?;
        let extension = if exr { "exr" } else { "png" };
        let number = if render.frames.asks_for_several() { "%d" } else { "" };
        render.output = Some(folder.join(format!(".pinhole-job-{number}.{extension}")));
        render.layers = Vec::new();
        render.report.quiet |= quiet;
        Self::new(render)
    }

    /// The pictures of these flags.
    pub(super) fn new(args: RenderArgs) -> Result<Self, Failure> {
        let output = args.output.as_deref().unwrap_or(Path::new("-"));
        let wanted = Wanted::new(&args)?;
        let job = Job::new(&args, wanted.as_ref().map_or(output, Wanted::picture))?;
        Ok(Self { wanted, job, args })
    }

    /// The same pictures, for work that needs no device.
    pub(super) fn without_device(mut self) -> Self {
        self.job.device = Device::Cpu;
        self
    }
}

/// Refuses input that makes other pictures than those that were split.
pub(super) fn check_same(
    manifest: &Manifest,
    numbers: Option<&[usize]>,
    input: &Input,
) -> Result<(), Failure> {
    let size = [input.film.width(), input.film.height()];
    let eyes = if input.eyes.is_some() { 2 } else { 1 };
    let is_same =
        manifest.pictures.as_deref() == numbers && manifest.size == size && manifest.eyes == eyes;
    let changed = "the input makes other pictures than those that were split; split the job again";
    Ok(is_same.then_some(()).context(changed)?)
}
