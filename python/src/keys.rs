//! What colours mean: in one scene, and in all frames of a trajectory.

use std::sync::{Mutex, PoisonError};

use pinhole::color_by::{ColorKey, JoinedKeys, KeyKind};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::spheres::SphereData;

/// What colours mean in several frames together.
#[pyclass(frozen, module = "pinhole._pinhole")]
#[derive(Default)]
pub(crate) struct FrameKeys {
    keys: Mutex<JoinedKeys>,
}

#[pymethods]
impl FrameKeys {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Adds what colours mean in a frame, if a column gives them.
    fn add(&self, frame: &SphereData) {
        if let Some(key) = &frame.key {
            self.keys.lock().unwrap_or_else(PoisonError::into_inner).add(key);
        }
    }
}

impl FrameKeys {
    pub(crate) fn joined(&self) -> JoinedKeys {
        self.keys.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// A dict: `title`, the name of the column; and either `range`, `log` and the table `colors`, three bytes of sRGB for
/// each colour from the low end on, or `categories`, names with their colours.
pub(crate) fn in_python(py: Python<'_>, key: &ColorKey) -> PyResult<Py<PyAny>> {
    let found = PyDict::new(py);
    found.set_item("title", &key.title)?;
    match &key.kind {
        KeyKind::Scale(scale) => {
            let [low, high] = scale.scale().range();
            found.set_item("range", (low, high))?;
            found.set_item("log", scale.scale().is_log())?;
            found.set_item("colors", scale.colors().as_flattened())?;
        }
        KeyKind::Categories(all) => {
            let named = all.iter().map(|one| (one.name.clone(), <(u8, u8, u8)>::from(one.color)));
            let named: Vec<_> = named.collect();
            found.set_item("categories", named)?;
        }
        _ => {}
    }
    Ok(found.into_any().unbind())
}
