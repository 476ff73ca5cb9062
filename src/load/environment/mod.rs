//! Reads environment maps from Radiance HDR and OpenEXR files. The maps are equirectangular, with the zenith at the
//! upper edge.
//!
//! Texels are taken as they are, as linear radiance with the primaries of Rec. 709. Exposures, colour corrections and
//! chromaticities that a file declares are not applied.

use crate::light::environment::Environment;
use crate::load::error::LoadError;

mod decoding;
mod exr;
mod hdr;

pub use decoding::MAX_TEXELS;

/// Reads an environment map; the first bytes of the file show its format.
///
/// From an OpenEXR file, the first part with the channels R, G and B is read.
///
/// # Errors
/// If the file has neither format, is damaged or too large, or if a texel is not a valid radiance.
pub fn read(bytes: &[u8]) -> Result<Environment, LoadError> {
    if bytes.starts_with(b"#?") {
        return hdr::read(bytes);
    }
    if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        return exr::read(bytes);
    }
    Err(LoadError::new(
        "this is neither a Radiance HDR nor an OpenEXR file; convert the image to one of them",
    ))
}
