//! Reads environment maps from Radiance HDR files: G. Ward, "Real Pixels", Graphics Gems II, 1991.

use std::cell::Cell;

use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;

use super::decoding::{Watched, black, damaged, refusal};
use crate::light::environment::Environment;
use crate::load::error::LoadError;

const FORMAT: &str = "Radiance HDR";

pub(super) fn read(bytes: &[u8]) -> Result<Environment, LoadError> {
    let at_end = Cell::new(false);
    let refused = |error| refusal(FORMAT, bytes, &at_end, &error);
    if has_empty_runs(bytes) {
        return Err(damaged(FORMAT, "it has several empty runs of pixels in a row"));
    }
    // Not strict: the signature may be `#?RGBE` as well, and headers have lines of all kinds.
    let decoder =
        HdrDecoder::with_strictness(Watched::new(bytes, &at_end), false).map_err(refused)?;
    let (width, height) = decoder.dimensions();
    let mut texels = black([width, height].map(u64::from), FORMAT, bytes.len())?;
    decoder.read_image(bytemuck::cast_slice_mut(&mut texels)).map_err(refused)?;
    Environment::new(width, height, texels).map_err(|error| LoadError::new(error.to_string()))
}

/// Whether the file has eight run markers in a row of which the last four are empty. No encoder writes that, and the
/// decoder's multiplier for such a run overflows (image 0.25.10).
fn has_empty_runs(bytes: &[u8]) -> bool {
    const MARKER: usize = 4;
    let is_marker = |marker: &[u8]| marker[..3] == [1, 1, 1];
    bytes.windows(8 * MARKER).any(|run| {
        // The rarest condition is tested first.
        run.ends_with(&[1, 1, 1, 0])
            && run.chunks(MARKER).all(is_marker)
            && run[4 * MARKER..].chunks(MARKER).all(|marker| marker[3] == 0)
    })
}
