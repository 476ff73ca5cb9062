//! The flags of `pinhole job`, and the meaning of the flags of `split` for parts and for `merge`.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::{Args, Parser, Subcommand};

use crate::flags::render::RenderArgs;
use crate::frames::SeriesRequest;
use crate::frames::args::Raw;
use crate::input::Input;
use crate::jobs::manifest::Manifest;
use crate::render::Job;
use crate::render::device::Device;
use crate::terminal::failure::Failure;

const EXIT_CODES: &str = "Exit codes: 0 done; 1 the job failed, or parts are missing, damaged or of another job; \
    2 wrong usage, such as an INDEX that the job has not; 5 the device was lost or did not answer, or the time of \
    --timeout is over: try again; 130 stopped by a signal.";

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct JobArgs {
    #[command(subcommand)]
    pub(crate) command: JobCommand,
}

#[derive(Debug, Subcommand)]
pub(crate) enum JobCommand {
    /// Divide pictures into parts, and write what describes them into a folder
    Split(Box<SplitArgs>),
    /// Render parts; those that are there already are left as they are
    Part(PartArgs),
    /// List the units that have no part, for another try
    Status(StatusArgs),
    /// Put the parts together: the same bytes as `render` writes on one machine
    ///
    /// Parts are trusted: their digests find accidents, and nothing judges their pixels or the adapter that they name.
    Merge(MergeArgs),
}

#[derive(Debug, Args)]
#[command(
    mut_arg("output", |arg| {
        arg.required(true).value_name("JOB/").help("Folder of the job, which is created and must not exist")
    }),
    mut_arg("layers", |arg| arg.value_name("LAYER").help(
        "Data layer that `merge` can write in addition: alpha, depth, normal, position, albedo, id, samples or \
         variance; may be repeated"
    )),
    mut_arg("time", |arg| arg.hide(true)),
    mut_arg("noise", |arg| arg.hide(true)),
    mut_arg("keep_partial", |arg| arg.hide(true)),
    mut_arg("resume", |arg| arg.hide(true)),
    mut_arg("raw", |arg| arg.hide(true)),
    mut_arg("stereo", |arg| arg.hide(true)),
    mut_arg("certify", |arg| arg.hide(true)),
    mut_arg("print_scene", |arg| arg.hide(true)),
    mut_arg("save_scene", |arg| arg.hide(true)),
    after_help = "The other flags are those of `render`. Each unit of work is one tile of one picture; its INDEX \
    counts from 0, picture by picture and in each the tiles row by row."
)]
#[cfg_attr(feature = "gpu", command(mut_arg("profile", |arg| arg.hide(true))))]
pub(crate) struct SplitArgs {
    #[command(flatten)]
    pub(crate) render: RenderArgs,
    /// Divide each picture into columns and rows of tiles, such as 4x4
    #[arg(long, value_name = "CxR", default_value = "1x1")]
    pub(crate) tiles: String,
    /// Divide the spheres of a file of bricks into this many groups, and not the picture into tiles: each part reads one
    /// group, and `merge` keeps what is nearest. For pictures with one ray for each pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "tiles")]
    pub(crate) by_depth: Option<u32>,
    /// Prepare for EXR pictures, whose cameras leave no room for legends
    #[arg(long)]
    pub(crate) exr: bool,
}

#[derive(Debug, Args)]
pub(crate) struct PartArgs {
    /// Folder of the job
    #[arg(value_name = "JOB")]
    pub(crate) job: PathBuf,
    /// Indices of the units to render, such as 7, or 0-15,20 as for sbatch --array
    #[arg(value_name = "INDEX")]
    pub(crate) units: String,
    /// End with exit code 5 if a unit, or opening the device, takes longer than this, in seconds, for drivers that hang
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub(crate) timeout: Option<f64>,
    /// Say nothing but warnings and errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct StatusArgs {
    /// Folder of the job
    #[arg(value_name = "JOB")]
    pub(crate) job: PathBuf,
    /// Print the INDEX of every unit that has no part, or one that is damaged or of another job, one a line
    #[arg(long, required = true)]
    pub(crate) missing: bool,
    /// Read every part to its end and check its digest
    #[arg(long)]
    pub(crate) check: bool,
}

