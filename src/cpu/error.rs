//! Why no picture is rendered.

use crate::image::ImageTooLarge;
use crate::render::SettingsError;

/// Why no picture is rendered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The settings, or the materials of the scene, are not valid.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// There is not enough memory for the image.
    #[error(transparent)]
    Image(#[from] ImageTooLarge),
    /// The caller ended the work.
    #[error("rendering was stopped")]
    Stopped,
}
