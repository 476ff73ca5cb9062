//! Recordings of lit pictures, along paths or in studios.

use super::checker::Checker;
use super::lit::LitCertificate;
use super::paths::PathRecording;
use super::studio::StudioRecording;

/// A recording of samples of a lit picture.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum LitRecording<'a> {
    /// Samples of the integrator `path`.
    Paths(&'a PathRecording),
    /// Samples of the integrator `studio`.
    Studio(&'a StudioRecording),
}

impl Checker<'_> {
    /// Judges every stage of every sample. The recording must be of the scene of this checker.
    #[must_use]
    pub fn certify_lit(&self, recording: LitRecording<'_>) -> LitCertificate {
        match recording {
            LitRecording::Paths(recording) => self.certify_paths(recording),
            LitRecording::Studio(recording) => self.certify_studio(recording),
        }
    }
}
