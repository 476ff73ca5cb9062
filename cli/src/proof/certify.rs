//! `pinhole certify`: judges the answers of any renderer with exact rays.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::flags::settings::{SettingArgs, VIEW};
use crate::input::{Input, Source, read};
use crate::output::files::{check_not_inputs, check_writable, name_all, unnamed};
use crate::proof::scene_report::SceneReport;
use crate::proof::verify::report::command_line;
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, answer, tell};
use crate::terminal::text::json;
use crate::terminal::threads;
use pinhole::geometry::ray::Ray;
use pinhole::image::NO_ID;
use pinhole::verify::conformance::{Answers, Conformance, ConformanceError, DepthKind, Field, Finding, Rays};
use pinhole::verify::{Checker, MOST_UNDECIDED, Outcome};
use pinhole_data::load::LoadError;
use pinhole_data::load::npy::pixels::{self, Pixels};
use pinhole_figure::settings::flags::Group;

#[derive(Debug, Args)]
#[command(
    after_help = "For each pixel the check computes the least k for which the answer is legal: the exact answer for a \
    sphere that is moved, relative to the ray, by at most k times 2^-24 of its distance (of its radius, from inside; and \
    with rays of the scene's camera, of its distance plus an eighth of that of the camera from the origin of the data's \
    frame). Cones and cylinders are moved alike, by the distance of the farther end. For normals, an eighth of the distance of the ray's start from the origin of the world is added. An honest f32 \
    renderer needs at most 24 for given rays; 16 more for rays that it makes itself, and 8 more for normals. A pixel is proved if its answer is the only \
    legal one for the limit, undecided if there are others, and violated if it needs more than the limit.\n\n\
    Arrays have row 0 at the top, in either byte order. IDs are uint32, int32, uint64 or int64 of shape (height, width): \
    indices of spheres in the order of the data, and then of cones and cylinders; a miss is -1 or the largest number of the type. Depths are float32 or \
    float64; those of misses are not looked at. Normals have the shape (height, width, 3), in world space, and point away \
    from centers and axes. RAYS.npz has the arrays `directions`, of shape (height, width, 3) and unit length, and `origins`, of the \
    same shape or (3,).\n\n\
    Exit codes: 0 no pixel needs more than the limit, and at most 1 % of the pixels are undecided; 1 the job failed; \
    2 wrong usage; 3 a pixel needs more than the limit; 4 none does, but more is undecided.\n\n\
    JSON: `version`, `scene` (spheres, cones, sha256), `picture` (width, height, camera; null for given rays; rays_off: camera, degrees, distance), `checked`, \
    `at_most`, `counts` (proved, undecided, violated), `decided_fraction`, `largest`, `histogram` (up_to, count), `worst` \
    (up to a hundred pixels: pixel, id, depth, outcome, k, margin, reason, exact_id, exact_distance, message), `outcome`, \
    `command`; what is infinite or a miss is null. New versions may add keys, but do not change these."
)]
pub(crate) struct CertifyArgs {
    /// File that was rendered: a scene file or a data file, as for `render`
    #[arg(value_name = "SCENE_OR_DATA")]
    path: PathBuf,
    #[command(flatten)]
    view: SettingArgs<VIEW>,
    /// The sphere, cone or cylinder of each pixel
    #[arg(long, value_name = "ID.npy")]
    id: PathBuf,
    /// The depth of each pixel
    #[arg(long, value_name = "DEPTH.npy")]
    depth: Option<PathBuf>,
    /// What depths are [default: t]
    #[arg(long, value_enum, requires = "depth")]
    depth_is: Option<DepthIs>,
    /// The unit normal of each pixel
    #[arg(long, value_name = "NORMAL.npy")]
    normal: Option<PathBuf>,
    /// The rays that the renderer was given, in world space. They are taken as they are: whoever gives them can prove
    /// anything [default: those of the camera]
    #[arg(long, value_name = "RAYS.npz")]
    rays: Option<PathBuf>,
    /// The largest k that a pixel may need [default: 40, or 24 with --rays; 8 more with --normal]
    #[arg(long, value_name = "K")]
    at_most: Option<f64>,
    /// Also write the results to this file as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum DepthIs {
    /// Distance along the ray
    T,
    /// Distance from the camera's plane
    Z,
}

