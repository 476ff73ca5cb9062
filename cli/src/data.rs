//! Data: files of spheres, which flags concern them, and what their spheres look like.

use std::path::Path;

use anyhow::{Context, Error, Result};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use pinhole::LinearRgb;
use pinhole::load::npy::SpheresError;
use pinhole::load::npz::NpzError;
use pinhole::load::{FORMATS, Format, LoadError, Loaded, Options};

use super::failure::Failure;
use super::memory;

/// What flags and a scene file say of the data.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DataOptions {
    /// Which frame of a trajectory.
    pub(super) frame: Option<usize>,
    /// The radius of all.
    pub(super) radius: Option<f64>,
    /// The colour of all.
    pub(super) color: Option<LinearRgb>,
}

/// Reads the name of a format on the command line.
pub(super) fn format_parser() -> impl TypedValueParser<Value = &'static Format> {
    let value = |format: &Format| PossibleValue::new(format.name).help(format.about);
    PossibleValuesParser::new(FORMATS.iter().map(value))
        .try_map(|name| Format::of_name(&name).ok_or("there is no such format"))
}

impl DataOptions {
    /// How the library is to read the file.
    fn to_read(self) -> Options {
        let mut options = Options::default();
        (options.frame, options.radius) = (self.frame, self.radius);
        options
    }

    /// Refuses what does not concern the format. The keys of a scene file and the flags have the same
    /// names, but for `prefix`.
    pub(super) fn check(&self, format: &Format, prefix: &str) -> Result<(), String> {
        format.check(&self.to_read()).map_err(|error| format!("{prefix}{error}"))?;
        if self.color.is_some() && format.has_colors {
            return Err(format!(
                "{prefix}color concerns data without colors; atoms have those of their elements"
            ));
        }
        Ok(())
    }

    /// The flags where they are given, else what the scene file says.
    pub(super) fn or(self, file: Self) -> Self {
        Self {
            frame: self.frame.or(file.frame),
            radius: self.radius.or(file.radius),
            color: self.color.or(file.color),
        }
    }
}

/// Reads the contents of the file `path`. Notes name the file.
pub(super) fn read(
    bytes: &[u8],
    path: &Path,
    format: &Format,
    options: &DataOptions,
) -> Result<Loaded> {
    let file_name = || path.display().to_string();
    let extra = format.extra_bytes(bytes).with_context(file_name)?;
    if extra > 0 {
        let what = format!("{}: to read an array of {extra} bytes takes", path.display());
        memory::check_reading(&what, extra).map_err(Error::msg)?;
    }
    let mut loaded = format.read(bytes, &options.to_read()).with_context(file_name)?;
    for note in &mut loaded.notes {
        *note = format!("{}: {note}", path.display());
    }
    Ok(loaded)
}

/// An array with a radius too many or too few is mended with a flag, so it is wrong usage.
pub(super) fn as_usage(error: anyhow::Error) -> Failure {
    let of_array = match error.downcast_ref::<LoadError>() {
        Some(LoadError::Npy(error) | LoadError::Npz(NpzError::Spheres { error, .. })) => {
            Some(error)
        }
        _ => None,
    };
    match of_array {
        Some(SpheresError::NoRadius { .. }) => {
            Failure::usage(format!("{error:#} (add --radius R)"))
        }
        Some(SpheresError::TwoRadii { .. }) => Failure::usage(format!("{error:#}; drop it")),
        _ => Failure::Job(error),
    }
}
