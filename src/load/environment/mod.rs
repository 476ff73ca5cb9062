//! Reads environment maps from Radiance HDR and OpenEXR files. The maps are equirectangular, with the zenith at the
//! upper edge.
//!
//! Texels are taken as they are, as linear radiance with the primaries of Rec. 709. Exposures, colour corrections and
//! chromaticities that a file declares are not applied.

use std::cell::Cell;
use std::io::{Cursor, Read, Seek, SeekFrom};

use crate::light::environment::{Environment, EnvironmentError};

mod exr;
mod hdr;

/// The largest number of texels that a file may have: 16,384 × 8192.
pub const MAX_TEXELS: u64 = 1 << 27;

/// An error of reading an environment map.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentFileError {
    /// The file begins with the signature of neither format.
    #[error("this is neither a Radiance HDR nor an OpenEXR file; convert the image to one of them")]
    Unknown,
    /// The file ends before the image does.
    #[error("the {format} file is incomplete: it ends after {bytes} bytes, before its image does")]
    Truncated {
        /// Name of the format.
        format: &'static str,
        /// Length of the file in bytes.
        bytes: usize,
    },
    /// The decoder cannot read the file.
    #[error("the {format} file is damaged or of a kind that cannot be read: {message}")]
    Format {
        /// Name of the format.
        format: &'static str,
        /// The decoder's reason.
        message: String,
    },
    /// The file has no colours.
    #[error(
        "no part of the OpenEXR file has the channels R, G and B, which are needed; the first part has {}",
        if found.is_empty() { "no channels" } else { found }
    )]
    Channels {
        /// Names of the channels of the first part.
        found: String,
    },
    /// The map has more texels than [`MAX_TEXELS`].
    #[error(
        "the image has {width}×{height} texels, more than the limit of {MAX_TEXELS}; use a smaller image"
    )]
    TooLarge {
        /// Number of columns.
        width: u64,
        /// Number of rows.
        height: u64,
    },
    /// There is not enough memory for the map.
    #[error("there is not enough memory for {texels} texels; use a smaller image")]
    Memory {
        /// Number of texels.
        texels: u64,
    },
    /// The size of the map or one of its texels is not valid.
    #[error(transparent)]
    Environment(#[from] EnvironmentError),
}

/// Reads an environment map; the first bytes of the file show its format.
///
/// From an OpenEXR file, the first part with the channels R, G and B is read.
///
/// # Errors
/// If the file has neither format, is damaged or too large, or if a texel is not a valid radiance.
pub fn read(bytes: &[u8]) -> Result<Environment, EnvironmentFileError> {
    if bytes.starts_with(b"#?") {
        return hdr::read(bytes);
    }
    if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        return exr::read(bytes);
    }
    Err(EnvironmentFileError::Unknown)
}

/// Limit on the number of texels that a file may declare for each of its bytes. What the formats can reach is less:
/// 172 with deflate, at three halves per texel, and about 1,400 with long runs in Radiance's oldest encoding.
const TEXELS_PER_BYTE: u64 = 2048;

/// Number of texels that a file of any length may declare.
const SMALL: u64 = 1 << 20;

/// Allocates a black image. Its size comes from a header that may be wrong, so a size that a file of `bytes` bytes
/// cannot hold is refused.
fn black(
    [width, height]: [u64; 2],
    format: &'static str,
    bytes: usize,
) -> Result<Vec<[f32; 3]>, EnvironmentFileError> {
    let texels = width.saturating_mul(height);
    if texels > MAX_TEXELS {
        return Err(EnvironmentFileError::TooLarge { width, height });
    }
    if texels > SMALL.max(TEXELS_PER_BYTE.saturating_mul(bytes as u64)) {
        return Err(EnvironmentFileError::Truncated { format, bytes });
    }
    let mut room = Vec::new();
    room.try_reserve_exact(texels as usize).map_err(|_| EnvironmentFileError::Memory { texels })?;
    room.resize(texels as usize, [0.0; 3]);
    Ok(room)
}

/// A file in memory that remembers whether a decoder tried to read beyond its end. Each decoder reports that in its
/// own way.
struct Watched<'a> {
    bytes: Cursor<&'a [u8]>,
    at_end: &'a Cell<bool>,
}

impl<'a> Watched<'a> {
    fn new(bytes: &'a [u8], at_end: &'a Cell<bool>) -> Self {
        Self { bytes: Cursor::new(bytes), at_end }
    }
}

impl Read for Watched<'_> {
    fn read(&mut self, target: &mut [u8]) -> std::io::Result<usize> {
        let count = self.bytes.read(target)?;
        if count < target.len() {
            self.at_end.set(true);
        }
        Ok(count)
    }
}

impl Seek for Watched<'_> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.bytes.seek(to)
    }
}

/// Returns the error for a decoder that gave up, with its message.
fn refusal(
    format: &'static str,
    bytes: &[u8],
    at_end: &Cell<bool>,
    message: &impl ToString,
) -> EnvironmentFileError {
    if at_end.get() {
        return EnvironmentFileError::Truncated { format, bytes: bytes.len() };
    }
    let message = crate::text::one_line(&message.to_string());
    EnvironmentFileError::Format { format, message }
}
