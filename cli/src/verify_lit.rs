//! The lit picture of a scene in the report of `pinhole verify`. It is not checked.

use anyhow::Result;

use super::verify_pictures::{Window, encoded};
use pinhole::LinearRgb;
use pinhole::image::color::to_srgb8;
use pinhole::verify::run_file::ShownPicture;

#[cfg(feature = "gpu")]
mod rendered;

#[cfg(feature = "gpu")]
pub(super) use rendered::render;

/// Draws the mean colour of each block of pixels.
pub(super) fn drawn(
    ShownPicture { size, srgb, .. }: &ShownPicture,
    window: Window,
) -> Result<String> {
    let width = size[0] as usize;
    encoded(window, |pixels| {
        let mut sum = [0.0; 3];
        let mut count = 0.0;
        for i in pixels.indices(width) {
            let color = LinearRgb::from_srgb8(srgb[i]).to_array();
            (0..3).for_each(|channel| sum[channel] += f64::from(color[channel]));
            count += 1.0;
        }
        to_srgb8(sum.map(|sum| (sum / count) as f32))
    })
}
