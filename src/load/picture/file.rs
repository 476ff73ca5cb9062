//! A picture as it stands in a file, and why it cannot be read.

use crate::image::encoding::Bits;
use crate::load::error::LoadError;
use crate::text::one_line;

/// A picture as it stands in a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PictureFile {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The samples, row by row from the top.
    pub samples: FileSamples,
    /// The text of the certificate, if the file carries one.
    pub certificate: Option<String>,
}

/// The samples of a picture in a file.
#[derive(Clone, Debug, PartialEq)]
pub enum FileSamples {
    /// Those of a PNG: RGB, or RGBA, each of one byte or of two with the higher first.
    Encoded {
        /// The bits of each sample.
        bits: Bits,
        /// Whether there is an alpha channel.
        has_alpha: bool,
        /// The samples.
        bytes: Vec<u8>,
    },
    /// Those of an OpenEXR file: red, green, blue and alpha.
    Linear(Vec<[f32; 4]>),
}

pub(super) fn damaged(format: &str, error: &impl ToString) -> LoadError {
    let message = one_line(&error.to_string());
    LoadError::new(format!("the {format} file cannot be read: {message}"))
}

pub(super) fn no_memory(width: usize, height: usize) -> LoadError {
    LoadError::new(format!("there is not enough memory for a picture of {width}x{height} pixels"))
}
