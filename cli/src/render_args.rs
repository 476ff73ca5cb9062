//! The flags of `render`, which are also those of pictures that other commands make.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use super::frames::args::FramesArgs;
use super::light::LightArgs;
#[cfg(feature = "gpu")]
use super::profile::ProfileArgs;
use super::report::ReportArgs;
use super::stop_rule::StopArgs;
use crate::annotation::EncodingArgs;
use crate::args::{AccelArgs, DeviceArgs, InputArgs, Stereo};
use crate::data_flags::{ColorArgs, StructureArgs};

#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    pub(super) input: InputArgs,
    /// File for the picture (.png or .exr), or - to write PNG to standard output; see also --frames
    #[arg(short, long, value_name = "OUT.png", required_unless_present = "print_scene")]
    pub(super) output: Option<PathBuf>,
    #[command(flatten)]
    pub(super) frames: FramesArgs,
    #[command(flatten)]
    pub(super) encoding: EncodingArgs,
    #[command(flatten)]
    pub(super) structure: StructureArgs,
    #[command(flatten)]
    pub(super) color: ColorArgs,
    #[command(flatten)]
    pub(super) light: LightArgs,
    #[command(flatten)]
    pub(super) stop_rule: StopArgs,
    #[command(flatten)]
    pub(super) device: DeviceArgs,
    #[command(flatten)]
    pub(super) accel: AccelArgs,
    /// Data layer to write in addition: LAYER=FILE.npy writes a NumPy array, and LAYER alone adds it to an .exr
    /// picture. Layers are color, alpha, depth, normal, position, albedo, id, samples and variance; may be repeated
    #[arg(long = "layer", value_name = "LAYER[=FILE.npy]")]
    pub(super) layers: Vec<String>,
    /// How the two pictures of a stereo camera are written [default: side-by-side]
    #[arg(long, value_enum)]
    pub(super) stereo: Option<Stereo>,
    /// Judge the samples of the picture before they are written, and write the certificate into the file, for
    /// `pinhole verify PICTURE --scene SCENE`. Pictures with light are compared with the CPU reference's, which takes as
    /// long as that takes
    #[arg(long, conflicts_with_all = ["print_scene", "stereo"])]
    pub(super) certify: bool,
    #[cfg(feature = "gpu")]
    #[command(flatten)]
    pub(super) profile: ProfileArgs,
    #[command(flatten)]
    pub(super) report: ReportArgs,
}

/// A command line of `render`, for those who need no other command.
#[derive(Debug, Parser)]
pub(super) struct RenderLine {
    #[command(subcommand)]
    pub(super) command: RenderCommand,
}

#[derive(Debug, Subcommand)]
pub(super) enum RenderCommand {
    Render(Box<RenderArgs>),
}
