//! Reads environments from Radiance HDR and OpenEXR files: equirectangular maps, whose upper edge is up.
//!
//! Numbers are taken as they are, as linear radiance with the primaries of Rec. 709: exposures, colour corrections
//! and chromaticities that a file declares are not applied.

use std::cell::Cell;
use std::io::{Cursor, Read, Seek, SeekFrom};

use crate::light::environment::{Environment, EnvironmentError};

#[cfg(feature = "exr")]
mod exr;
#[cfg(feature = "hdr")]
mod hdr;

/// The most texels of a file: 16,384 × 8192.
pub const MAX_TEXELS: u64 = 1 << 27;

/// Why a file is no environment.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentFileError {
    /// It begins with neither signature.
    #[error("this is no image of light; it begins neither as Radiance HDR nor as OpenEXR does")]
    Unknown,
    /// It is in a format that this build does not read.
    #[error(
        "this is an {format} file, and this build has no reader for it; it needs the feature `{feature}`"
    )]
    NotBuilt {
        /// The format.
        format: &'static str,
        /// The feature of this crate that reads it.
        feature: &'static str,
    },
    /// The file ends before the image does.
    #[error("the {format} file is incomplete: it ends after {bytes} bytes, before the image does")]
    Truncated {
        /// The format.
        format: &'static str,
        /// How long the file is.
        bytes: usize,
    },
    /// The decoder does not understand it.
    #[error("the {format} file is damaged, or of a kind that cannot be read: {message}")]
    Format {
        /// The format.
        format: &'static str,
        /// The decoder's reason.
        message: String,
    },
    /// There is no colour in it.
    #[error(
        "no part of the OpenEXR file has the channels R, G and B; the first has {}",
        if found.is_empty() { "none" } else { found }
    )]
    Channels {
        /// The channels of the first part.
        found: String,
    },
    /// It has more texels than [`MAX_TEXELS`].
    #[error("{width}×{height} texels are too many; the most are {MAX_TEXELS}")]
    TooLarge {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
    },
    /// There is no memory for it.
    #[error("there is no memory for {texels} texels")]
    Memory {
        /// How many.
        texels: u64,
    },
    /// Its texels are no radiance.
    #[error(transparent)]
    Environment(#[from] EnvironmentError),
}

/// Reads an environment; its first bytes tell the format.
///
/// Of an OpenEXR file, the first part with the channels R, G and B is read.
///
/// # Errors
/// If the file is of neither format, damaged or too large, or if a texel is no radiance.
pub fn read(bytes: &[u8]) -> Result<Environment, EnvironmentFileError> {
    if bytes.starts_with(b"#?") {
        #[cfg(feature = "hdr")]
        return hdr::read(bytes);
        #[cfg(not(feature = "hdr"))]
        return Err(EnvironmentFileError::NotBuilt { format: "Radiance HDR", feature: "hdr" });
    }
    if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        #[cfg(feature = "exr")]
        return exr::read(bytes);
        #[cfg(not(feature = "exr"))]
        return Err(EnvironmentFileError::NotBuilt { format: "OpenEXR", feature: "exr" });
    }
    Err(EnvironmentFileError::Unknown)
}

/// How many texels a byte of a file may stand for, and a small file without any. The formats' own best is less:
/// 172 for deflate, of three halves a texel, and some 1,400 for long runs in Radiance's oldest encoding.
const TEXELS_PER_BYTE: u64 = 2048;
const SMALL: u64 = 1 << 20;

/// Room for an image, black; not for more than such a file can have, which may say anything.
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

/// A file that remembers whether more was read than it has. Decoders report that in many ways.
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

/// What a decoder says when it gives up.
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