#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// Folder of the job
    #[arg(value_name = "JOB")]
    pub(crate) job: PathBuf,
    /// File for the picture, a pattern such as f%04d.png, a movie, or -, as for `render`
    #[arg(short, long, value_name = "OUT.png")]
    pub(crate) output: PathBuf,
    /// Data layer to write in addition, as for `render`; the job must have been split with it
    #[arg(long = "layer", value_name = "LAYER[=FILE.npy]")]
    pub(crate) layers: Vec<String>,
    /// Pictures of a movie for each second, from 1 to 240 [default: that of `split`, or 25]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=240))]
    pub(crate) fps: Option<u32>,
    /// Write a movie that is not compressed to standard output, with -o -
    #[arg(long, value_enum)]
    pub(crate) raw: Option<Raw>,
    /// Join parts of different adapters or drivers, whose pixels may differ in the last bits
    #[arg(long)]
    pub(crate) allow_mixed_adapters: bool,
    /// Wait this long, in seconds, for parts that are not seen yet, as on network file systems
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_hyphen_values = true)]
    pub(crate) wait: f64,
    /// Say nothing but warnings and errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Parser)]
struct JobLine {
    #[command(subcommand)]
    command: OnlyJob,
}

#[derive(Debug, Subcommand)]
enum OnlyJob {
    Job(JobArgs),
}

/// Parses the flags of `split` that a job stores.
pub(crate) fn split_args(arguments: &[String]) -> Result<SplitArgs, Failure> {
    let parsed = JobLine::try_parse_from(arguments).ok().map(|parsed| parsed.command);
    match parsed {
        Some(OnlyJob::Job(JobArgs { command: JobCommand::Split(args) })) => Ok(*args),
        _ => Err(Failure::Job(anyhow!("the job has arguments that this program does not know; split it again"))),
    }
}

/// The pictures of a job, as `render` would make them.
pub(crate) struct Recipe {
    pub(crate) args: RenderArgs,
    /// The request for several pictures; `None` for a single picture.
    pub(crate) wanted: Option<SeriesRequest>,
    pub(crate) job: Job,
}

impl Recipe {
    /// Makes the pictures without a destination. `folder` must exist, and it must be possible to create files in
    /// it.
    pub(crate) fn of_parts(arguments: &[String], folder: &Path, quiet: bool) -> Result<Self, Failure> {
        let SplitArgs { mut render, exr, .. } = split_args(arguments)?;
        let extension = if exr { "exr" } else { "png" };
        let number = if render.frames.asks_for_several() { "%d" } else { "" };
        render.output = Some(folder.join(format!(".pinhole-job-{number}.{extension}")));
        render.layers = Vec::new();
        render.report.quiet |= quiet;
        Self::new(render)
    }

    pub(crate) fn new(args: RenderArgs) -> Result<Self, Failure> {
        let output = args.output.as_deref().unwrap_or(Path::new("-"));
        let wanted = SeriesRequest::new(&args)?;
        let job = Job::new(&args, wanted.as_ref().map_or(output, SeriesRequest::picture))?;
        Ok(Self { wanted, job, args })
    }

    /// Returns the same pictures for work that needs no device.
    pub(crate) fn without_device(mut self) -> Self {
        self.job.device = Device::Cpu;
        self
    }
}

/// Refuses input that would make other pictures than those that were split.
pub(crate) fn check_same(manifest: &Manifest, numbers: Option<&[usize]>, input: &Input) -> Result<(), Failure> {
    let size = [input.film.width(), input.film.height()];
    let eyes = if input.eyes.is_some() { 2 } else { 1 };
    let is_same = manifest.pictures.as_deref() == numbers && manifest.size == size && manifest.eyes == eyes;
    let changed = "the input makes other pictures than those that were split; split the job again";
    Ok(is_same.then_some(()).context(changed)?)
}
