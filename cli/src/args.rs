//! Arguments as they are typed. What they mean is checked where it is used.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use super::camera::CameraArgs;
use super::data::format_parser;
use super::generate::kinds;
use super::light::LightArgs;
use super::stop_rule::StopArgs;
use pinhole::accel::AccelChoice;
use pinhole::image::tone::ToneCurve;
use pinhole::load::Format;

/// Ray traces spheres with compute shaders, without a display.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, disable_help_subcommand = true)]
#[command(
    after_help = "Exit codes: 0 done; 1 the job failed, or would not fit; 2 wrong usage; 3 a check failed; \
    130 stopped by a signal."
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Render a scene file or a data file
    Render(Box<RenderArgs>),
    /// Render on an adapter, and decide of every pixel whether a conforming device may have made it
    Verify(Box<VerifyArgs>),
    /// Say what a render would take of the device and the machine, and whether it fits
    #[cfg(feature = "gpu")]
    Plan(Box<PlanArgs>),
    /// Measure structures on an adapter
    #[cfg(feature = "gpu")]
    Bench(BenchArgs),
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
    /// The picture (.png, .exr), or - for PNG on standard output
    #[arg(short, long, value_name = "OUT.png")]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) encoding: EncodingArgs,
    #[command(flatten)]
    pub(super) light: LightArgs,
    #[command(flatten)]
    pub(super) stop_rule: StopArgs,
    #[command(flatten)]
    pub(super) device: DeviceArgs,
    #[command(flatten)]
    pub(super) accel: AccelArgs,
    /// Also write a layer (color, alpha, depth, normal, position, albedo, id, samples, variance): as a NumPy array,
    /// or without a file into an .exr picture; may be repeated
    #[arg(long = "layer", value_name = "LAYER[=FILE.npy]")]
    pub(super) layers: Vec<String>,
    /// How the pictures of a camera with two eyes are written [default: side-by-side]
    #[arg(long, value_enum)]
    pub(super) stereo: Option<Stereo>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Stereo {
    /// In one picture, twice as wide, the left eye's on the left
    SideBySide,
    /// In files of their own: OUT-left.png and OUT-right.png
    TwoFiles,
}

/// How the picture is written. [`super::encoding::EncodingFlags`] checks it.
#[derive(Debug, Args)]
pub(super) struct EncodingArgs {
    /// Bits of a sample of a PNG, 8 or 16 [default: the scene's, or 8]
    #[arg(long, value_name = "N")]
    pub(super) bits: Option<u32>,
    /// No background: RGBA, with alpha where spheres are [default: the scene's, or false]
    #[arg(
        long,
        value_name = "BOOL",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "true"
    )]
    pub(super) transparent: Option<bool>,
    /// Make a PNG brighter by so many stops [default: the scene's, or 0]
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    pub(super) exposure: Option<f32>,
    /// How light that a PNG cannot show is brought into range [default: the scene's, or none]
    #[arg(long, value_enum)]
    pub(super) tone: Option<Tone>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Tone {
    /// It is cut off
    None,
    /// A curve like film's, for each of red, green and blue
    Filmic,
    /// AgX: strong light turns white
    Agx,
}

impl From<Tone> for ToneCurve {
    fn from(tone: Tone) -> Self {
        match tone {
            Tone::None => Self::None,
            Tone::Filmic => Self::Filmic,
            Tone::Agx => Self::Agx,
        }
    }
}

/// What is shown, and from where. [`super::input::Source`] checks it.
#[derive(Debug, Args)]
pub(super) struct InputArgs {
    /// A scene file (.toml), or a data file (.xyz, .extxyz, .pdb, .npy, .npz; .bin with --format), which is framed by
    /// itself
    #[arg(value_name = "SCENE_OR_DATA")]
    pub(super) path: PathBuf,
    #[command(flatten)]
    pub(super) view: ViewArgs,
}

/// What flags say of an input.
#[derive(Debug, Args)]
pub(super) struct ViewArgs {
    /// What a data file is, whatever its extension says
    #[arg(long, value_parser = format_parser())]
    pub(super) format: Option<&'static Format>,
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
    #[command(flatten)]
    pub(super) adapter: AdapterArgs,
}

