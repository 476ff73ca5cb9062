//! Draws the pictures of a report: colours, depths and verdicts of a recording.

use anyhow::Result;

use pinhole::image::NO_ID;
use pinhole::image::color::to_srgb8;
use pinhole::verify::run_file::Run;
use pinhole::verify::{Certificate, Verdict};
use pinhole::write::png;
use rayon::prelude::*;

/// Longest side of a picture in the report, in pixels.
const LONGEST: u32 = 2048;

/// Colour of misses in the picture of depths.
const MISS: [u8; 3] = [0xb8, 0xb8, 0xb8];

/// Colour of pixels in which the hit of a sphere is the only legal answer.
const DECIDED_HIT: [u8; 3] = [0xb9, 0xc9, 0xd4];

/// Returns the colour of a verdict: cold colours are legal, and the warm one is not. The colours also differ in
/// greyscale and for people with red-green colour blindness (after Okabe and Ito).
pub(super) const fn verdict_color(verdict: Verdict) -> [u8; 3] {
    match verdict {
        Verdict::Decided => [0xe4, 0xeb, 0xef],
        Verdict::Silhouette => [0x00, 0x72, 0xb2],
        Verdict::Tie => [0x56, 0xb4, 0xe9],
        Verdict::Violation => [0xd5, 0x5e, 0x00],
    }
}

/// Formats a colour as `#rrggbb`.
pub(super) fn css([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A part of the film, drawn at a reduced size: `step` × `step` pixels of the film become one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Window {
    pub(super) first: [u32; 2],
    pub(super) size: [u32; 2],
    pub(super) step: u32,
}

impl Window {
    /// Makes a window of the whole film, reduced in size if it is large.
    pub(super) fn whole(size: [u32; 2]) -> Self {
        let step = size[0].max(size[1]).div_ceil(LONGEST);
        Self { first: [0, 0], size, step }
    }

    /// Returns the width and height of the drawn picture.
    pub(super) fn shown(&self) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(self.step))
    }
}

/// Draws parts of a picture.
pub(super) struct Pictures<'a> {
    run: &'a Run,
    verdicts: &'a [Verdict],
    width: usize,
    /// The smallest and the largest depth, if any sphere is hit.
    pub(super) depths: Option<[f32; 2]>,
}

impl<'a> Pictures<'a> {
    pub(super) fn new(run: &'a Run, certificate: &'a Certificate) -> Self {
        let verdicts = &certificate.verdicts[..];
        let width = run.recording.film.width() as usize;
        let mut pictures = Self { run, verdicts, width, depths: None };
        // Wrong depths are left out, because they would spoil the scale.
        let is_wrong = |i: usize| verdicts.get(i) == Some(&Verdict::Violation);
        let depths = pictures.depth().iter().enumerate();
        let depths = depths.filter(|(i, depth)| depth.is_finite() && !is_wrong(*i));
        pictures.depths = depths.fold(None, |range, (_, depth)| {
            let [least, greatest] = range.unwrap_or([*depth; 2]);
            Some([depth.min(least), depth.max(greatest)])
        });
        pictures
    }

    fn depth(&self) -> &'a [f32] {
        self.run.recording.image.depth().unwrap_or_default()
    }

    /// Draws the mean colour of each block of pixels.
    pub(super) fn color(&self, window: Window) -> Result<String> {
        let color = self.run.recording.image.color();
        encoded(window, |pixels| {
            let mut sum = [0.0; 3];
            let mut count = 0.0;
            for i in pixels.indices(self.width) {
                (0..3).for_each(|channel| sum[channel] += f64::from(color[i][channel]));
                count += 1.0;
            }
            to_srgb8(sum.map(|sum| (sum / count) as f32))
        })
    }

    /// Draws the smallest depth of each block of pixels.
    pub(super) fn depth_colors(&self, window: Window) -> Result<String> {
        let depth = self.depth();
        let [least, greatest] = self.depths.unwrap_or([0.0; 2]);
        encoded(window, |pixels| {
            let found = pixels.indices(self.width).map(|i| depth[i]);
            let nearest = found.fold(f32::INFINITY, f32::min);
            if nearest.is_finite() {
                let range = f64::from(greatest) - f64::from(least);
                let part = (f64::from(nearest) - f64::from(least)) / range.max(f64::MIN_POSITIVE);
                depth_color(part)
            } else {
                MISS
            }
        })
    }

    /// Draws the worst verdict of each block of pixels, so that no violation is lost where the size is reduced.
    pub(super) fn mask(&self, window: Window) -> Result<String> {
        let pixels = &self.run.recording.pixels;
        encoded(window, |block| {
            let judged = block.indices(self.width).filter_map(|i| {
                let verdict = self.verdicts.get(i)?;
                let rank = Verdict::ALL.iter().position(|of| of == verdict);
                Some((rank, *verdict, pixels.get(i)?.id != NO_ID))
            });
            match judged.max_by_key(|(rank, _, is_hit)| (*rank, *is_hit)) {
                Some((_, Verdict::Decided, true)) => DECIDED_HIT,
                Some((_, verdict, _)) => verdict_color(verdict),
                None => MISS,
            }
        })
    }
}

/// Returns the colour of a depth from 0 (nearest, bright) to 1 (farthest, dark).
fn depth_color(part: f64) -> [u8; 3] {
    let color = colorous::VIRIDIS.eval_continuous(1.0 - part.clamp(0.0, 1.0));
    [color.r, color.g, color.b]
}

/// The pixels of the film that become one pixel.
pub(super) struct Block {
    columns: std::ops::Range<u32>,
    rows: std::ops::Range<u32>,
}

impl Block {
    pub(super) fn indices(&self, width: usize) -> impl Iterator<Item = usize> {
        let columns = self.columns.clone();
        let in_row = move |row| columns.clone().map(move |i| row as usize * width + i as usize);
        self.rows.clone().flat_map(in_row)
    }
}

/// Draws a window with a colour for each block, as the data URI of a PNG.
pub(super) fn encoded(
    window: Window,
    color: impl Fn(Block) -> [u8; 3] + Sync + Send,
) -> Result<String> {
    let Window { first, size, step } = window;
    let [width, height] = window.shown();
    let range = |axis: usize, index: u32| {
        let start = index * step;
        first[axis] + start..first[axis] + (start + step).min(size[axis])
    };
    let row = |j: usize| -> Vec<[u8; 3]> {
        // The height is a u32, so its rows are too.
        let rows = range(1, j as u32);
        (0..width).map(|i| color(Block { columns: range(0, i), rows: rows.clone() })).collect()
    };
    let rgb = (0..height as usize).into_par_iter().map(row).collect::<Vec<_>>().concat();
    let png = png::encode_rgb8([width, height], rgb.as_flattened())?;
    Ok(format!("data:image/png;base64,{}", data_encoding::BASE64.encode(&png)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_are_made_smaller() {
        for (size, step, shown) in [
            ([1, 1], 1, [1, 1]),
            ([2048, 3], 1, [2048, 3]),
            ([4096, 4096], 2, [2048, 2048]),
            ([4097, 1], 3, [1366, 1]),
        ] {
            let window = Window::whole(size);
            assert_eq!((window.step, window.shown()), (step, shown), "{size:?}");
        }
    }
}
