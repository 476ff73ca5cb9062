//! Reads files, as a whole or frame by frame, and joins the meaning of colours in all frames.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use pyo3::prelude::*;

use crate::fault::{Fault, Outcome};
use crate::look::{self, SceneText};
use crate::scene::DataExtras;
use crate::spheres::SphereData;
use crate::worker;
use pinhole_data::kind::Traits;
use pinhole_data::load::{self, Dataset, FileSet, Format, LoadError, Options, Trajectory};
use pinhole_figure::color_by::JoinedKeys;
use pinhole_figure::framing::Union;

/// A file of spheres, perhaps with several frames, which are read one at a time.
#[pyclass(frozen, module = "pinhole._pinhole")]
pub(crate) struct FileData {
    path: String,
    format: &'static Format,
    options: Options,
    /// The frames, if files of this format can have several.
    frames: Option<Mutex<Trajectory>>,
    count: usize,
    /// The fault after the last complete frame, if there is one.
    #[pyo3(get)]
    problem: Option<String>,
}

#[pymethods]
impl FileData {
    /// Opens a file, and finds its frames.
    #[new]
    fn new(
        py: Python<'_>,
        path: String,
        format: Option<String>,
        radius: Option<f64>,
        topology: Option<PathBuf>,
        columns: Vec<String>,
    ) -> PyResult<Self> {
        Ok(worker::run(py, None, move |_| {
            FileSet::of(path.as_ref()).map_err(|error| Fault::reading(&path, &error))?;
            let format = format_of(&path, format.as_deref())?;
            let mut options = Options::default().with_format(format).with_columns(columns);
            (options.radius, options.topology) = (radius, topology);
            format.check(&options).map_err(Fault::input)?;
            let fault = |error: LoadError| Fault::reading(&path, &error);
            let has_frames =
                (format.has_frames() || FileSet::is_one(path.as_ref())) && FileSet::together(path.as_ref()).is_none();
            let found = has_frames.then(|| Trajectory::open(&path, &options)).transpose().map_err(fault)?;
            let count = found.as_ref().map_or(1, Trajectory::len);
            let problem = found.as_ref().and_then(Trajectory::problem).map(ToString::to_string);
            Ok(Self { path, format, options, frames: found.map(Mutex::new), count, problem })
        })?)
    }

    /// The name for several files: frames if their names differ in a number, and others together.
    #[staticmethod]
    fn name_of(paths: Vec<PathBuf>) -> Option<String> {
        let name = FileSet::name_of(&paths).or_else(|| FileSet::name_together(&paths))?;
        Some(name.to_string_lossy().into_owned())
    }

    /// The number of complete frames.
    fn __len__(&self) -> usize {
        self.count
    }

    /// Reads a frame, counted from 0. Equal values have equal colours in all frames with the same `keys`.
    #[pyo3(signature = (index, text, keys))]
    fn frame(
        slf: Bound<'_, Self>,
        py: Python<'_>,
        index: usize,
        text: SceneText,
        keys: Option<&JoinedFrames>,
    ) -> PyResult<SphereData> {
        let this = slf.unbind();
        let (keys, traits) = keys.map(JoinedFrames::joined).unzip();
        Ok(worker::run(py, None, move |_| {
            let this = this.get();
            let mut loaded = this.read(index)?;
            for note in &mut loaded.notes {
                *note = format!("{}: {note}", this.path);
            }
            let radii = this.options.radius.is_some();
            let given = DataExtras { radii, keys, traits: traits.flatten(), ..DataExtras::default() };
            SphereData::of_loaded(loaded, &text, given, this.format.z_is_up).map_err(|fault| this.in_file(fault))
        })?)
    }
}

impl FileData {
    fn read(&self, index: usize) -> Outcome<Dataset> {
        let read = match &self.frames {
            Some(frames) => frames.lock().unwrap_or_else(PoisonError::into_inner).frame(index),
            None => load::open(&self.path, &self.options),
        };
        read.map_err(|error| Fault::reading(&self.path, &error))
    }

    /// Adds the file's name to a fault of its spheres.
    fn in_file(&self, fault: Fault) -> Fault {
        match fault {
            Fault::Input(message) => Fault::Input(format!("{}: {message}", self.path)),
            other => other,
        }
    }
}

/// The format with a name, or by default that of a file.
fn format_of(path: &str, name: Option<&str>) -> Outcome<&'static Format> {
    let names = || load::FORMATS.iter().map(|format| format.name).collect::<Vec<_>>().join(", ");
    match name {
        Some(name) => Format::of_name(name)
            .ok_or_else(|| Fault::Input(format!("format is {name:?}; the formats are {}", names()))),
        None => {
            let found = Format::of_path(path.as_ref());
            let found = found.map_err(|error| Fault::File(format!("{path}: cannot be read: {error}")))?;
            found.ok_or_else(|| Fault::Input(format!("{path}: {}", Format::unknown())))
        }
    }
}

/// Several frames together: the meaning of their colours, and the spheres that a camera frames.
#[pyclass(frozen, module = "pinhole._pinhole")]
#[derive(Default)]
pub(crate) struct JoinedFrames {
    joined: Mutex<(JoinedKeys, Union)>,
    /// The traits of the first frame, which decide for all of them.
    traits: Mutex<Option<Traits>>,
}

#[pymethods]
impl JoinedFrames {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Adds a frame.
    fn add(&self, frame: &SphereData) {
        let mut joined = self.joined.lock().unwrap_or_else(PoisonError::into_inner);
        joined.1.add(&frame.scene());
        if let Some(traits) = &frame.traits {
            let mut first = self.traits.lock().unwrap_or_else(PoisonError::into_inner);
            // Spheres may move anywhere, so that all of them are framed.
            first.get_or_insert_with(|| Traits { bulk: None, ..traits.clone() });
        }
        if let Some(key) = &frame.key {
            joined.0.add(key);
        }
        if let Some(key) = &frame.arrow_key {
            joined.0.add_arrows(key);
        }
    }

    /// The camera of a text with its position, as JSON, which frames the spheres of all frames.
    fn placed(&self, text: SceneText) -> PyResult<String> {
        let union = self.joined.lock().unwrap_or_else(PoisonError::into_inner).1.clone();
        let framed = union.scene().map_err(|error| Fault::Input(error.to_string()))?;
        Ok(look::placed(&text, &framed)?)
    }
}

impl JoinedFrames {
    /// The meaning of colours in all frames, and the traits of the first.
    pub(crate) fn joined(&self) -> (JoinedKeys, Option<Traits>) {
        let traits = self.traits.lock().unwrap_or_else(PoisonError::into_inner).clone();
        (self.joined.lock().unwrap_or_else(PoisonError::into_inner).0.clone(), traits)
    }
}
