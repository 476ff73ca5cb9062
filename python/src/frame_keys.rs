//! What colours mean in all frames of a trajectory.

use std::sync::{Mutex, PoisonError};

use pinhole::color_by::JoinedKeys;
use pyo3::prelude::*;

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
