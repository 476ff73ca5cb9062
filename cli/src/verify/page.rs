//! Makes the page of `pinhole verify --report`: one file that needs no other files. Its script shows the JSON document and
//! the pictures, which are in it.

use std::collections::BTreeMap;
use std::fmt::Display;

use anyhow::{Context, Result};
use rayon::prelude::*;
use serde::Serialize;

use crate::verify::report::Report;
use pinhole::LinearRgb;
use pinhole::image::NO_ID;
use pinhole::image::color::to_srgb8;
use pinhole::verify::run_file::{Run, ShownPicture};
use pinhole::verify::{Certificate, Verdict};
use pinhole::write::png;

const TEMPLATE: &str = include_str!("page.html");

/// What the script of the page reads.
#[derive(Serialize)]
struct Page<'a> {
    report: &'a Report<'a>,
    verdict: String,
    /// Version of the program that checks.
    checked_by: &'static str,
    /// The run file that holds the checked recording, if there is one.
    run_file: Option<String>,
    pictures: Drawn,
    /// The colours of the verdicts in their picture.
    colors: BTreeMap<&'static str, String>,
    /// The nearest and the farthest depth, if a sphere is hit.
    depths: Option<[f32; 2]>,
    /// The number of samples of the lit picture.
    shown_samples: Option<u32>,
    /// One pixel of the pictures stands for `step` × `step` pixels.
    step: u32,
}

/// The pictures as data URIs.
#[derive(Serialize)]
struct Drawn {
    color: String,
    depth: String,
    /// `None` if no pixel was judged.
    verdicts: Option<String>,
    light: Option<String>,
}

/// Makes the page. `lit` is the picture with light, if there is one. `run_file` is the file that holds the checked recording, if there is one.
pub(crate) fn page(
    run: &Run,
    certificate: &Certificate,
    report: &Report<'_>,
    lit: Option<&ShownPicture>,
    run_file: Option<impl Display>,
) -> Result<String> {
    let pictures = Pictures::new(run, certificate);
    let whole = Window::whole(certificate.size);
    let is_judged = !certificate.verdicts.is_empty();
    let color = |verdict: &Verdict| (verdict.name(), css(verdict_color(*verdict)));
    let page = Page {
        report,
        verdict: report.verdict(),
        checked_by: env!("CARGO_PKG_VERSION"),
        run_file: run_file.map(|path| path.to_string()),
        pictures: Drawn {
            color: pictures.color(whole)?,
            depth: pictures.depth_colors(whole)?,
            verdicts: is_judged.then(|| pictures.mask(whole)).transpose()?,
            light: lit.map(|lit| drawn(lit, whole)).transpose()?,
        },
        colors: Verdict::ALL.iter().map(color).collect(),
        depths: pictures.depths,
        shown_samples: lit.map(|lit| lit.samples),
        step: whole.step,
    };
    let json = serde_json::to_string(&page).context("the page of the report cannot be made")?;
    Ok(TEMPLATE.replacen("{{data}}", &in_a_script(&json), 1))
}

/// The same JSON without any `<`, so that no text in it can end the element `script`.
fn in_a_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

/// Draws the mean colour of each block of pixels.
pub(crate) fn drawn(
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

/// Longest side of a picture in the report, in pixels.
const LONGEST: u32 = 2048;

/// Colour of misses in the picture of depths.
const MISS: [u8; 3] = [0xb8, 0xb8, 0xb8];

/// Colour of pixels in which the hit of a sphere is the only legal answer.
const DECIDED_HIT: [u8; 3] = [0xb9, 0xc9, 0xd4];

/// Returns the colour of a verdict: cold colours are legal, and the warm one is not. The colours also differ in
/// greyscale and for people with red-green colour blindness (after Okabe and Ito).
pub(crate) const fn verdict_color(verdict: Verdict) -> [u8; 3] {
    match verdict {
        Verdict::Decided => [0xe4, 0xeb, 0xef],
        Verdict::Silhouette => [0x00, 0x72, 0xb2],
        Verdict::Tie => [0x56, 0xb4, 0xe9],
        Verdict::Violation => [0xd5, 0x5e, 0x00],
    }
}

/// Formats a colour as `#rrggbb`.
pub(crate) fn css([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A part of the film, drawn at a reduced size: `step` × `step` pixels of the film become one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) size: [u32; 2],
    pub(crate) step: u32,
}

impl Window {
    /// Makes a window of the whole film, reduced in size if it is large.
    pub(crate) fn whole(size: [u32; 2]) -> Self {
        let step = size[0].max(size[1]).div_ceil(LONGEST);
        Self { size, step }
    }

    /// Returns the width and height of the drawn picture.
    pub(crate) fn shown(&self) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(self.step))
    }
}

/// Draws parts of a picture.
pub(crate) struct Pictures<'a> {
    run: &'a Run,
    verdicts: &'a [Verdict],
    width: usize,
    /// The smallest and the largest depth, if any sphere is hit.
    pub(crate) depths: Option<[f32; 2]>,
}

impl<'a> Pictures<'a> {
    pub(crate) fn new(run: &'a Run, certificate: &'a Certificate) -> Self {
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
    pub(crate) fn color(&self, window: Window) -> Result<String> {
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
    pub(crate) fn depth_colors(&self, window: Window) -> Result<String> {
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
    pub(crate) fn mask(&self, window: Window) -> Result<String> {
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
pub(crate) struct Block {
    columns: std::ops::Range<u32>,
    rows: std::ops::Range<u32>,
}

impl Block {
    pub(crate) fn indices(&self, width: usize) -> impl Iterator<Item = usize> {
        let columns = self.columns.clone();
        let in_row = move |row| columns.clone().map(move |i| row as usize * width + i as usize);
        self.rows.clone().flat_map(in_row)
    }
}

/// Draws a window with a colour for each block, as the data URI of a PNG.
pub(crate) fn encoded(
    window: Window,
    color: impl Fn(Block) -> [u8; 3] + Sync + Send,
) -> Result<String> {
    let Window { size, step } = window;
    let [width, height] = window.shown();
    let range = |axis: usize, index: u32| {
        let start = index * step;
        start..(start + step).min(size[axis])
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
    fn no_text_leaves_its_script() {
        let text = "</script><!--<script>&\u{2028}{{data}}";
        let found = in_a_script(&serde_json::to_string(text).unwrap());
        assert!(!found.contains('<'), "{found}");
        assert_eq!(serde_json::from_str::<String>(&found).unwrap(), text);
        assert_eq!(TEMPLATE.matches("{{data}}").count(), 1);
    }

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
