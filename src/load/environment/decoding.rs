//! What the decoders of images have in common: files that notice their end, room for texels, and errors.

use std::cell::Cell;
use std::io::{Cursor, Read, Seek, SeekFrom};

use crate::load::error::{LoadError, LoadErrorKind};

/// The largest number of texels that a file may have: 16,384 × 8192.
pub const MAX_TEXELS: u64 = 1 << 27;

fn cut_off(format: &str, bytes: usize) -> LoadError {
    let message = format!(
        "the {format} file is incomplete: it ends after {bytes} bytes, before its image does"
    );
    LoadError::new(message).of_kind(LoadErrorKind::CutOff)
}

/// The decoder cannot read the file.
pub(super) fn damaged(format: &str, message: &str) -> LoadError {
    LoadError::new(format!(
        "the {format} file is damaged or of a kind that cannot be read: {message}"
    ))
}

/// Limit on the number of texels that a file may declare for each of its bytes. What the formats can reach is less:
/// 172 with deflate, at three halves per texel, and about 1,400 with long runs in Radiance's oldest encoding.
const TEXELS_PER_BYTE: u64 = 2048;

/// Number of texels that a file of any length may declare.
const SMALL: u64 = 1 << 20;

/// Allocates a black image. Its size comes from a header that may be wrong, so a size that a file of `bytes` bytes
/// cannot hold is refused.
pub(super) fn black(
    [width, height]: [u64; 2],
    format: &'static str,
    bytes: usize,
) -> Result<Vec<[f32; 3]>, LoadError> {
    let texels = width.saturating_mul(height);
    if texels > MAX_TEXELS {
        return Err(LoadError::new(format!(
            "the image has {width}×{height} texels, more than the limit of {MAX_TEXELS}; use a smaller image"
        )));
    }
    if texels > SMALL.max(TEXELS_PER_BYTE.saturating_mul(bytes as u64)) {
        return Err(cut_off(format, bytes));
    }
    let mut room = Vec::new();
    room.try_reserve_exact(texels as usize).map_err(|_| {
        LoadError::new(format!(
            "there is not enough memory for {texels} texels; use a smaller image"
        ))
    })?;
    room.resize(texels as usize, [0.0; 3]);
    Ok(room)
}

/// A file in memory that remembers whether a decoder tried to read beyond its end. Each decoder reports that in its
/// own way.
pub(super) struct Watched<'a> {
    bytes: Cursor<&'a [u8]>,
    at_end: &'a Cell<bool>,
}

impl<'a> Watched<'a> {
    pub(super) fn new(bytes: &'a [u8], at_end: &'a Cell<bool>) -> Self {
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
pub(super) fn refusal(
    format: &'static str,
    bytes: &[u8],
    at_end: &Cell<bool>,
    message: &impl ToString,
) -> LoadError {
    if at_end.get() {
        return cut_off(format, bytes.len());
    }
    damaged(format, &crate::text::one_line(&message.to_string()))
}
