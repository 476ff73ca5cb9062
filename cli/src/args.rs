//! Flags that several commands share, and those of small commands, as clap parses them. Values are checked where they are
//! used.

use std::path::PathBuf;

use clap::{Args, Command, Id, ValueEnum};

use crate::camera::CameraArgs;
use crate::data::format_parser;
#[cfg(feature = "gpu")]
use crate::light::LightArgs;
use crate::text::one_of;
use pinhole::accel::AccelChoice;
use pinhole::load::Format;

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
    pub(crate) view: ViewArgs,
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
#[derive(Debug, Default, Args)]
pub(crate) struct ViewArgs {
    /// Format of the data file, whatever its extension is
    #[arg(long, value_parser = format_parser())]
    pub(crate) format: Option<&'static Format>,
    /// File that says what the spheres of a trajectory are, for formats that have positions alone
    #[arg(long, value_name = "FILE")]
    pub(crate) topology: Option<PathBuf>,
    /// Names of the columns of a table without a header, such as x,y,z,radius
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) columns: Vec<String>,
    /// Radius of all spheres, for data without radii
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(crate) radius: Option<f64>,
    /// CSS color of all spheres, for data without colors [default: the scene's, or #cccccc]
    #[arg(long, value_name = "CSS")]
    pub(crate) color: Option<String>,
    /// Frame of a trajectory, counted from 0 [default: the scene's, or 0]
    #[arg(long, value_name = "N")]
    pub(crate) frame: Option<usize>,
    /// Width and height of the picture in pixels, such as 800x600 [default: the scene's, or 800x600]
    #[arg(long, value_name = "WxH")]
    pub(crate) size: Option<String>,
    #[command(flatten)]
    pub(crate) camera: CameraArgs,
}

#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Width and height of the picture in pixels, such as 800x600 [default: the scene's]
    #[arg(long, value_name = "WxH")]
    pub(crate) size: Option<String>,
    #[command(flatten)]
    pub(crate) device: DeviceArgs,
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

const STRUCTURES: &[(&str, &str, AccelChoice)] = &[
    ("auto", "The structure that suits the scene best", AccelChoice::Auto),
    ("grid", "A grid of cells, with nested grids where spheres are dense", AccelChoice::Grid),
    ("tree", "A tree with eight children per node (BVH8)", AccelChoice::Tree),
    ("list", "No structure, every ray tests every sphere: slow, for comparison", AccelChoice::List),
    (
        "query",
        "Ray queries of the driver, in hardware or not, where it has them: an experiment of wgpu; see `verify`",
        AccelChoice::RayQuery,
    ),
];

#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct VerifyArgs {
    /// File to check: a scene file or a data file, as for `render`; or with --scene a picture
    #[arg(value_name = "SCENE_OR_DATA", required_unless_present = "replay")]
    pub(crate) path: Option<PathBuf>,
    /// The scene file or data file of a picture that `render --certify` wrote: check the picture's samples and its
    /// certificate, which says the other arguments of `render`. This needs no adapter
    #[arg(long, value_name = "SCENE_OR_DATA", conflicts_with_all = not_of_pictures())]
    pub(crate) scene: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) view: ViewArgs,
    #[command(flatten)]
    pub(crate) adapter: AdapterArgs,
    #[command(flatten)]
    pub(crate) accel: AccelArgs,
    /// Samples of each pixel that are checked stage by stage, in scenes with light: paths bounce by bounce, studios
    /// surface by surface and light by light. The last sample is one of them. In a picture with a side of more than 256
    /// pixels, only the middle and a part at random are checked, and of a studio with many lights smaller parts
    /// [default: 1]
    #[arg(long, value_name = "SAMPLES", value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub(crate) paths: Option<u32>,
    /// Where the part at random is in which light is checked as well: the same seed, the same part [default: another one
    /// in each run]
    #[arg(long, value_name = "SEED")]
    pub(crate) tile_seed: Option<u32>,
    /// Also write the results to this file as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Also write the results as a web page, report.html, into this folder, which is created if it is missing
    #[arg(long, value_name = "DIR")]
    pub(crate) report: Option<PathBuf>,
    /// Also save the scene and the recording to this file, for --replay
    #[arg(long, value_name = "RUN")]
    pub(crate) save: Option<PathBuf>,
    /// Check a saved recording again; this needs no adapter
    #[arg(long, value_name = "RUN", conflicts_with_all = not_of_recordings())]
    pub(crate) replay: Option<PathBuf>,
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
pub(crate) struct PlanArgs {
    #[command(flatten)]
    pub(crate) input: InputArgs,
    #[command(flatten)]
    pub(crate) light: LightArgs,
    #[command(flatten)]
    pub(crate) adapter: AdapterArgs,
    #[command(flatten)]
    pub(crate) accel: AccelArgs,
    /// Data layer that would be written in addition (alpha, depth, normal, position, albedo, id, samples, variance);
    /// may be repeated
    #[arg(long = "layer", value_name = "LAYER")]
    pub(crate) layers: Vec<String>,
    /// Print the results as JSON
    #[arg(long)]
    pub(crate) json: bool,
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
pub(crate) struct BenchArgs {
    /// Scenes to measure: R1M, R10M, L1M, C200k, or scene or data files; R10M needs almost 1 GiB of memory
    /// [default: R1M L1M C200k]
    #[arg(value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Width and height of the pictures in pixels [default: 1024x1024, or the file's]
    #[arg(long, value_name = "WxH")]
    pub(crate) size: Option<String>,
    /// Format of the data files, whatever their extensions are
    #[arg(long, value_parser = format_parser())]
    pub(crate) format: Option<&'static Format>,
    /// Radius of all spheres, for data without radii
    #[arg(long, value_name = "R")]
    pub(crate) radius: Option<f64>,
    /// Measure only these acceleration structures, separated by commas
    #[arg(long, value_parser = one_of(STRUCTURES), value_delimiter = ',')]
    pub(crate) accel: Vec<AccelChoice>,
    /// Number of measurements of each structure
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) reps: u32,
    #[command(flatten)]
    pub(crate) adapter: AdapterArgs,
    /// Print the results as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backend {
    /// An adapter (GPU) if there is one, otherwise the CPU reference
    Auto,
    /// An adapter (GPU); without one, the job fails
    Gpu,
    /// The CPU reference, which is slower
    Cpu,
}

