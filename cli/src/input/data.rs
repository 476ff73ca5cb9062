//! Reads data files, and checks the flags and keys that apply to them.

use std::path::{Path, PathBuf};

use anyhow::{Context, Error, Result};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::flags::settings::Given;
use crate::input::read_file::{check_regular, data_format, is_standard_input, open, read as read_bytes};
use crate::terminal::failure::Failure;
use crate::terminal::memory;
use pinhole_data::load::{
    ConeSet, Dataset, FORMATS, FileRows, FileSet, Format, LoadError, LoadErrorKind, Options, Place, Trajectory,
};
use pinhole_figure::scene_file::{ConeFile, SceneFile};

/// The options for a data file, from flags or from a scene file.
#[derive(Clone, Debug, Default)]
pub(crate) struct DataOptions {
    /// Frame of a trajectory, from 0.
    pub(crate) frame: Option<usize>,
    pub(crate) radius: Option<f64>,
    /// File that says what the spheres of a trajectory are.
    pub(crate) topology: Option<PathBuf>,
    pub(crate) columns: Vec<String>,
}

pub(crate) fn format_parser() -> impl TypedValueParser<Value = &'static Format> {
    let value = |format: &Format| PossibleValue::new(format.name).help(format.about);
    PossibleValuesParser::new(FORMATS.iter().map(value))
        .try_map(|name| Format::of_name(&name).ok_or("this is not a valid format"))
}

impl DataOptions {
    fn to_read(&self, format: &Format) -> Options {
        let mut options = Options::default();
        // Atoms have radii, which the one for all replaces after reading.
        let radius = self.radius.filter(|_| !is_of_atoms(format));
        (options.frame, options.radius) = (self.frame, radius);
        (options.topology, options.columns) = (self.topology.clone(), self.columns.clone());
        options
    }

    /// The flags that give these options and a format, all but the color.
    pub(crate) fn given(&self, format: Option<&Format>) -> Given {
        let topology = self.topology.as_ref().map(|file| file.to_string_lossy().into_owned());
        Given::default()
            .with("format", format.map(|format| format.name.to_owned()))
            .with("frame", self.frame.map(|frame| frame.to_string()))
            .with("radius", self.radius.map(|radius| radius.to_string()))
            .with("topology", topology)
            .with("columns", (!self.columns.is_empty()).then(|| self.columns.join(",")))
    }

    /// Refuses options that do not apply to the file with this path and format. Returns the error, and whether a flag is
    /// wrong.
    pub(crate) fn check(&self, path: &Path, format: &Format, file: &SceneFile) -> Result<(), (String, bool)> {
        // One of several files is a frame of any format.
        let frame = self.frame.filter(|_| !FileSet::is_one(path));
        format.check(&Self { frame, ..self.clone() }.to_read(format)).map_err(|error| {
            let error = error.to_string();
            // The error begins with the key.
            let (key, rest) = error.split_at(error.find(' ').unwrap_or(error.len()));
            file.flag_of(key).map_or((error.clone(), false), |flag| (format!("{flag}{rest}"), true))
        })
    }
}

/// Returns true if the radii of a format are those of atoms, and not written in the file.
fn is_of_atoms(format: &Format) -> bool {
    !format.may_lack_radii && (format.has_colors || format.needs_topology)
}

/// Reads spheres from a file. Of a file with frames only the one that is asked for is in memory. Errors and notes get the
/// path in front.
pub(crate) fn read(path: &Path, format: &'static Format, options: &DataOptions) -> Result<Dataset> {
    if let Some(set) = FileSet::together(path).filter(|_| options.frame.is_none()) {
        let read_one = |file| Ok((file, read(file, data_format(file).unwrap_or(format), options)?));
        let parts = set.files().iter().map(PathBuf::as_path).map(read_one);
        return Dataset::joined(parts.collect::<Result<Vec<_>>>()?).map_err(|error| named(path, error));
    }
    let mut loaded = match has_frames(path, format) && !is_standard_input(path) {
        true => read_frame(path, format, options)?,
        false => read_whole(path, format, options)?,
    };
    complete(&mut loaded, path, options);
    Ok(loaded)
}

/// Returns true if a file of this format can have frames, or a name stands for several files.
pub(crate) fn has_frames(path: &Path, format: &Format) -> bool {
    format.has_frames() || FileSet::is_one(path)
}

