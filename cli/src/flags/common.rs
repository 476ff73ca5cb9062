//! Flags that several commands share, as clap parses them. Values are checked where they are used.

use std::path::PathBuf;

use clap::{Args, Command, Id, ValueEnum};

use crate::flags::settings::{SettingArgs, VIEW};
use crate::terminal::text::one_of;
use pinhole::accel::AccelChoice;
use pinhole_data::load::Format;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Stereo {
    /// In one picture of twice the width, with the left eye on the left
    SideBySide,
    /// In two files: OUT-left.png and OUT-right.png
    TwoFiles,
}

/// The scene and the view of it. [`crate::input::Source`] checks them.
#[derive(Debug, Args)]
pub(crate) struct InputArgs {
    #[arg(value_name = "SCENE_OR_DATA", help = input_help())]
    pub(crate) path: PathBuf,
    #[command(flatten)]
    pub(crate) view: SettingArgs<VIEW>,
}

/// The help of the input, which lists the extensions of all formats.
fn input_help() -> String {
    format!(
        "File to render: a scene file (.toml), or a data file ({}; .bin with --format), which the camera frames \
         automatically and which may be compressed (.gz, .xz, .bz2, .zst); `-` for standard input, with --format",
        Format::extensions_of(|_| true)
    )
}

#[derive(Debug, Args)]
pub(crate) struct DeviceArgs {
    /// What renders the picture
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    pub(crate) backend: Backend,
    #[command(flatten)]
    pub(crate) adapter: AdapterArgs,
}

/// Flags that choose the adapter and its limits.
#[derive(Debug, Args)]
pub(crate) struct AdapterArgs {
    /// Use the adapter whose name contains this text [default: `WGPU_ADAPTER_NAME`, or the best adapter]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Limits of the device that the program may use [default: adapter]
    #[arg(long, value_enum)]
    pub(crate) limits: Option<Limits>,
}

impl AdapterArgs {
    /// The first flag that asks for an adapter: one of these, or that of the structure.
    pub(crate) fn first_given(&self, accel: Option<AccelChoice>) -> Option<&'static str> {
        let given =
            [("--adapter", self.adapter.is_some()), ("--accel", accel.is_some()), ("--limits", self.limits.is_some())];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Limits {
    /// All limits that the adapter offers
    Adapter,
    /// The default limits of WebGPU, or less where the adapter offers less
    Webgpu,
}

#[derive(Debug, Args)]
pub(crate) struct AccelArgs {
    /// Acceleration structure with which an adapter finds the spheres that a ray hits [default: auto]
    #[arg(long, value_parser = one_of(STRUCTURES))]
    pub(crate) accel: Option<AccelChoice>,
}

pub(crate) const STRUCTURES: &[(&str, &str, AccelChoice)] = &[
    ("auto", "The structure that suits the scene best", AccelChoice::Auto),
    ("grid", "A grid of cells, with nested grids where spheres are dense", AccelChoice::Grid),
    ("tree", "A tree with eight children per node (BVH8)", AccelChoice::Tree),
    ("list", "No structure, every ray tests every sphere: slow, for comparison", AccelChoice::List),
    (
        "query",
        "Ray queries of the driver, in hardware or not, where it has them: an experiment of wgpu; see `verify`",
        AccelChoice::RayQuery,
    ),
    (
        "tiles",
        "Lists of spheres for the tiles of one picture by one ray per pixel, which `auto` makes on software devices",
        AccelChoice::Tiles,
    ),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backend {
    /// An adapter (GPU); the CPU reference if there is none, and for random rays if it is software, which takes longer
    Auto,
    /// An adapter (GPU); without one, the job fails
    Gpu,
    /// The CPU reference
    Cpu,
}

/// The ids of some arguments.
pub(crate) fn ids<A: Args>() -> impl Iterator<Item = Id> {
    let command = A::augment_args(Command::new(""));
    command.get_arguments().map(|argument| argument.get_id().clone()).collect::<Vec<_>>().into_iter()
}
