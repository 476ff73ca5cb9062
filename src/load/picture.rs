//! Reads pictures as the writers of this crate make them: the samples of a PNG or an OpenEXR file as they stand there, and
//! the certificate that the file carries.

#[cfg(feature = "exr")]
mod exr;
#[cfg(feature = "png")]
mod png;

use super::error::LoadError;
use crate::image::encoding::Bits;
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

/// Reads a picture from the bytes of its file.
///
/// # Errors
/// Returns an error if the file is neither a PNG nor an OpenEXR file, is damaged, or is of a kind that this crate does
/// not write.
pub fn read(bytes: &[u8]) -> Result<PictureFile, LoadError> {
    match bytes {
        #[cfg(feature = "png")]
        [0x89, b'P', b'N', b'G', ..] => png::read(bytes),
        #[cfg(feature = "exr")]
        [0x76, 0x2f, 0x31, 0x01, ..] => exr::read(bytes),
        _ => Err(LoadError::new(
            "this is neither a PNG nor an OpenEXR file; pictures of `pinhole render` are",
        )),
    }
}

fn damaged(format: &str, error: &impl ToString) -> LoadError {
    let message = one_line(&error.to_string());
    LoadError::new(format!("the {format} file cannot be read: {message}"))
}

fn no_memory(width: usize, height: usize) -> LoadError {
    LoadError::new(format!("there is not enough memory for a picture of {width}x{height} pixels"))
}
