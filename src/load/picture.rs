//! Reads pictures as the writers of this crate make them: the samples of a PNG or an OpenEXR file as they stand there, and
//! the certificate that the file carries.

#[cfg(feature = "exr")]
mod exr;
#[cfg(feature = "png")]
mod png;

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

/// Why a file is not a picture that can be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PictureFileError {
    /// The file has another format.
    #[error("this is neither a PNG nor an OpenEXR file; pictures of `pinhole render` are")]
    Format,
    /// The file is damaged.
    #[error("the {format} file cannot be read: {message}")]
    Damaged {
        /// Name of the format.
        format: &'static str,
        /// What is wrong.
        message: String,
    },
    /// The picture is not one that this crate writes.
    #[error("the {format} file has {found}; this crate writes {written}")]
    Kind {
        /// Name of the format.
        format: &'static str,
        /// What was found.
        found: String,
        /// What would be right.
        written: &'static str,
    },
    /// There is not enough memory.
    #[error("there is not enough memory for a picture of {width}x{height} pixels")]
    Memory {
        /// Width in pixels.
        width: u64,
        /// Height in pixels.
        height: u64,
    },
}

/// Reads a picture from the bytes of its file.
///
/// # Errors
/// Returns an error if the file is neither a PNG nor an OpenEXR file, is damaged, or is of a kind that this crate does
/// not write.
pub fn read(bytes: &[u8]) -> Result<PictureFile, PictureFileError> {
    match bytes {
        #[cfg(feature = "png")]
        [0x89, b'P', b'N', b'G', ..] => png::read(bytes),
        #[cfg(feature = "exr")]
        [0x76, 0x2f, 0x31, 0x01, ..] => exr::read(bytes),
        _ => Err(PictureFileError::Format),
    }
}

fn damaged(format: &'static str, error: &impl ToString) -> PictureFileError {
    PictureFileError::Damaged { format, message: one_line(&error.to_string()) }
}
