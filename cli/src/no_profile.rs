//! The phases of the program where it is built without the feature `gpu`, and so without profiles.

use std::path::PathBuf;

use super::failure::Failure;

/// A phase that is not measured.
pub(super) struct NoPhase;

impl Drop for NoPhase {
    /// Ends the phase, like that of a profile.
    fn drop(&mut self) {}
}

/// Begins a phase of the program.
pub(super) fn phase(_: &'static str) -> NoPhase {
    NoPhase
}

/// Refuses nothing, because nothing is written.
pub(super) fn check_not_inputs(_: &[PathBuf]) -> Result<(), Failure> {
    Ok(())
}
