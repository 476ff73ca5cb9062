//! Pictures that many machines render: `split` divides them into units, `part` renders units, `status` lists those that
//! are missing, and `merge` puts the parts together. Schedulers hand units to machines: `docs/scale.md` has recipes.
//!
//! A folder is all that the machines share. `job.json` is written once; every part is a file that appears whole or not at
//! all and knows its job by the digest of `job.json`. Nothing else coordinates them.

mod files;
mod folder;
mod manifest;
mod merge;
mod part;
mod part_file;
mod recipe;
mod split;
mod units;

use std::path::PathBuf;

use anyhow::Context;
use clap::{Args, Subcommand};

use self::folder::Folder;
use super::args::RenderArgs;
use super::failure::Failure;
use super::frames::Raw;
use super::speak::answer;
use super::threads;

const EXIT_CODES: &str = "Exit codes: 0 done; 1 the job failed, or parts are missing, damaged or of another job; \
    2 wrong usage, such as an INDEX that the job has not; 5 the device was lost or did not answer, or the time of \
    --timeout is over: try again; 130 stopped by a signal.";

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(super) struct JobArgs {
    #[command(subcommand)]
    command: JobCommand,
}

#[derive(Debug, Subcommand)]
enum JobCommand {
    /// Divide pictures into parts, and write what describes them into a folder
    Split(Box<SplitArgs>),
    /// Render parts; those that are there already are left as they are
    Part(PartArgs),
    /// List the units that have no part, for another try
    Status(StatusArgs),
    /// Put the parts together: the same bytes as `render` writes on one machine
    Merge(MergeArgs),
}

#[derive(Debug, Args)]
#[command(
    mut_arg("output", |arg| arg.value_name("JOB/").help("Folder of the job, which is created and must not exist")),
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
    after_help = "The other flags are those of `render`. Each unit of work is one tile of one picture; its INDEX \
    counts from 0, picture by picture and in each the tiles row by row."
)]
#[cfg_attr(feature = "gpu", command(mut_arg("profile", |arg| arg.hide(true))))]
struct SplitArgs {
    #[command(flatten)]
    render: RenderArgs,
    /// Divide each picture into columns and rows of tiles, such as 4x4
    #[arg(long, value_name = "CxR", default_value = "1x1")]
    tiles: String,
    /// Divide the spheres of a file of bricks into this many groups, and not the picture into tiles: each part reads one
    /// group, and `merge` keeps what is nearest. For pictures with one ray for each pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "tiles")]
    by_depth: Option<u32>,
    /// Prepare for EXR pictures, whose cameras leave no room for legends
    #[arg(long)]
    exr: bool,
}

#[derive(Debug, Args)]
struct PartArgs {
    /// Folder of the job
    #[arg(value_name = "JOB")]
    job: PathBuf,
    /// Indices of the units to render, such as 7, or 0-15,20 as for sbatch --array
    #[arg(value_name = "INDEX")]
    units: String,
    /// End with exit code 5 if a unit, or opening the device, takes longer than this, in seconds, for drivers that hang
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    timeout: Option<f64>,
    /// Say nothing but warnings and errors
    #[arg(short, long)]
    quiet: bool,
}

#[derive(Debug, Args)]
struct StatusArgs {
    /// Folder of the job
    #[arg(value_name = "JOB")]
    job: PathBuf,
    /// Print the INDEX of every unit that has no part, or one that is damaged or of another job, one a line
    #[arg(long, required = true)]
    missing: bool,
    /// Read every part to its end and check its digest
    #[arg(long)]
    check: bool,
}

#[derive(Debug, Args)]
struct MergeArgs {
    /// Folder of the job
    #[arg(value_name = "JOB")]
    job: PathBuf,
    /// File for the picture, a pattern such as f%04d.png, a movie, or -, as for `render`
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
    /// Data layer to write in addition, as for `render`; the job must have been split with it
    #[arg(long = "layer", value_name = "LAYER[=FILE.npy]")]
    layers: Vec<String>,
    /// Pictures of a movie for each second, from 1 to 240 [default: that of `split`, or 25]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=240))]
    fps: Option<u32>,
    /// Write a movie that is not compressed to standard output, with -o -
    #[arg(long, value_enum)]
    raw: Option<Raw>,
    /// Join parts of different adapters or drivers, whose pixels may differ in the last bits
    #[arg(long)]
    allow_mixed_adapters: bool,
    /// Wait this long, in seconds, for parts that are not seen yet, as on network file systems
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, allow_hyphen_values = true)]
    wait: f64,
    /// Say nothing but warnings and errors
    #[arg(short, long)]
    quiet: bool,
}

pub(super) fn run(args: &JobArgs) -> Result<(), Failure> {
    match &args.command {
        JobCommand::Split(args) => split::run(args),
        JobCommand::Part(args) => part::run(args),
        JobCommand::Status(args) => status(args),
        JobCommand::Merge(args) => merge::run(args),
    }
}

/// Lists the units that are to be rendered.
fn status(args: &StatusArgs) -> Result<(), Failure> {
    let folder = Folder::open(&args.job)?;
    threads::start()?;
    let found = if args.check { folder.check() } else { folder.glance() };
    let missing = (0..found.len()).filter(|unit| found[*unit].is_err());
    let text: String = missing.map(|unit| format!("{unit}\n")).collect();
    Ok(answer(text.as_bytes()).context("standard output: cannot be written")?)
}
