//! Reads pictures as the writers of this crate make them: the samples of a PNG or an OpenEXR file as they stand there, and
//! the certificate that the file carries.

#[cfg(feature = "exr")]
mod exr;
mod file;
#[cfg(feature = "png")]
mod png;

pub use file::{FileSamples, PictureFile};

use super::error::LoadError;

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