/// Which device, and what of it.
#[derive(Debug, Args)]
pub(super) struct AdapterArgs {
    /// The adapter whose name contains this text [default: `WGPU_ADAPTER_NAME`, or the best one]
    #[arg(long, value_name = "NAME")]
    pub(super) adapter: Option<String>,
    /// The limits that the device is opened with [default: adapter]
    #[arg(long, value_enum)]
    pub(super) limits: Option<Limits>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Limits {
    /// All that the adapter has
    Adapter,
    /// WebGPU's defaults, or less where the adapter has less
    Webgpu,
}

#[derive(Debug, Args)]
pub(super) struct AccelArgs {
    /// What finds the spheres of a ray on an adapter [default: auto]
    #[arg(long, value_enum)]
    pub(super) accel: Option<Structure>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Structure {
    /// What suits the spheres
    Auto,
    /// A grid of cells, nested where it is crowded
    Grid,
    /// A tree with eight children a node (BVH8)
    Tree,
    /// A tree with two children a node (BVH2): slower, a second opinion
    BinaryTree,
    /// Every sphere for every ray: slow, a second opinion
    List,
}

impl From<Structure> for AccelChoice {
    fn from(structure: Structure) -> Self {
        match structure {
            Structure::Auto => Self::Auto,
            Structure::Grid => Self::Grid,
            Structure::Tree => Self::Tree,
            Structure::BinaryTree => Self::BinaryTree,
            Structure::List => Self::List,
        }
    }
}

/// Arguments of `verify` that say what is rendered, and by what; a recording has all that in it.
const RENDERING: [&str; 27] = [
    "path",
    "format",
    "radius",
    "color",
    "frame",
    "size",
    "camera",
    "eye",
    "look_at",
    "direction",
    "up",
    "fov",
    "distance",
    "half_extent",
    "aperture_radius",
    "f_stop",
    "focal_length",
    "focus_distance",
    "focus_on",
    "angle",
    "separation",
    "convergence",
    "adapter",
    "limits",
    "accel",
    "paths",
    "save",
];

#[derive(Debug, Args)]
#[command(
    after_help = "What is checked, in f64 and with a bound for every rounding that WGSL leaves open: the numbers \
    that the device was given, every ray, hit, depth, normal and color. Where several answers are legal, the one \
    given must be among them. The CPU reference never stands in for an adapter.\n\n\
    Exit codes: 0 every pixel is as a conforming device may have made it; 1 the job failed, or there is no adapter, \
    or RUN is damaged; 2 wrong usage; 3 the picture is not legal.\n\n\
    JSON: `version`, `adapter` (name, backend, device_type, driver, driver_info, limits), `scene` (spheres, sha256), \
    `picture` (width, height, camera, y_axis, shading, structure), `counts` (decided, silhouette, tie, violation), \
    `decided_fraction`, `worst_depth` and `worst_normal` (of their bounds), `upload` (null, or what is wrong), \
    `violations` (the first hundred: pixel, stage, message), `paths` (where light is followed along paths: paths, \
    stages, upload, violation_count, violations, legal), `legal`, `command`. `version` and `command` are those \
    of the program that rendered. Keys may be added, not changed."
)]
pub(super) struct VerifyArgs {
    /// A scene file or a data file, as `render` takes them
    #[arg(value_name = "SCENE_OR_DATA", required_unless_present = "replay")]
    pub(super) path: Option<PathBuf>,
    #[command(flatten)]
    pub(super) view: ViewArgs,
    #[command(flatten)]
    pub(super) adapter: AdapterArgs,
    #[command(flatten)]
    pub(super) accel: AccelArgs,
    /// How many samples of each pixel are followed and checked, bounce by bounce, of a scene whose integrator is
    /// `path`; of a picture with a side of more than 256 pixels, those in its middle [default: 1]
    #[arg(long, value_name = "SAMPLES", value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub(super) paths: Option<u32>,
    /// Also write what was found as JSON
    #[arg(long, value_name = "FILE")]
    pub(super) json: Option<PathBuf>,
    /// Also write a page for people, report.html, into this folder; it is created if it is missing
    #[arg(long, value_name = "DIR")]
    pub(super) report: Option<PathBuf>,
    /// Also keep scene and recording in a file, for --replay
    #[arg(long, value_name = "RUN")]
    pub(super) save: Option<PathBuf>,
    /// Check a recording that was saved; needs no adapter
    #[arg(long, value_name = "RUN", conflicts_with_all = RENDERING)]
    pub(super) replay: Option<PathBuf>,
}

