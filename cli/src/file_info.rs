//! `pinhole info FILE`: says what a data file or a scene file holds. Of a trajectory one frame is in memory.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;

use super::bricks;
use super::data::{self, DataOptions, as_usage, format_parser};
use super::failure::Failure;
use super::file_info_text as text;
use super::file_report::{ColumnReport, DataReport, Kind, Report, SceneReport};
use super::input::{self, Source};
use super::input_format;
use super::read_file;
use super::speak::answer;
use pinhole::LinearRgb;
use pinhole::load::{Format, Loaded};

/// The file to describe, and how it is read.
#[derive(Debug, Args)]
pub(super) struct FileArgs {
    /// Data file or scene file to describe, instead of the adapters
    #[arg(value_name = "FILE")]
    #[cfg_attr(feature = "gpu", arg(conflicts_with_all = ["self_test", "adapter", "dump_shaders"]))]
    pub(super) path: Option<PathBuf>,
    /// Format of the file, whatever its extension is
    #[arg(long, value_parser = format_parser(), requires = "path")]
    pub(super) format: Option<&'static Format>,
    /// Frame of a trajectory to describe, counted from 0 [default: 0]
    #[arg(long, value_name = "N", requires = "path")]
    pub(super) frame: Option<usize>,
    /// File that says what the spheres of a trajectory are, for formats that have positions alone
    #[arg(long, value_name = "TOPOLOGY", requires = "path")]
    pub(super) topology: Option<PathBuf>,
    /// Names of the columns of a table without a header, such as x,y,z,radius
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "path")]
    pub(super) columns: Vec<String>,
    /// Radius of all spheres, for data without radii
    #[arg(long, value_name = "R", requires = "path", allow_hyphen_values = true)]
    pub(super) radius: Option<f64>,
}

const BRICKS: input_format::Format = input_format::Format::Bricks;

/// Describes the file.
pub(super) fn run(args: &FileArgs, path: &Path, json: bool) -> Result<(), Failure> {
    if args.format.is_none() && input_format::Format::of(path).ok() == Some(BRICKS) {
        let text = bricks::info_lines(path, json)?;
        return Ok(answer(text.as_bytes()).context("standard output: cannot be written")?);
    }
    let report = report(args, path)?;
    let text = if json {
        serde_json::to_string_pretty(&report).context("the report cannot be written as JSON")?
            + "\n"
    } else {
        text::readable(&report)
    };
    Ok(answer(text.as_bytes()).context("standard output: cannot be written")?)
}

fn report(args: &FileArgs, path: &Path) -> Result<Report, Failure> {
    let format = match args.format {
        Some(format) => input_format::Format::Data(format),
        None => input_format::Format::of(path).map_err(Failure::Usage)?,
    };
    let options = DataOptions {
        frame: args.frame,
        radius: args.radius,
        color: None,
        topology: args.topology.clone(),
        columns: args.columns.clone(),
    };
    input::check_flags(format, &options)?;
    match format {
        input_format::Format::Data(format) => of_data(path, format, &options).map_err(as_usage),
        // Files of bricks have a report of their own.
        input_format::Format::Scene | BRICKS => of_scene(path, args),
    }
}

fn of_data(path: &Path, format: &'static Format, options: &DataOptions) -> Result<Report> {
    let is_file = path.is_file();
    let has_frames = format.has_frames();
    let (loaded, frames, problem) = if has_frames && is_file {
        let mut trajectory = data::trajectory(path, format, options)?;
        let problem = trajectory.problem().map(ToString::to_string);
        let frame = trajectory.frame(options.frame.unwrap_or_default());
        let loaded = frame.map_err(|error| data::named(path, error))?;
        (loaded, Some(trajectory.len()), problem)
    } else {
        let mut loaded = data::read(path, format, options)?;
        // Notes of `read` start with the path, which is in the report already.
        let start = format!("{}: ", path.display());
        for note in &mut loaded.notes {
            *note = note.strip_prefix(&start).unwrap_or(note).to_owned();
        }
        let frames = loaded.frames.filter(|_| has_frames);
        (loaded, frames, None)
    };
    let kind = Kind::Data(DataReport {
        format: format.name,
        about: format.about,
        compressed: is_file.then(|| read_file::is_gzip(path)),
        frames,
        frame: has_frames.then(|| options.frame.unwrap_or_default()),
        problem,
        colors: loaded.colors.is_some(),
        opacities: loaded.opacities.is_some(),
        cell: loaded.cell,
        cell_origin: loaded.cell.map(|_| loaded.cell_origin),
        columns: loaded.columns.iter().map(ColumnReport::new).collect(),
    });
    Ok(with_spheres(path, kind, &loaded))
}

