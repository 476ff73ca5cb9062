//! Flags that several commands share, and those of small commands, as clap parses them. Values are checked where they are
//! used.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::camera::CameraArgs;
use super::data::format_parser;
use super::excluded_flags::{CAMERA, RENDERING, not_of_pictures};
#[cfg(feature = "gpu")]
use super::light::LightArgs;
use super::verify_help::AFTER_HELP;
use pinhole::accel::AccelChoice;
use pinhole::load::Format;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Stereo {
    /// In one picture of twice the width, with the left eye on the left
    SideBySide,
    /// In two files: OUT-left.png and OUT-right.png
    TwoFiles,
}

/// The scene and the view of it. [`super::input::Source`] checks them.
#[derive(Debug, Args)]
pub(super) struct InputArgs {
    #[arg(value_name = "SCENE_OR_DATA", help = input_help())]
    pub(super) path: PathBuf,
    #[command(flatten)]
    pub(super) view: ViewArgs,
}

/// The help of the input, which lists the extensions of all formats.
fn input_help() -> String {
    format!(
        "File to render: a scene file (.toml), or a data file ({}; .bin with --format), which the camera frames \
         automatically and which may be compressed (.gz); `-` for standard input, with --format",
        Format::extensions_of(|_| true)
    )
}

/// Flags for reading the input, and for the camera.
#[derive(Debug, Args)]
pub(super) struct ViewArgs {
    /// Format of the data file, whatever its extension is
    #[arg(long, value_parser = format_parser())]
    pub(super) format: Option<&'static Format>,
    /// File that says what the spheres of a trajectory are, for formats that have positions alone
    #[arg(long, value_name = "FILE")]
    pub(super) topology: Option<PathBuf>,
    /// Names of the columns of a table without a header, such as x,y,z,radius
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(super) columns: Vec<String>,
    /// Radius of all spheres, for data without radii
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(super) radius: Option<f64>,
    /// CSS color of all spheres, for data without colors [default: the scene's, or #cccccc]
    #[arg(long, value_name = "CSS")]
    pub(super) color: Option<String>,
    /// Frame of a trajectory, counted from 0 [default: the scene's, or 0]
    #[arg(long, value_name = "N")]
    pub(super) frame: Option<usize>,
    /// Width and height of the picture in pixels, such as 800x600 [default: the scene's, or 800x600]
    #[arg(long, value_name = "WxH")]
    pub(super) size: Option<String>,
    #[command(flatten)]
    pub(super) camera: CameraArgs,
}

#[derive(Debug, Args)]
pub(super) struct DemoArgs {
    /// Width and height of the picture in pixels, such as 800x600 [default: the scene's]
    #[arg(long, value_name = "WxH")]
    pub(super) size: Option<String>,
    #[command(flatten)]
    pub(super) device: DeviceArgs,
}

#[derive(Debug, Args)]
pub(super) struct DeviceArgs {
    /// What renders the picture
    #[arg(long, value_enum, default_value_t = Backend::Auto)]
    pub(super) backend: Backend,
    #[command(flatten)]
    pub(super) adapter: AdapterArgs,
}