#[cfg(feature = "gpu")]
#[derive(Debug, Args)]
#[command(
    after_help = "Nothing is allocated on the device. Exit codes: 0 it fits; 1 it does not, \
    with the line that `render` would end with; 2 wrong usage.\n\n\
    JSON: `version`, `scene` (spheres, min, max, radius_min, radius_mean, radius_max), `structure` (name, reason, bricks), `picture` (width, height, \
    tile_width, tile_height, tiles, submissions_at_least), `buffers` (name, bytes, bytes_per_binding, \
    bindings), `device_bytes`, `device_bytes_per_sphere`, `host_bytes`, `host_peak`, \
    `host_bytes_available`, `adapter` (name, backend, device_type, driver, driver_info), `limits`, `fits`, \
    `problem`. Keys may be added, not changed."
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
    /// A layer that would be written beside the picture (alpha, depth, normal, position, albedo, id, samples,
    /// variance); may be repeated
    #[arg(long = "layer", value_name = "LAYER")]
    pub(super) layers: Vec<String>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[cfg(feature = "gpu")]
#[derive(Debug, Args)]
#[command(
    after_help = "Each scene is measured with what --accel auto chooses for many pictures and with the other \
    of grid and tree. Rays go through the centres of all pixels; `any` asks only whether there is a hit. \
    Times are medians; the peak of the process's memory only grows. Exit codes: as of `render`.\n\n\
    JSON: `version`, `adapter`, `reps`, `scenes` (name, spheres, width, height, load_seconds, runs, note); a \
    run has choice, structure, reason, build_seconds, upload_seconds, first_render_seconds, trace_wall, \
    trace_device, any_wall, any_device (each median_seconds, best_seconds), clock, rays, rays_per_second, \
    any_rays_per_second, submissions, longest_submission_seconds, device_bytes, device_bytes_per_sphere, \
    peak_memory_bytes. Keys may be added, not changed."
)]
pub(super) struct BenchArgs {
    /// R1M, R10M, L1M, C200k, or a scene or data file; R10M takes most of a GiB [default: R1M L1M C200k]
    #[arg(value_name = "SCENE")]
    pub(super) scenes: Vec<PathBuf>,
    /// Size in pixels [default: 1024x1024, or the file's]
    #[arg(long, value_name = "WxH")]
    pub(super) size: Option<String>,
    /// What the data files are, whatever their extensions say
    #[arg(long, value_parser = format_parser())]
    pub(super) format: Option<&'static Format>,
    /// The radius of all spheres of arrays of shape (n, 3)
    #[arg(long, value_name = "R")]
    pub(super) radius: Option<f64>,
    /// Only these structures, with commas between them
    #[arg(long, value_enum, value_delimiter = ',')]
    pub(super) accel: Vec<Structure>,
    /// How often each is measured
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) reps: u32,
    #[command(flatten)]
    pub(super) adapter: AdapterArgs,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Backend {
    Auto,
    Gpu,
    Cpu,
}

#[derive(Debug, Args)]
#[cfg_attr(
    feature = "gpu",
    command(
        after_help = "The self-test has the adapter compute, and judges whether it keeps what bounds of errors \
    count on. Exit codes: 0 done; 1 there is no adapter, or it fails to compute; 2 wrong usage; 3 it computes, \
    but a property fails.\n\n\
    JSON: `version`, `adapters` (name, backend, device_type, driver, driver_info, chosen, limits, features), \
    `problem`; with --self-test also `self_test` (adapter, passed, properties), whose properties have name, passed, \
    outcome (ok, note, FAILED), words, figures. Keys may be added, not changed."
    )
)]
pub(super) struct InfoArgs {
    /// Test whether an adapter computes as bounds of errors assume
    #[cfg(feature = "gpu")]
    #[arg(long)]
    pub(super) self_test: bool,
    /// The adapter to test, whose name contains this text [default: the one that `render` would use]
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "NAME")]
    pub(super) adapter: Option<String>,
    /// Write every shader as a device is given it, one WGSL file for each kernel, into this folder; it is created if it is
    /// missing. Needs no adapter
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "DIR", conflicts_with_all = ["self_test", "adapter", "json"])]
    pub(super) dump_shaders: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn a_recording_excludes_whatever_says_what_is_rendered() {
        let arguments = Arguments::command();
        let verify = arguments.find_subcommand("verify").unwrap();
        let others = ["json", "report", "replay", "help"];
        let ids = verify.get_arguments().map(|argument| argument.get_id().as_str());
        let rendering: Vec<_> = ids.filter(|id| !others.contains(id)).collect();
        assert!(rendering.iter().all(|id| RENDERING.contains(id)), "{rendering:?}");
        assert_eq!(rendering.len(), RENDERING.len());
    }
}
