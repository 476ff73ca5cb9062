//! The arguments of `pinhole bench`.

use std::path::PathBuf;

use clap::Args;

use crate::flags::common::{AdapterArgs, STRUCTURES};
use crate::input::data::format_parser;
use crate::terminal::text::one_of;
use pinhole::accel::AccelChoice;
use pinhole_data::load::Format;

#[derive(Debug, Args)]
#[command(after_help = "Each scene is measured with the structure that --accel auto chooses, and with the \
    other of grid and tree. Rays go through the centers of all pixels. \
    Times are medians. Tiles are those of a single picture: their lists are made for each, and count as building. \
    The peak of the memory is that of the whole process so far. Exit codes are those of `render`.\n\n\
    JSON: `version`, `adapter`, `reps`, `scenes` (name, spheres, cones, width, height, load_seconds, runs, note); a \
    run has choice, structure, reason, build_seconds, upload_seconds, first_render_seconds, trace_wall, \
    trace_device (each median_seconds, best_seconds), clock, rays, rays_per_second, \
    submissions, longest_submission_seconds (null for tiles), device_bytes, device_bytes_per_sphere, \
    peak_memory_bytes. New versions may add keys, but do not change these.")]
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
    /// Radius of all spheres, for atoms and data without radii
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
