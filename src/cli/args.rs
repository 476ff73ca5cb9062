//! Arguments as they are typed. What they mean is checked where it is used.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use super::camera::CameraArgs;
use super::data::DataFormat;
use super::generate::kinds;

/// Ray traces spheres with compute shaders, without a display.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, disable_help_subcommand = true)]
#[command(after_help = "Exit codes: 0 done; 1 the job failed; 2 wrong usage.")]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Render a scene file or a data file
    Render(Box<RenderArgs>),
    /// Write the scene file of three spheres into this folder and render it
    Demo(DemoArgs),
    /// Write a file of made-up spheres, for trying things out and measuring
    Generate(GenerateArgs),
    /// List adapters, drivers, limits and features
    Info(InfoArgs),
}

#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    pub(super) input: InputArgs,
    /// The picture (.png), or - for PNG on standard output
    #[arg(short, long, value_name = "OUT.png")]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) device: DeviceArgs,
    /// Also write a layer (color, depth, normal, id) as a NumPy array; may be repeated
    #[arg(long = "layer", value_name = "LAYER=FILE.npy")]
    pub(super) layers: Vec<String>,
}

/// What is shown, and from where. [`super::input::Source`] checks it.
#[derive(Debug, Args)]
pub(super) struct InputArgs {
    /// A scene file (.toml), or a data file (.xyz, .extxyz, .npy, .npz, .bin), which is framed by itself
    #[arg(value_name = "SCENE_OR_DATA")]
    pub(super) input: PathBuf,
    /// What a data file is, whatever its extension says
    #[arg(long, value_enum)]
    pub(super) format: Option<DataFormat>,
    /// The radius of all spheres of an array of shape (n, 3)
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(super) radius: Option<f64>,
    /// The CSS color of all spheres of data without colors [default: #cccccc]
    #[arg(long, value_name = "CSS")]
    pub(super) color: Option<String>,
    /// Which frame of a trajectory, counted from 0 [default: the scene's, or 0]
    #[arg(long, value_name = "N")]
    pub(super) frame: Option<usize>,
    /// Size in pixels, such as 800x600 [default: the scene's, or 800x600]
    #[arg(long, value_name = "WxH")]
    pub(super) size: Option<String>,
    #[command(flatten)]
    pub(super) camera: CameraArgs,
}

#[derive(Debug, Args)]
pub(super) struct DemoArgs {
    #[command(flatten)]
    pub(super) device: DeviceArgs,
}

#[derive(Debug, Args)]
pub(super) struct GenerateArgs {
    /// What the spheres look like
    #[arg(value_name = "KIND", value_parser = kinds())]
    pub(super) kind: String,
    /// How many spheres
    #[arg(short = 'n', value_name = "N")]
    pub(super) count: u64,
    /// The file: a NumPy array (.npy), or raw f32 (.bin), x, y, z, radius
    #[arg(short, long, value_name = "OUT.npy")]
    pub(super) output: PathBuf,
    /// The same kind, number and seed give the same file on every machine
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub(super) seed: u64,
}

#[derive(Debug, Args)]
pub(super) struct DeviceArgs {
    /// What renders: a GPU if there is an adapter, a GPU, or the CPU reference
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    pub(super) backend: Backend,
    /// The adapter whose name contains this text [default: `WGPU_ADAPTER_NAME`, or the best one]
    #[arg(long, value_name = "NAME")]
    pub(super) adapter: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Backend {
    Auto,
    Gpu,
    Cpu,
}

#[derive(Debug, Args)]
pub(super) struct InfoArgs {
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}
