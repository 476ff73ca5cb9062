//! The flags of `render`, which are also those of pictures that other commands make.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use crate::flags::common::{AccelArgs, DeviceArgs, InputArgs, Stereo};
use crate::flags::settings::{PICTURE, SettingArgs, arranged};
use crate::frames::args::FramesArgs;
use crate::output::report::ReportArgs;
use crate::render::stop_rule::StopArgs;
#[cfg(feature = "gpu")]
use crate::terminal::profile::ProfileArgs;

#[derive(Debug, Args)]
#[command(mut_args(arranged))]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) input: InputArgs,
    /// File for the picture (.png or .exr), or - to write PNG to standard output; see also --frames [default: the name
    /// of the input with .png, in the current folder, where no such file exists]
    #[arg(short, long, value_name = "OUT.png")]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) frames: FramesArgs,
    #[command(flatten)]
    pub(crate) look: SettingArgs<PICTURE>,
    #[command(flatten)]
    pub(crate) stop_rule: StopArgs,
    #[command(flatten)]
    pub(crate) device: DeviceArgs,
    #[command(flatten)]
    pub(crate) accel: AccelArgs,
    /// Data layer to write in addition: LAYER=FILE.npy writes a NumPy array, and LAYER alone adds it to an .exr
    /// picture. Layers are color, alpha, depth, normal, position, albedo, id, samples and variance; may be repeated
    #[arg(long = "layer", value_name = "LAYER[=FILE.npy]")]
    pub(crate) layers: Vec<String>,
    /// How the two pictures of a stereo camera are written [default: side-by-side]
    #[arg(long, value_enum)]
    pub(crate) stereo: Option<Stereo>,
    /// Judge the samples of the picture before they are written, and write the certificate into the file, for
    /// `pinhole verify PICTURE --scene SCENE`. Pictures with light are compared with the CPU reference's, which takes as
    /// long as that takes
    #[arg(long, conflicts_with_all = ["print_scene", "stereo"])]
    pub(crate) certify: bool,
    #[cfg(feature = "gpu")]
    #[command(flatten)]
    pub(crate) profile: ProfileArgs,
    #[command(flatten)]
    pub(crate) report: ReportArgs,
}

/// A command line of `render`, for those who need no other command.
#[derive(Debug, Parser)]
pub(crate) struct RenderLine {
    #[command(subcommand)]
    pub(crate) command: RenderCommand,
}

#[derive(Debug, Subcommand)]
pub(crate) enum RenderCommand {
    Render(Box<RenderArgs>),
}