impl CertifyArgs {
    fn inputs(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.id].into_iter().chain(&self.depth).chain(&self.normal).chain(&self.rays)
    }
}

pub(crate) fn run(args: &CertifyArgs) -> Result<(), Failure> {
    check(args)?;
    threads::start()?;
    let ids = array(&args.id, pixels::ids)?;
    let source = Source::new(&args.path, &args.view.given)?.without_bricks("`certify`")?;
    let has_camera = !source.is_data() || args.view.given.first_in(Group::Camera as u32).is_some();
    let input = source.with_size_of_data(ids.size)?.load()?;
    let files: Vec<PathBuf> = input.files.iter().chain(args.inputs()).cloned().collect();
    check_not_inputs(args.json.iter(), &files)?;
    let note = progress::notes(false);
    input.notes.iter().for_each(|text| note(text));
    let depths = args.depth.as_ref().map(|path| array(path, pixels::numbers)).transpose()?;
    let normals = args.normal.as_ref().map(|path| array(path, pixels::vectors)).transpose()?;
    let rays = args.rays.as_ref().map(|path| array(path, pixels::rays)).transpose()?;
    let depths_size = args.depth.iter().zip(depths.as_ref().map(|depths| depths.size));
    let normals_size = args.normal.iter().zip(normals.as_ref().map(|normals| normals.size));
    let rays_size = args.rays.iter().zip(rays.as_ref().map(|rays| rays.size));
    let mut sizes = depths_size.chain(normals_size).chain(rays_size);
    if let Some((path, size)) = sizes.find(|(_, size)| *size != ids.size) {
        return Err(Failure::Job(anyhow!(
            "{}: the array is of {}x{} pixels, but {} is of {}x{}; give arrays of one picture",
            path.display(),
            size[0],
            size[1],
            args.id.display(),
            ids.size[0],
            ids.size[1]
        )));
    }
    let answers = Answers {
        size: ids.size,
        ids: &ids.values,
        depths: depths.as_ref().map(|depths| &*depths.values),
        depth_kind: match args.depth_is {
            Some(DepthIs::Z) => DepthKind::AlongAxis,
            Some(DepthIs::T) | None => DepthKind::Distance,
        },
        normals: normals.as_ref().map(|normals| &*normals.values),
    };
    let found = certified(args, &input, &answers, rays.as_ref())?;
    let mut report = Report::new(&input, &answers, rays.is_some(), &found);
    if let Some(rays) = rays.filter(|_| has_camera) {
        match [input.film.width(), input.film.height()] == ids.size {
            true => report.picture.rays_off = Some(RaysOff::new(&input, &rays.values)),
            false => note(&"the camera's picture has another size than the rays; to compare them, add --size"),
        }
    }
    progress::clear();
    answer(report.table().as_bytes())?;
    if let Some(path) = &args.json {
        name_all(vec![(path, unnamed(path, json(&report)?.as_bytes())?)])?;
    }
    verdict(&found)
}

/// Refuses arguments that are wrong regardless of the files.
fn check(args: &CertifyArgs) -> Result<(), Failure> {
    if let Some(limit) = args.at_most
        && !(limit > 0.0 && limit.is_finite())
    {
        let message = format!("--at-most {limit}: the limit must be finite and greater than 0");
        return Err(Failure::usage(message));
    }
    if args.depth_is == Some(DepthIs::Z) && args.rays.is_some() {
        return Err(Failure::usage(
            "--depth-is z: rays have no camera whose plane depths could be measured from; give distances along the rays",
        ));
    }
    args.json.as_deref().map_or(Ok(()), check_writable)
}

