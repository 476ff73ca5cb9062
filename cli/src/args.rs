//! The command line as clap parses it. Values are checked where they are used.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use super::bricks::SortArgs;
use super::camera::CameraArgs;
use super::certify::CertifyArgs;
use super::data::format_parser;
use super::encoding::EncodingArgs;
use super::excluded_flags::{CAMERA, RENDERING, not_of_pictures};
use super::file_info::FileArgs;
use super::frames::FramesArgs;
use super::generate::GenerateArgs;
use super::job::JobArgs;
use super::light::LightArgs;
use super::report::ReportArgs;
use super::stop_rule::StopArgs;
use super::verify_help::AFTER_HELP;
use super::view::ViewArguments;
use pinhole::accel::AccelChoice;
use pinhole::load::Format;

/// Ray traces spheres with compute shaders, without a display, and checks its pictures.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, disable_help_subcommand = true)]
#[command(
    after_help = "Exit codes: 0 done; 1 the job failed or does not fit; 2 wrong usage; 3 a check failed; \
    4 a check could not decide; 5 the device was lost or did not answer; 130 stopped by a signal."
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Render a picture of a scene file or a data file
    Render(Box<RenderArgs>),
    /// Show a file in a window, from all sides, and give the command that renders what is seen
    View(Box<ViewArguments>),
    /// Render on an adapter, and check for every pixel whether a conforming device may have made it
    Verify(Box<VerifyArgs>),
    /// Check the ids, depths and normals that any renderer made of a scene
    Certify(Box<CertifyArgs>),
    /// Show how much memory a render would need on the device and the machine, and whether it fits
    #[cfg(feature = "gpu")]
    Plan(Box<PlanArgs>),
    /// Measure how fast an adapter traces rays with different acceleration structures
    #[cfg(feature = "gpu")]
    Bench(BenchArgs),
    /// Render on many machines: divide pictures into parts, render each, see what is done, and join them
    Job(JobArgs),
    /// Sort the spheres of a data file into compact bricks, for data that does not fit into memory
    Sort(SortArgs),
    /// Write an example scene file into the current folder and render it
    Demo(DemoArgs),
    /// Write a file of generated spheres, for tests and measurements
    Generate(GenerateArgs),
    /// Say what a data file or a scene file holds; or list the adapters of this machine with drivers, limits and features
    Info(InfoArgs),
}

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
    pub(super) structure: super::structure_flags::StructureArgs,
    #[command(flatten)]
    pub(super) color: super::color_flags::ColorArgs,
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
    pub(super) profile: super::profile::ProfileArgs,
    #[command(flatten)]
    pub(super) report: ReportArgs,
}

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

#[derive(Debug, Args)]
#[command(after_help = super::info::HELP)]
pub(super) struct InfoArgs {
    #[command(flatten)]
    pub(super) file: FileArgs,
    /// Test whether an adapter computes as precisely as the error bounds of `verify` assume
    #[cfg(feature = "gpu")]
    #[arg(long)]
    pub(super) self_test: bool,
    /// Test the adapter whose name contains this text [default: the adapter that `render` would use]
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "NAME")]
    pub(super) adapter: Option<String>,
    /// Write every shader as a device is given it, one WGSL file for each kernel, into this folder; it is created if it is
    /// missing. Needs no adapter
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "DIR", conflicts_with_all = ["self_test", "adapter", "json"])]
    pub(super) dump_shaders: Option<PathBuf>,
    /// Print the results as JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn replay_excludes_all_arguments_that_describe_the_picture() {
        let arguments = Arguments::command();
        let verify = arguments.find_subcommand("verify").unwrap();
        let others = ["json", "report", "replay", "scene", "help"];
        let ids = verify.get_arguments().map(|argument| argument.get_id().as_str());
        let rendering: Vec<_> = ids.filter(|id| !others.contains(id)).collect();
        let excluded: Vec<_> = RENDERING.into_iter().chain(CAMERA).collect();
        assert!(rendering.iter().all(|id| excluded.contains(id)), "{rendering:?}");
        assert_eq!(rendering.len(), excluded.len());
    }
}