/// The ids of some arguments.
fn ids<A: Args>() -> impl Iterator<Item = Id> {
    let command = A::augment_args(Command::new(""));
    command
        .get_arguments()
        .map(|argument| argument.get_id().clone())
        .collect::<Vec<_>>()
        .into_iter()
}

/// Arguments of `verify` that say nothing about a picture that was written.
fn not_of_pictures() -> impl Iterator<Item = Id> {
    not_of_recordings().filter(|id| *id != "path" && *id != "scene").chain(["report".into()])
}

/// Arguments that describe the camera and the size of the picture.
pub(crate) fn camera_ids() -> impl Iterator<Item = Id> {
    ids::<CameraArgs>().chain(["size".into()])
}

/// Arguments of `verify` that a recording contains, or that do not concern it.
fn not_of_recordings() -> impl Iterator<Item = Id> {
    let own = ["path", "paths", "save", "tile_seed", "scene"].map(Id::from);
    ids::<ViewArgs>().chain(ids::<AdapterArgs>()).chain(ids::<AccelArgs>()).chain(own)
}

pub(crate) const AFTER_HELP: &str = "The check covers the data on the device and every ray, hit, depth, normal and \
    color. It computes in f64, with a bound for every rounding that WGSL leaves open. Where several answers are legal, the device must have \
    given one of them. The CPU reference never replaces an adapter here.\n\n\
    Exit codes: 0 every pixel is as a conforming device may have made it; 1 the job failed, or there is no adapter, \
    or RUN is damaged; 2 wrong usage; 3 the picture is not legal; 4 no violation was found, but more than 1 % of the \
    pixels have several legal answers, or of the stages of light paths or the denoised pixels have bounds so wide that \
    they say little.\n\n\
    JSON: `version`, `adapter` (name, backend, device_type, driver, driver_info, limits), `scene` (spheres, sha256), \
    `picture` (width, height, camera, y_axis, shading, structure), `counts` (decided, silhouette, tie, violation), \
    `decided_fraction`, `worst_depth` and `worst_normal` (as fractions of their bounds), `upload` (null, or what is \
    wrong), `violations` (the first hundred: pixel, stage, message), `open` (the first three ties and the first three silhouettes: \
    pixel, verdict, message), `paths` (only with the integrator `path`: paths, \
    stages, rectangles (column, row, width and height of what was checked), judged (samples, of_samples, pixels, of_pixels: so many of \
    so many in the picture, and fraction, of all its samples), open (the first stages that are open or \
    undecided: pixel, sample, surface, stage, is_undecided, legal: of an open search, up to four legal answers), upload, \
    violation_count, violations, outcome, legal), `studio` (only with the integrator `studio`: samples, \
     stages and so on), `denoiser` (only if the picture is denoised: pixels, undecided, violation_count, violations, \
     outcome), `biased` (quantities whose results lie to one side of the middle of their bounds, in words), `outcome` \
    (proved, undecided, violated), `legal`, `command`. `version` and `command` are those of the program \
    that rendered. New versions may add keys, but do not change these.";
