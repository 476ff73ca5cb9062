//! A file whose frames were found, of which one at a time is read.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use anyhow::Result;

use crate::data::{self, DataOptions};
use pinhole::load::{Loaded, Trajectory};

/// A file whose frames were found.
pub(crate) struct OpenFrames {
    pub(super) path: PathBuf,
    pub(super) file: Mutex<Trajectory>,
}

/// What was found about the frames of a file.
pub(crate) struct FoundFrames {
    pub(crate) count: usize,
    /// What is wrong after the last frame, for the user.
    pub(crate) note: Option<String>,
}

impl OpenFrames {
    /// Reads the frame that the options name, or else the first.
    pub(super) fn read(&self, options: &DataOptions) -> Result<Loaded> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        data::read_frame_of(&self.path, &mut file, options)
    }
}
