//! `pinhole info FILE`: describes a data file or a scene file. Only one frame of a trajectory is in memory.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use serde::Serialize;

use crate::bricks;
use crate::flags::settings::Given;
use crate::input::Source;
use crate::input::data::{self, DataOptions, as_usage, format_parser};
use crate::input::read_file;
use crate::terminal::failure::Failure;
use crate::terminal::progress::answer;
use crate::terminal::text;
use pinhole::LinearRgb;
use pinhole::internals::text::{one_line, whole_line};
use pinhole_data::load::{Column, ColumnValues, Dataset, FileSet, Format};

/// The file to describe, and how it is read.
#[derive(Debug, Args)]
pub(crate) struct FileArgs {
    /// Data file or scene file to describe, instead of the adapters
    #[arg(value_name = "FILE")]
    #[cfg_attr(feature = "gpu", arg(conflicts_with_all = ["self_test", "adapter", "dump_shaders"]))]
    pub(crate) path: Option<PathBuf>,
    /// Format of the file, whatever its extension is
    #[arg(long, value_parser = format_parser(), requires = "path")]
    pub(crate) format: Option<&'static Format>,
    /// Frame of a trajectory to describe, counted from 0 [default: 0]
    #[arg(long, value_name = "N", requires = "path")]
    pub(crate) frame: Option<usize>,
    /// File that says what the spheres of a trajectory are, for formats that have positions alone
    #[arg(long, value_name = "TOPOLOGY", requires = "path")]
    pub(crate) topology: Option<PathBuf>,
    /// Names of the columns of a table without a header, such as x,y,z,radius
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "path")]
    pub(crate) columns: Vec<String>,
    /// Radius of all spheres, for atoms and data without radii
    #[arg(long, value_name = "R", requires = "path", allow_hyphen_values = true)]
    pub(crate) radius: Option<f64>,
}

const BRICKS: read_file::Format = read_file::Format::Bricks;

pub(crate) fn run(args: &FileArgs, path: &Path, json: bool) -> Result<(), Failure> {
    if args.format.is_none() && read_file::Format::of(path).ok() == Some(BRICKS) {
        let text = bricks::info_lines(path, json)?;
        return Ok(answer(text.as_bytes())?);
    }
    let report = report(args, path)?;
    let text = if json { text::json(&report)? } else { readable(&report) };
    Ok(answer(text.as_bytes())?)
}

fn report(args: &FileArgs, path: &Path) -> Result<Report, Failure> {
    read_file::check_regular(path)?;
    let format = match args.format {
        Some(format) => read_file::Format::Data(format),
        None => read_file::Format::of(path)?,
    };
    let options = DataOptions {
        frame: args.frame,
        radius: args.radius,
        topology: args.topology.clone(),
        columns: args.columns.clone(),
    };
    match format {
        read_file::Format::Data(format) => {
            // Checks the options before the file is read.
            Source::new(path, &options.given(Some(format)))?;
            of_data(path, format, &options).map_err(as_usage)
        }
        // Files of bricks have a report of their own.
        read_file::Format::Scene | BRICKS => of_scene(path, &options.given(None)),
    }
}