fn array<T>(path: &Path, decode: impl FnOnce(&[u8]) -> Result<Pixels<T>, LoadError>) -> Result<Pixels<T>, Failure> {
    progress::stage(format!("reading {}", path.display()));
    let bytes = read(path)?;
    Ok(decode(&bytes).with_context(|| path.display().to_string())?)
}

fn certified(
    args: &CertifyArgs,
    input: &Input,
    answers: &Answers<'_>,
    rays: Option<&Pixels<Ray>>,
) -> Result<Conformance, Failure> {
    let view = input.view();
    let film = [view.film.width(), view.film.height()];
    if rays.is_none() && film != answers.size {
        let [width, height] = answers.size;
        return Err(Failure::Job(anyhow!(
            "{}: the array is of {width}x{height} pixels, but the picture is of {}x{}; to change that, add --size \
             {width}x{height}",
            args.id.display(),
            film[0],
            film[1]
        )));
    }
    if rays.is_none() && input.eyes.is_some() {
        tell("note: the camera has two eyes; the picture is taken for that of the middle between them");
    }
    progress::stage("checking");
    let checker = Checker::new(&input.scene).context("the checker cannot be prepared")?;
    let rays = rays.map_or(Rays::View(view), |rays| Rays::Given(&rays.values));
    let found = checker.certify_answers(answers, rays, args.at_most);
    found.map_err(|error| explained(args, &error))
}

/// Adds the file or the flag to an error.
fn explained(args: &CertifyArgs, error: &ConformanceError) -> Failure {
    let file = match error.field {
        Some(Field::Ids) => Some(&args.id),
        Some(Field::Depths) => args.depth.as_ref(),
        Some(Field::Normals) => args.normal.as_ref(),
        Some(Field::Rays) => args.rays.as_ref(),
        Some(Field::DepthKind) => return Failure::usage(format!("--depth-is z: {error}")),
        _ => None,
    };
    let place = file.map_or("the answers".into(), |file| file.to_string_lossy());
    Failure::Job(anyhow!("{place}: {error}"))
}

fn verdict(found: &Conformance) -> Result<(), Failure> {
    let all = found.outcomes.len();
    match (found.outcome(), found.worst.first()) {
        (Outcome::Violated, Some(worst)) => Err(Failure::CheckFailed(anyhow!(
            "{} of {all} pixels need k above {}; the worst is {worst}",
            found.count(Outcome::Violated),
            found.at_most
        ))),
        (Outcome::Proved, _) => Ok(()),
        _ => Err(Failure::Undecided(anyhow!(
            "{} of {all} pixels are undecided, more than {} %; a smaller --at-most or a larger picture decides more",
            found.count(Outcome::Undecided),
            100.0 * MOST_UNDECIDED
        ))),
    }
}

/// The number of pixels that the text report lists.
const LISTED: usize = 10;

#[derive(Serialize)]
pub(crate) struct Report {
    version: &'static str,
    scene: SceneReport,
    picture: Picture,
    checked: Vec<&'static str>,
    at_most: f64,
    counts: BTreeMap<&'static str, usize>,
    decided_fraction: f64,
    largest: Option<f64>,
    histogram: Vec<Bin>,
    worst: Vec<PixelReport>,
    outcome: &'static str,
    command: String,
    #[serde(skip)]
    table: String,
}

#[derive(Serialize)]
struct Picture {
    width: u32,
    height: u32,
    /// The kind of camera, unless rays were given.
    camera: Option<&'static str>,
    /// The distance of given rays from those of the camera, if there is one.
    rays_off: Option<RaysOff>,
}

#[derive(Serialize)]
struct RaysOff {
    camera: &'static str,
    /// The largest angle between two directions.
    degrees: f64,
    /// The largest distance of the start of a ray of the camera from the line of the given ray.
    distance: f64,
}

