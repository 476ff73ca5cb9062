//! Why the data of a lit picture on the device are not those that were requested.

use crate::verify::upload::UploadError;

/// Why the data on the device are not those that were requested.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LitUploadError {
    /// The camera or the scene's box is wrong.
    #[error(transparent)]
    View(#[from] UploadError),
    /// A list of pixels does not have the size of the rectangle.
    #[error(
        "the recording has a list that does not have {pixels} pixels, the size of its rectangle"
    )]
    Size {
        /// The number of pixels in the rectangle.
        pixels: u64,
    },
    /// A parameter of the lighting is wrong.
    #[error("{what} on the device differs from the settings")]
    Lighting {
        /// The name of the parameter.
        what: &'static str,
    },
    /// An entry of the tables is wrong.
    #[error("{what} {index} on the device differs from the scene and the settings")]
    Table {
        /// The kind of entry.
        what: &'static str,
        /// Index of the entry, from 0.
        index: usize,
    },
}