/// Gives all spheres the radius that is asked for, and puts the path before notes.
fn complete(loaded: &mut Dataset, path: &Path, options: &DataOptions) {
    loaded.give_radius(options.radius);
    for note in &mut loaded.notes {
        *note = format!("{}: {note}", path.display());
    }
}

/// Reads the frame that the options name from a file whose frames were found, if there is memory for it.
pub(crate) fn read_frame_of(path: &Path, file: &mut Trajectory, options: &DataOptions) -> Result<Dataset> {
    let frame = options.frame.unwrap_or_default();
    check_frame(path, file, frame)?;
    let mut loaded = file.frame(frame).map_err(|error| named(path, error))?;
    complete(&mut loaded, path, options);
    Ok(loaded)
}

/// Reads the frame that is asked for, if there is memory for it.
fn read_frame(path: &Path, format: &'static Format, options: &DataOptions) -> Result<Dataset> {
    check_regular(path)?;
    let frame = options.frame.unwrap_or_default();
    let options = options.to_read(format).with_format(format);
    let found = Trajectory::open_up_to(path, &options).map_err(|error| named(path, error))?;
    check_frame(path, &found, frame)?;
    found.into_frame(frame).map_err(|error| named(path, error))
}

/// Finds all frames of a file, and checks that there is memory for the one that is asked for.
pub(crate) fn trajectory(path: &Path, format: &'static Format, options: &DataOptions) -> Result<Trajectory> {
    check_regular(path)?;
    let all = options.to_read(format).with_format(format);
    let found = Trajectory::open(path, &all).map_err(|error| named(path, error))?;
    check_frame(path, &found, options.frame.unwrap_or_default())?;
    Ok(found)
}

fn check_frame(path: &Path, found: &Trajectory, frame: usize) -> Result<()> {
    let bytes = found.frame_bytes(frame).unwrap_or_default();
    let what = format!("{}: reading {bytes} bytes needs", path.display());
    memory::check_reading(&what, bytes)
}

/// An error of reading a file, with its path in front.
pub(crate) fn named(path: &Path, error: LoadError) -> Error {
    match error.place {
        // The error has it.
        Place::File(_) => Error::new(error),
        _ => Error::new(error).context(path.display().to_string()),
    }
}

fn read_whole(path: &Path, format: &Format, options: &DataOptions) -> Result<Dataset> {
    let file_name = || path.display().to_string();
    if !is_standard_input(path) {
        let (file, options) = (open(path)?, options.to_read(format));
        if let Some(rows) = FileRows::find(format, &file, &options).with_context(file_name)? {
            memory::check_spheres(&format!("{}: its spheres need", path.display()), rows.bytes())?;
            return rows.read().with_context(file_name);
        }
    }
    let bytes = &read_bytes(path)?;
    let extra = format.extra_bytes(bytes).with_context(file_name)?;
    if extra > 0 {
        let what = format!("{}: reading an array of {extra} bytes needs", path.display());
        memory::check_reading(&what, extra)?;
    }
    format.read(bytes, &options.to_read(format)).with_context(file_name)
}

/// Reads a file of cylinders or cones. An error has the path in front.
pub(crate) fn read_cones(path: &Path, of: &ConeFile) -> Result<ConeSet> {
    let bytes = &read_bytes(path)?;
    if let Ok(Some(format)) = Format::of_path(path) {
        let extra = format.extra_bytes(bytes).with_context(|| path.display().to_string())?;
        memory::check_reading(&format!("{}: reading an array of {extra} bytes needs", path.display()), extra)?;
    }
    ConeSet::from_bytes(bytes, path, of.kind, of.radii).with_context(|| path.display().to_string())
}

/// Turns an error into a failure. What a flag corrects is wrong usage: a trajectory without a topology, or two radii.
pub(crate) fn as_usage(error: anyhow::Error) -> Failure {
    match error.downcast_ref::<LoadError>().map(|error| error.kind) {
        Some(LoadErrorKind::NoTopology) => Failure::usage(format!("{error:#} (add --topology FILE)")),
        Some(LoadErrorKind::TwoRadii) => Failure::usage(format!("{error:#}")),
        _ => Failure::Job(error),
    }
}
