//! The reason why data make no scene.

use crate::color_by::ColorByError;
use pinhole::scene::SceneError;
use pinhole_data::added::AddError;
use pinhole_data::replicate::ReplicateError;
use pinhole_data::select::SelectError;

/// The reason why the keys of a scene file and its data do not make a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// The selection does not apply to the data.
    #[error("`select`: {0}")]
    Select(#[from] SelectError),
    /// A selection of a rule for what is drawn does not apply to the data.
    #[error("`show`: {0}")]
    Show(SelectError),
    /// The data has no cell that can be repeated.
    #[error("`replicate`: {0}")]
    Replicate(ReplicateError),
    /// The selection of what a camera frames does not apply to the data, or selects nothing.
    #[error("`focus`: {0}")]
    Focus(SelectError),
    /// Bonds, the edges of the cell or arrows cannot be added.
    #[error(transparent)]
    Add(#[from] AddError),
    /// A column cannot decide what it should.
    #[error(transparent)]
    ColorBy(#[from] ColorByError),
    /// The data has no text column that a key of the scene file names.
    #[error("{0}")]
    NoColumn(String),
    /// A sphere of the scene is out of range.
    #[error(transparent)]
    Scene(#[from] SceneError),
}
