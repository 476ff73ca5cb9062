//! Scenes with ghosts, which are drawn over finished pictures alone.

use anyhow::anyhow;

use crate::input::Input;
use crate::terminal::failure::Failure;

/// Refuses a scene with ghosts, for a part of the program that does not draw them.
pub(crate) fn refuse(input: &Input, what: &str) -> Result<(), Failure> {
    if input.scene.ghosts().is_none() {
        return Ok(());
    }
    Err(Failure::Job(anyhow!(
        "{what}: ghosts are drawn over a finished picture, which is not done here; draw these spheres clear, such as with \
         --show 'rest = spacefill, opacity=0.1', or hide them"
    )))
}

/// A note about ghosts that are not drawn or judged.
#[cfg(feature = "gpu")]
pub(crate) fn note(input: &Input, what: &str) -> Option<String> {
    input.scene.ghosts().map(|_| format!("note: ghosts are {what}, as they are drawn over a finished picture"))
}
