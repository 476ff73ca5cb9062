//! The arguments of `pinhole verify`.

use std::path::PathBuf;

use clap::{Args, Id};

use crate::flags::common::{AccelArgs, AdapterArgs, ids};
use crate::flags::settings::{SettingArgs, VIEW, names};

#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct VerifyArgs {
    /// File to check: a scene file or a data file, as for `render`; or with --scene a picture
    #[arg(value_name = "SCENE_OR_DATA", required_unless_present = "replay")]
    pub(crate) path: Option<PathBuf>,
    /// The scene file or data file of a picture that `render --certify` wrote: check the picture's samples and its
    /// certificate, which says the settings. This needs no adapter
    #[arg(long, value_name = "SCENE_OR_DATA", conflicts_with_all = not_of_pictures())]
    pub(crate) scene: Option<PathBuf>,
    /// With --scene, the most rays that the reference may follow
    #[arg(long, value_name = "RAYS", default_value_t = 1e10)]
    pub(crate) work: f64,
    #[command(flatten)]
    pub(crate) view: SettingArgs<VIEW>,
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
    /// Also save the scene and the recording, without its light, to this file, for --replay
    #[arg(long, value_name = "RUN")]
    pub(crate) save: Option<PathBuf>,
    /// Check a saved recording again; this needs no adapter
    #[arg(long, value_name = "RUN", conflicts_with_all = not_of_recordings())]
    pub(crate) replay: Option<PathBuf>,
}

/// Arguments of `verify` that do not apply to written pictures.
fn not_of_pictures() -> impl Iterator<Item = Id> {
    not_of_recordings().filter(|id| !["path", "scene", "work"].contains(&id.as_str())).chain(["report".into()])
}

/// Arguments of `verify` that a recording contains, or that do not apply to it.
fn not_of_recordings() -> impl Iterator<Item = Id> {
    let own = ["path", "paths", "save", "tile_seed", "scene", "work"].map(Id::from);
    names(VIEW).map(Id::from).chain(ids::<AdapterArgs>()).chain(ids::<AccelArgs>()).chain(own)
}

pub(crate) const AFTER_HELP: &str = "The check covers the data on the device and every ray, hit, depth, normal and \
    color. It computes in f64, with a bound for every rounding that WGSL leaves open. Where several answers are legal, the device must have \
    given one of them. The CPU reference never replaces an adapter here.\n\n\
    Exit codes: 0 no violation was found, and less is undecided than for 4; 1 the job failed, or there is no adapter, \
    or RUN is damaged; 2 wrong usage; 3 the picture is not legal; 4 no violation was found, but more than 1 % of the \
    pixels have several legal answers, or of the stages of light paths or the denoised pixels have bounds so wide that \
    they say little, or more than 1 % of the pixels that `render` gives differ from what exact arithmetic gives and are not \
    known to be legal.\n\n\
    JSON: `version`, `adapter` (name, backend, device_type, driver, driver_info, limits), `hearsay` (the keys that \
    RUN says of itself, which nothing proves: whoever writes it can write any names), `scene` (spheres, cones, sha256), `picture` (width, height, camera, y_axis, shading, structure), `counts` (decided, silhouette, tie, violation), \
    `decided_fraction`, `worst_depth` and `worst_normal` (as fractions of their bounds), `upload` (null, or what is \
    wrong), `violations` (the first hundred: pixel, stage, message), `open` (the first three ties and the first three silhouettes: \
    pixel, verdict, message), `paths` (only with the integrator `path`: paths, \
    stages, rectangles (column, row, width and height of what was checked), judged (samples, of_samples, pixels, of_pixels: so many of \
    so many in the picture, and fraction, of all its samples), open (the first stages that are open or \
    undecided: pixel, sample, surface, stage, is_undecided, legal: of an open search, up to four legal answers), upload, \
    violation_count, violations, outcome, legal), `studio` (only with the integrator `studio`: samples, \
     stages and so on), `denoiser` (only if the picture is denoised: pixels, undecided, violation_count, violations, \
     outcome), `rendered` (only with light: the picture as `render` makes it, samples, of_samples, pixels (exact, legal, \
    wide, open, violated), violation, outcome), `biased` (quantities whose results lie to one side of the middle of their bounds, in words), `outcome` \
    (proved, undecided, violated), `legal`, `command`. `version` and `command` are those of the program \
    that rendered. New versions may add keys, but do not change these.";