/// Adds what the spheres themselves say. Those that cannot be rendered are named, and left out of the box.
fn with_spheres(path: &Path, kind: Kind, loaded: &Loaded) -> Report {
    let mut notes = loaded.notes.clone();
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let mut radii = [f64::INFINITY, f64::NEG_INFINITY];
    let (mut bad, mut first) = (0, None);
    for (index, sphere) in loaded.spheres.with_color(LinearRgb::WHITE).enumerate() {
        if let Err(error) = sphere.check() {
            bad += 1;
            first.get_or_insert_with(|| format!("sphere {index}: {error}"));
            continue;
        }
        radii = [radii[0].min(sphere.radius), radii[1].max(sphere.radius)];
        for (axis, center) in sphere.center.iter().enumerate() {
            low[axis] = low[axis].min(center - sphere.radius);
            high[axis] = high[axis].max(center + sphere.radius);
        }
    }
    let is_any = loaded.spheres.len() > bad;
    if let Some(first) = first {
        notes.push(format!("{bad} of the spheres cannot be rendered; {first}"));
    }
    Report {
        version: env!("CARGO_PKG_VERSION"),
        file: path.display().to_string(),
        bytes: path.metadata().ok().filter(|_| path.is_file()).map(|found| found.len()),
        kind,
        spheres: loaded.spheres.len(),
        min: is_any.then_some(low),
        max: is_any.then_some(high),
        radius_min: is_any.then_some(radii[0]),
        radius_max: is_any.then_some(radii[1]),
        notes,
    }
}

fn of_scene(path: &Path, args: &FileArgs) -> Result<Report, Failure> {
    let given = [
        ("--frame", args.frame.is_some()),
        ("--radius", args.radius.is_some()),
        ("--topology", args.topology.is_some()),
        ("--columns", !args.columns.is_empty()),
    ];
    if let Some((flag, _)) = given.into_iter().find(|(_, is_given)| *is_given) {
        return Err(Failure::usage(format!(
            "{}: {flag} applies to data files, but this is a scene file; remove {flag}",
            path.display()
        )));
    }
    let input = Source::of_scene(path).load()?;
    let (scene, settings) = (&input.scene, &input.settings);
    let kind = Kind::Scene(SceneReport {
        width: input.film.width(),
        height: input.film.height(),
        camera: input.camera.kind().name(),
        stereo: input.eyes.is_some(),
        integrator: settings.integrator.name(),
        samples: if settings.integrator.is_primary() { 1 } else { settings.sampling.samples },
        lights: settings.lights.len(),
        files: input.files.iter().skip(1).map(|file| file.display().to_string()).collect(),
    });
    let bounds = scene.bounds();
    let radii = scene.spheres().iter().map(|sphere| f64::from(sphere[3]));
    Ok(Report {
        version: env!("CARGO_PKG_VERSION"),
        file: path.display().to_string(),
        bytes: path.metadata().ok().map(|found| found.len()),
        kind,
        spheres: scene.len() - scene.added(),
        min: bounds.as_ref().map(|bounds| bounds.min().to_array()),
        max: bounds.as_ref().map(|bounds| bounds.max().to_array()),
        radius_min: radii.clone().reduce(f64::min),
        radius_max: radii.reduce(f64::max),
        notes: input.notes.clone(),
    })
}
