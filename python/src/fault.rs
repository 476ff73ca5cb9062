//! Failures, and the Python exceptions that they become.

use pinhole::gpu::GpuError;
use pinhole_data::load::{LoadError, Place};
use pyo3::prelude::*;

/// A failure, by the kind of exception that it becomes.
pub(crate) enum Fault {
    /// Bad input: `pinhole.InputError`, a `ValueError`.
    Input(String),
    /// A file cannot be read: `pinhole.FileError`, an `OSError`.
    File(String),
    /// A device cannot do the work: `pinhole.DeviceError`, a `RuntimeError`.
    Device(String),
    /// The device was lost. A new device may do the work.
    Lost(String),
    /// The work was stopped, because Python raised an exception, such as `KeyboardInterrupt`.
    Stopped,
    /// A defect of this package: `pinhole.InternalError`, a `RuntimeError`.
    Internal(String),
    /// An exception that Python raised.
    Python(PyErr),
}

pub(crate) type Outcome<T> = Result<T, Fault>;

impl Fault {
    /// Makes bad input from an error of the library.
    pub(crate) fn input(error: impl std::fmt::Display) -> Self {
        Self::Input(error.to_string())
    }

    /// An error of reading the file at `path`.
    pub(crate) fn reading(path: &str, error: &LoadError) -> Self {
        match error.place {
            Place::File(_) => Self::File(error.to_string()),
            _ => Self::Input(format!("{path}: {error}")),
        }
    }
}

/// A message in the words of Python: arguments in the place of flags.
pub(crate) fn in_python(message: &str) -> String {
    const WORDS: [(&str, &str); 6] = [
        ("--radius sets it", "radius=... sets it"),
        ("--bond-length L", "bonds={\"length\": L}"),
        ("leave out `--box`, or the key `box`", "leave out box"),
        ("by --frame", "by frame=..."),
        ("with --columns ", "with columns="),
        ("give --topology ", "give as topology=... "),
    ];
    WORDS.iter().fold(message.to_owned(), |text, (flag, argument)| text.replace(flag, argument))
}

impl From<GpuError> for Fault {
    fn from(error: GpuError) -> Self {
        let message = error.to_string();
        match error {
            GpuError::Stopped => Self::Stopped,
            GpuError::DeviceLost { .. } => Self::Lost(message),
            GpuError::Settings(_) | GpuError::Scene(_) | GpuError::Image(_) => Self::Input(message),
            GpuError::Limit { .. } => Self::Device(format!("{message}; use backend=\"cpu\", which has no such limit")),
            _ => Self::Device(message),
        }
    }
}

impl From<PyErr> for Fault {
    fn from(error: PyErr) -> Self {
        Self::Python(error)
    }
}

impl From<Fault> for PyErr {
    fn from(fault: Fault) -> Self {
        let (class, message) = match fault {
            Fault::Python(error) => return error,
            Fault::Input(message) => ("InputError", in_python(&message)),
            Fault::File(message) => ("FileError", in_python(&message)),
            Fault::Device(message) | Fault::Lost(message) => ("DeviceError", message),
            Fault::Stopped => ("DeviceError", "stopped before the work was finished".to_owned()),
            Fault::Internal(message) => ("InternalError", message),
        };
        Python::attach(|py| {
            let raised = py.import("pinhole._errors").and_then(|errors| {
                let class = errors.getattr(class)?;
                class.call1((message,))
            });
            raised.map_or_else(|error| error, PyErr::from_value)
        })
    }
}