impl RaysOff {
    fn new(input: &Input, rays: &[Ray]) -> Self {
        let (view, mut off) = (input.view(), [0_f64; 2]);
        for (index, ray) in (0..).zip(rays) {
            let pixel = [index % view.film.width(), index / view.film.width()];
            let Some(exact) = view.ray_through_center(pixel) else { continue };
            let angle = ray.direction.cross(exact.direction).length().atan2(ray.direction.dot(exact.direction));
            let beside = (exact.origin - ray.origin).cross(ray.direction).length();
            off = [off[0].max(angle.to_degrees()), off[1].max(beside)];
        }
        Self { camera: input.camera.kind().name(), degrees: off[0], distance: off[1] }
    }
}

#[derive(Serialize)]
struct Bin {
    up_to: Option<f64>,
    count: usize,
}

/// A pixel with its message.
#[derive(Serialize)]
struct PixelReport {
    pixel: [u32; 2],
    id: Option<u32>,
    depth: Option<f64>,
    outcome: &'static str,
    k: Option<f64>,
    margin: Option<f64>,
    reason: &'static str,
    exact_id: Option<u32>,
    exact_distance: Option<f64>,
    message: String,
}

/// A number that JSON can hold, which must be finite.
fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

impl From<&Finding> for PixelReport {
    fn from(finding: &Finding) -> Self {
        let id = Some(finding.id).filter(|id| *id != NO_ID);
        Self {
            pixel: finding.pixel,
            id,
            depth: id.and(finding.depth),
            outcome: finding.outcome.name(),
            k: finite(finding.least),
            margin: finite(finding.margin),
            reason: finding.reason.name(),
            exact_id: finding.exact.map(|(id, _)| id),
            exact_distance: finding.exact.map(|(_, t)| t),
            message: finding.to_string(),
        }
    }
}

impl Report {
    pub(crate) fn new(input: &Input, answers: &Answers<'_>, has_rays: bool, found: &Conformance) -> Self {
        let [width, height] = found.size;
        let depth = match answers.depth_kind {
            DepthKind::Distance => "depth as t",
            DepthKind::AlongAxis => "depth as z",
        };
        let checked = [Some("id"), answers.depths.map(|_| depth), answers.normals.map(|_| "normal")];
        let count = |outcome: &Outcome| (outcome.name(), found.count(*outcome));
        Self {
            version: env!("CARGO_PKG_VERSION"),
            scene: SceneReport::new(&input.scene),
            picture: Picture { width, height, camera: (!has_rays).then(|| input.camera.kind().name()), rays_off: None },
            checked: checked.into_iter().flatten().collect(),
            at_most: found.at_most,
            counts: Outcome::ALL.iter().map(count).collect(),
            decided_fraction: found.decided_fraction(),
            largest: finite(found.largest()),
            histogram: found
                .histogram()
                .into_iter()
                .map(|(up_to, count)| Bin { up_to: finite(up_to), count })
                .collect(),
            worst: found.worst.iter().map(PixelReport::from).collect(),
            outcome: found.outcome().name(),
            command: command_line(),
            table: table(found),
        }
    }

    pub(crate) fn table(&self) -> String {
        let Picture { width, height, camera, rays_off } = &self.picture;
        let mut rays = camera.map_or("given rays, taken as they are".to_owned(), |camera| format!("{camera} camera"));
        if let Some(RaysOff { camera, degrees, distance }) = rays_off {
            rays += &format!(", off those of the {camera} camera by up to {degrees:.2e} degrees and {distance:.2e}");
        }
        format!(
            "{}\npicture: {width}x{height}, {rays}\n\
             checked: {}\n{}{}\n",
            self.scene.line(),
            self.checked.join(", "),
            self.table,
            self.outcome
        )
    }
}

/// Returns the counts, the histogram, and the first of the worst pixels.
fn table(found: &Conformance) -> String {
    let mut text = found.to_string();
    // The first is already in the text.
    for finding in found.worst.iter().take(LISTED).skip(1) {
        text += &format!("\n       {finding}");
    }
    text + "\n"
}