/// Flags that choose the adapter and its limits.
#[derive(Debug, Args)]
pub(super) struct AdapterArgs {
    /// Use the adapter whose name contains this text [default: `WGPU_ADAPTER_NAME`, or the best adapter]
    #[arg(long, value_name = "NAME")]
    pub(super) adapter: Option<String>,
    /// Limits of the device that the program may use [default: adapter]
    #[arg(long, value_enum)]
    pub(super) limits: Option<Limits>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Limits {
    /// All limits that the adapter offers
    Adapter,
    /// The default limits of WebGPU, or less where the adapter offers less
    Webgpu,
}

#[derive(Debug, Args)]
pub(super) struct AccelArgs {
    /// Acceleration structure with which an adapter finds the spheres that a ray hits [default: auto]
    #[arg(long, value_enum)]
    pub(super) accel: Option<Structure>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Structure {
    /// The structure that suits the scene best
    Auto,
    /// A grid of cells, with nested grids where spheres are dense
    Grid,
    /// A tree with eight children per node (BVH8)
    Tree,
    /// No structure, every ray tests every sphere: slow, for comparison
    List,
    /// Ray queries of the driver, in hardware or not, where it has them: an experiment of wgpu; see `verify`
    Query,
}

impl From<Structure> for AccelChoice {
    fn from(structure: Structure) -> Self {
        match structure {
            Structure::Auto => Self::Auto,
            Structure::Grid => Self::Grid,
            Structure::Tree => Self::Tree,
            Structure::List => Self::List,
            Structure::Query => Self::RayQuery,
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub(super) struct VerifyArgs {
    /// File to check: a scene file or a data file, as for `render`; or with --scene a picture
    #[arg(value_name = "SCENE_OR_DATA", required_unless_present = "replay")]
    pub(super) path: Option<PathBuf>,
    /// The scene file or data file of a picture that `render --certify` wrote: check the picture's samples and its
    /// certificate, which says the other arguments of `render`. This needs no adapter
    #[arg(long, value_name = "SCENE_OR_DATA", conflicts_with_all = not_of_pictures())]
    pub(super) scene: Option<PathBuf>,
    #[command(flatten)]
    pub(super) view: ViewArgs,
    #[command(flatten)]
    pub(super) adapter: AdapterArgs,
    #[command(flatten)]
    pub(super) accel: AccelArgs,
    /// Samples of each pixel that are checked stage by stage, in scenes with light: paths bounce by bounce, studios
    /// surface by surface and light by light. The last sample is one of them. In a picture with a side of more than 256
    /// pixels, only the middle and a part at random are checked, and of a studio with many lights smaller parts
    /// [default: 1]
    #[arg(long, value_name = "SAMPLES", value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub(super) paths: Option<u32>,
    /// Where the part at random is in which light is checked as well: the same seed, the same part [default: another one
    /// in each run]
    #[arg(long, value_name = "SEED")]
    pub(super) tile_seed: Option<u32>,
    /// Also write the results to this file as JSON
    #[arg(long, value_name = "FILE")]
    pub(super) json: Option<PathBuf>,
    /// Also write the results as a web page, report.html, into this folder, which is created if it is missing
    #[arg(long, value_name = "DIR")]
    pub(super) report: Option<PathBuf>,
    /// Also save the scene and the recording to this file, for --replay
    #[arg(long, value_name = "RUN")]
    pub(super) save: Option<PathBuf>,
    /// Check a saved recording again; this needs no adapter
    #[arg(long, value_name = "RUN", conflicts_with_all = RENDERING.into_iter().chain(CAMERA).chain(["scene"]))]
    pub(super) replay: Option<PathBuf>,
}

#[cfg(feature = "gpu")]
#[derive(Debug, Args)]
#[command(
    after_help = "Nothing is allocated on the device. Exit codes: 0 the render fits; 1 it does not, \
    and the error is that of `render`; 2 wrong usage.\n\n\
    JSON: `version`, `scene` (spheres, min, max, radius_min, radius_mean, radius_max), `structure` (name, \
    reason, bricks), `picture` (width, height, tile_width, tile_height, tiles, submissions_at_least), \
    `buffers` (name, bytes, bytes_per_binding, bindings), `device_bytes`, `device_bytes_per_sphere`, `host_bytes`, \
    `host_peak`, `host_bytes_available`, `adapter` (name, backend, device_type, driver, driver_info), `limits`, `fits`, \
    `problem`. New versions may add keys, but do not change these."
)]
pub(super) struct PlanArgs {
    #[command(flatten)]
    pub(super) input: InputArgs,
    #[command(flatten)]
    pub(super) light: LightArgs,
    #[command(flatten)]
    pub(super) adapter: AdapterArgs,
    #[command(flatten)]
    pub(super) accel: AccelArgs,
    /// Data layer that would be written in addition (alpha, depth, normal, position, albedo, id, samples, variance);
    /// may be repeated
    #[arg(long = "layer", value_name = "LAYER")]
    pub(super) layers: Vec<String>,
    /// Print the results as JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[cfg(feature = "gpu")]
#[derive(Debug, Args)]
#[command(
    after_help = "Each scene is measured with the structure that --accel auto chooses, and with the \
    other of grid and tree. Rays go through the centers of all pixels. \
    Times are medians. The peak of the memory is that of the whole process so far. Exit codes are those of \
    `render`.\n\n\
    JSON: `version`, `adapter`, `reps`, `scenes` (name, spheres, width, height, load_seconds, runs, note); a \
    run has choice, structure, reason, build_seconds, upload_seconds, first_render_seconds, trace_wall, \
    trace_device (each median_seconds, best_seconds), clock, rays, rays_per_second, \
    submissions, longest_submission_seconds, device_bytes, device_bytes_per_sphere, \
    peak_memory_bytes. New versions may add keys, but do not change these."
)]
pub(super) struct BenchArgs {
    /// Scenes to measure: R1M, R10M, L1M, C200k, or scene or data files; R10M needs almost 1 GiB of memory
    /// [default: R1M L1M C200k]
    #[arg(value_name = "SCENE")]
    pub(super) scenes: Vec<PathBuf>,
    /// Width and height of the pictures in pixels [default: 1024x1024, or the file's]
    #[arg(long, value_name = "WxH")]
    pub(super) size: Option<String>,
    /// Format of the data files, whatever their extensions are
    #[arg(long, value_parser = format_parser())]
    pub(super) format: Option<&'static Format>,
    /// Radius of all spheres, for data without radii
    #[arg(long, value_name = "R")]
    pub(super) radius: Option<f64>,
    /// Measure only these acceleration structures, separated by commas
    #[arg(long, value_enum, value_delimiter = ',')]
    pub(super) accel: Vec<Structure>,
    /// Number of measurements of each structure
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) reps: u32,
    #[command(flatten)]
    pub(super) adapter: AdapterArgs,
    /// Print the results as JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Backend {
    /// An adapter (GPU) if there is one, otherwise the CPU reference
    Auto,
    /// An adapter (GPU); without one, the job fails
    Gpu,
    /// The CPU reference, which is slower
    Cpu,
}