fn of_data(path: &Path, format: &'static Format, options: &DataOptions) -> Result<Report> {
    let is_file = !read_file::is_standard_input(path);
    let has_frames = data::has_frames(path, format) && FileSet::together(path).is_none();
    let (loaded, frames, problem) = if has_frames && is_file {
        let mut trajectory = data::trajectory(path, format, options)?;
        let problem = trajectory.problem().map(ToString::to_string);
        let frame = trajectory.frame(options.frame.unwrap_or_default());
        let mut loaded = frame.map_err(|error| data::named(path, error))?;
        loaded.give_radius(options.radius);
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
        compressed: is_file.then(|| read_file::is_compressed(path)),
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

/// Adds facts about the spheres. Spheres that cannot be rendered are named, and left out of the box.
fn with_spheres(path: &Path, kind: Kind, loaded: &Dataset) -> Report {
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

fn of_scene(path: &Path, given: &Given) -> Result<Report, Failure> {
    if let Some(flag) = given.first_in(u32::MAX) {
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
        cones: input.file.shapes().cone_count(),
        files: input.files.iter().skip(1).map(|file| file.display().to_string()).collect(),
    });
    let bounds = scene.bounds();
    let spheres = scene.len() - scene.added();
    let radii = scene.spheres()[..spheres].iter().map(|sphere| f64::from(sphere[3]));
    Ok(Report {
        version: env!("CARGO_PKG_VERSION"),
        file: path.display().to_string(),
        bytes: path.metadata().ok().map(|found| found.len()),
        kind,
        spheres,
        min: bounds.as_ref().map(|bounds| bounds.min().to_array()),
        max: bounds.as_ref().map(|bounds| bounds.max().to_array()),
        radius_min: radii.clone().reduce(f64::min),
        radius_max: radii.reduce(f64::max),
        notes: input.notes.clone(),
    })
}

#[derive(Serialize)]
pub(crate) struct Report {
    pub(crate) version: &'static str,
    pub(crate) file: String,
    /// Size of the file; `None` on standard input.
    pub(crate) bytes: Option<u64>,
    #[serde(flatten)]
    pub(crate) kind: Kind,
    pub(crate) spheres: usize,
    /// The corners of the box of all spheres.
    pub(crate) min: Option<[f64; 3]>,
    pub(crate) max: Option<[f64; 3]>,
    pub(crate) radius_min: Option<f64>,
    pub(crate) radius_max: Option<f64>,
    pub(crate) notes: Vec<String>,
}

/// Facts that only one of the two kinds of file has.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(crate) enum Kind {
    Data(DataReport),
    Scene(SceneReport),
}

#[derive(Serialize)]
pub(crate) struct DataReport {
    pub(crate) format: &'static str,
    #[serde(skip)]
    pub(crate) about: &'static str,
    /// Is true if the file is compressed; `None` on standard input.
    pub(crate) compressed: Option<bool>,
    /// Number of frames; `None` if the format has no frames, or the number is not known.
    pub(crate) frames: Option<usize>,
    /// The frame that the rest describes.
    pub(crate) frame: Option<usize>,
    /// The error after the last complete frame.
    pub(crate) problem: Option<String>,
    pub(crate) colors: bool,
    pub(crate) opacities: bool,
    pub(crate) cell: Option<[[f64; 3]; 3]>,
    /// The corner at which the edges of the cell start.
    pub(crate) cell_origin: Option<[f64; 3]>,
    pub(crate) columns: Vec<ColumnReport>,
}

#[derive(Serialize)]
pub(crate) struct ColumnReport {
    pub(crate) name: String,
    #[serde(flatten)]
    pub(crate) values: ValuesReport,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(crate) enum ValuesReport {
    Numbers { min: Option<f64>, max: Option<f64>, nan: usize },
    Text { different: usize, first: Vec<String> },
}

#[derive(Serialize)]
pub(crate) struct SceneReport {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) camera: &'static str,
    pub(crate) stereo: bool,
    pub(crate) integrator: &'static str,
    pub(crate) samples: u32,
    pub(crate) lights: usize,
    /// The number of cones and cylinders in the file itself.
    pub(crate) cones: usize,
    /// Other files that the scene names.
    pub(crate) files: Vec<String>,
}

impl ColumnReport {
    pub(crate) fn new(Column { name, values }: &Column) -> Self {
        const SHOWN: usize = 6;
        let values = match values {
            ColumnValues::Numbers(numbers) => {
                let known = || numbers.iter().copied().filter(|number| !number.is_nan());
                ValuesReport::Numbers {
                    min: known().reduce(f64::min),
                    max: known().reduce(f64::max),
                    nan: numbers.len() - known().count(),
                }
            }
            ColumnValues::Labels(labels) => ValuesReport::Text {
                different: labels.names.len(),
                first: labels.names.iter().take(SHOWN).map(|name| one_line(name)).collect(),
            },
        };
        Self { name: one_line(name), values }
    }
}

/// Formats the report. Text from the file has its control characters escaped.
pub(crate) fn readable(report: &Report) -> String {
    let mut text = format!("{}\n", whole_line(&report.file));
    let mut line = |name: &str, value: String| text += &format!("  {name:<11}{value}\n");
    match &report.kind {
        Kind::Data(data) => {
            let compressed = if data.compressed == Some(true) { ", compressed" } else { "" };
            line("format", format!("{} ({}){compressed}", data.format, data.about));
        }
        Kind::Scene(_) => line("format", "scene file".to_owned()),
    }
    if let Some(bytes) = report.bytes {
        line("size", format!("{bytes} bytes"));
    }
    match &report.kind {
        Kind::Data(DataReport { frames, frame, .. }) => {
            if let Some(frames) = frames {
                line("frames", frames.to_string());
            }
            if let Some(frame) = frame {
                line("frame", format!("{frame}, which the following describes"));
            }
        }
        Kind::Scene(scene) => {
            let SceneReport { width, height, camera, stereo, integrator, samples, lights, cones, files } = scene;
            line("picture", format!("{width}x{height}"));
            line("camera", format!("{camera}{}", if *stereo { ", stereo" } else { "" }));
            line("integrator", (*integrator).to_owned());
            line("samples", samples.to_string());
            line("lights", lights.to_string());
            if *cones > 0 {
                line("cones", cones.to_string());
            }
            for file in files {
                line("file", whole_line(file));
            }
        }
    }
    line("spheres", report.spheres.to_string());
    if let (Some(min), Some(max)) = (report.min, report.max) {
        let corner = |corner: [f64; 3]| corner.map(short).join(" ");
        line("box", format!("{} to {}", corner(min), corner(max)));
    }
    if let (Some(min), Some(max)) = (report.radius_min, report.radius_max) {
        let radii = if min < max { format!("{} to {}", short(min), short(max)) } else { short(min) };
        line("radii", radii);
    }
    if let Kind::Data(data) = &report.kind {
        let yes_or_no = |is: bool| if is { "yes" } else { "no" }.to_owned();
        line("colors", yes_or_no(data.colors));
        line("opacities", yes_or_no(data.opacities));
        if let Some(cell) = data.cell {
            let edges = cell.map(|edge| format!("({})", edge.map(short).join(" ")));
            let origin = data.cell_origin.filter(|origin| origin.iter().any(|x| *x != 0.0));
            let origin = origin.map(|origin| format!(" from ({})", origin.map(short).join(" ")));
            line("cell", edges.join(" ") + &origin.unwrap_or_default());
        }
        if !data.columns.is_empty() {
            let rows: Vec<_> = data.columns.iter().map(row).collect();
            let width = rows.iter().map(|[name, ..]| name.chars().count()).max().unwrap_or(0);
            text += "columns\n";
            for [name, kind, values] in rows {
                text += &format!("  {name:<width$}  {kind:<7}  {values}\n");
            }
        }
        if let Some(problem) = &data.problem {
            text += &format!("problem: {}\n", whole_line(problem));
        }
    }
    for note in &report.notes {
        text += &format!("note: {}\n", whole_line(note));
    }
    text
}

fn row(ColumnReport { name, values }: &ColumnReport) -> [String; 3] {
    let name = name.clone();
    match values {
        ValuesReport::Numbers { min, max, nan } => {
            let range = min
                .zip(*max)
                .map_or_else(|| "none".to_owned(), |(min, max)| format!("{} to {}", short(min), short(max)));
            let nan = if *nan > 0 { format!(", {nan} NaN") } else { String::new() };
            [name, "numbers".to_owned(), range + &nan]
        }
        ValuesReport::Text { different, first } => {
            let more = if first.len() < *different { ", …" } else { "" };
            [name, "text".to_owned(), format!("{different} different: {}{more}", first.join(", "))]
        }
    }
}

/// Formats a number with six digits, which are enough for a reader.
fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.5e}").parse().unwrap_or(number);
    let size = rounded.abs();
    if rounded == 0.0 || !size.is_finite() || (1e-4..1e9).contains(&size) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits() {
        for (number, expected) in [
            (0.1 + 0.2, "0.3"),
            (123_456_789.0, "123457000"),
            (1e300, "1e300"),
            (-2.5e-7, "-2.5e-7"),
            (0.0, "0"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(short(number), expected);
        }
    }
}
