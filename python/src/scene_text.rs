//! Settings as the text of a scene file, which Python writes from its arguments.

use pinhole::scene_file::{SceneFile, SceneFileError};
use pyo3::prelude::*;

use crate::fault::{Fault, Outcome};

/// The text of a scene file, and which argument of Python each line is of.
#[derive(Clone, Debug, Default)]
pub(crate) struct SceneText {
    text: String,
    /// The argument of each line, such as `studio` or `studio.outline`; may be empty.
    arguments: Vec<String>,
}

impl<'py> FromPyObject<'_, 'py> for SceneText {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let (text, arguments) = object.extract()?;
        Ok(Self { text, arguments })
    }
}

impl SceneText {
    /// Parses the text.
    pub(crate) fn parse(&self) -> Outcome<SceneFile> {
        SceneFile::parse(&self.text).map_err(|error| self.fault(&error))
    }

    /// Whether there are no settings.
    pub(crate) fn is_empty(&self) -> bool {
        self.text.trim().is_empty()
    }

    /// An error in the text, with the argument in place of the line.
    pub(crate) fn fault(&self, error: &SceneFileError) -> Fault {
        let argument = self.arguments.get(error.line.saturating_sub(1)).map_or("", String::as_str);
        let message = &error.message;
        Fault::Input(match argument.is_empty() {
            true => message.clone(),
            false => format!("{argument}: {message}"),
        })
    }
}
