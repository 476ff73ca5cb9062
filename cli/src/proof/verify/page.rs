//! Makes the page of `pinhole verify --report`: one file that needs no other files. Its script shows the JSON document
//! and the pictures that the page contains.

use std::collections::BTreeMap;
use std::fmt::Display;

use anyhow::{Context, Result};
use rayon::prelude::*;
use serde::Serialize;

use crate::proof::verify::report::{FinalPicture, Report};
use pinhole::LinearRgb;
use pinhole::image::NO_ID;
use pinhole::image::color::to_srgb8;
use pinhole::verify::run_file::Run;
use pinhole::verify::{Certificate, TracedPixel, Verdict};
use pinhole_figure::write::png;

const TEMPLATE: &str = include_str!("page.html");

/// The data that the script of the page reads.
#[derive(Serialize)]
struct Page<'a> {
    report: &'a Report<'a>,
    verdict: String,
    /// Version of the program that made the check.
    checked_by: &'static str,
    /// The run file of the checked recording, if there is one.
    run_file: Option<String>,
    pictures: PagePictures,
    /// The colour of each verdict in its picture.
    colors: BTreeMap<&'static str, String>,
    /// The nearest and the farthest depth, if any sphere is hit.
    depths: Option<[f32; 2]>,
    /// The number of samples of the lit picture.
    shown_samples: Option<u32>,
    /// The factor by which pictures are reduced: a pixel stands for `step` × `step` pixels.
    step: u32,
}

/// The pictures as data URIs.
#[derive(Serialize)]
struct PagePictures {
    color: String,
    depth: String,
    /// `None` if no pixel was judged.
    verdicts: Option<String>,
    light: Option<String>,
}

/// Makes the page. `lit` is the picture with light, and `run_file` the file of the checked recording, if they exist.
pub(crate) fn page(
    run: &Run,
    certificate: &Certificate,
    report: &Report<'_>,
    lit: Option<&FinalPicture>,
    run_file: Option<impl Display>,
) -> Result<String> {
    let blocks = Blocks::new(certificate.size);
    let verdicts = &certificate.verdicts[..];
    let image = &run.recording.image;
    let (color, depth) = (image.color(), image.depth().unwrap_or_default());
    let depths = depths(depth, verdicts);
    let light =
        |lit: &FinalPicture| blocks.drawn(|block| mean(block.map(|i| LinearRgb::from_srgb8(lit.srgb[i]).to_array())));
    let css = |verdict: &Verdict| {
        let [r, g, b] = verdict_color(*verdict);
        (verdict.name(), format!("#{r:02x}{g:02x}{b:02x}"))
    };
    let page = Page {
        report,
        verdict: report.verdict(),
        checked_by: env!("CARGO_PKG_VERSION"),
        run_file: run_file.map(|path| path.to_string()),
        pictures: PagePictures {
            color: blocks.drawn(|block| mean(block.map(|i| color[i])))?,
            // Each block shows its smallest depth.
            depth: blocks.drawn(|block| depth_color(block.map(|i| depth[i]).fold(f32::INFINITY, f32::min), depths))?,
            verdicts: (!verdicts.is_empty())
                .then(|| blocks.drawn(|block| mask_color(block, verdicts, &run.recording.pixels)))
                .transpose()?,
            light: lit.map(light).transpose()?,
        },
        colors: Verdict::ALL.iter().map(css).collect(),
        depths,
        shown_samples: lit.map(|lit| lit.samples),
        step: blocks.step,
    };
    let json = serde_json::to_string(&page).context("the page of the report cannot be made")?;
    Ok(TEMPLATE.replacen("{{data}}", &in_a_script(&json), 1))
}

/// Escapes every `<` in JSON, so that no text in it can end the element `script`.
fn in_a_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

/// Longest side of a picture in the report, in pixels.
const LONGEST: u32 = 2048;

/// Colour of misses in the picture of depths.
const MISS: [u8; 3] = [0xb8, 0xb8, 0xb8];

/// Colour of pixels in which only a hit of a sphere is legal.
const DECIDED_HIT: [u8; 3] = [0xb9, 0xc9, 0xd4];

/// Returns the colour of a verdict. Cold colours are legal, and the warm one is not. The colours also differ in
/// greyscale and for people with red-green colour blindness (after Okabe and Ito).
const fn verdict_color(verdict: Verdict) -> [u8; 3] {
    match verdict {
        Verdict::Decided => [0xe4, 0xeb, 0xef],
        Verdict::Silhouette => [0x00, 0x72, 0xb2],
        Verdict::Tie => [0x56, 0xb4, 0xe9],
        Verdict::Violation => [0xd5, 0x5e, 0x00],
    }
}

/// A picture of the film at a reduced size: `step` × `step` pixels of the film become one pixel.
struct Blocks {
    size: [u32; 2],
    step: u32,
}

impl Blocks {
    fn new(size: [u32; 2]) -> Self {
        Self { size, step: size[0].max(size[1]).div_ceil(LONGEST) }
    }

    fn shown(&self) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(self.step))
    }

    /// Draws a picture, as the data URI of a PNG. `color` gets the indices of the film's pixels in each block.
    fn drawn(&self, color: impl Fn(&mut dyn Iterator<Item = usize>) -> [u8; 3] + Sync) -> Result<String> {
        let [width, height] = self.shown();
        let range = |axis: usize, index: u32| {
            let start = index * self.step;
            start..(start + self.step).min(self.size[axis])
        };
        let row = |j: u32| -> Vec<[u8; 3]> {
            let at = |i: u32, j: u32| j as usize * self.size[0] as usize + i as usize;
            let block = |i: u32| range(1, j).flat_map(move |j| range(0, i).map(move |i| at(i, j)));
            (0..width).map(|i| color(&mut block(i))).collect()
        };
        let rgb = (0..height).into_par_iter().map(row).collect::<Vec<_>>().concat();
        let png = png::encode_rgb8([width, height], rgb.as_flattened())?;
        Ok(format!("data:image/png;base64,{}", data_encoding::BASE64.encode(&png)))
    }
}

/// Returns the mean of linear colours.
fn mean(colors: impl Iterator<Item = [f32; 3]>) -> [u8; 3] {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for color in colors {
        (0..3).for_each(|channel| sum[channel] += f64::from(color[channel]));
        count += 1.0;
    }
    to_srgb8(sum.map(|sum| (sum / count) as f32))
}

/// The smallest and the largest depth, if any sphere is hit. Wrong depths are left out, because they would distort
/// the scale.
fn depths(depth: &[f32], verdicts: &[Verdict]) -> Option<[f32; 2]> {
    let is_wrong = |i: usize| verdicts.get(i) == Some(&Verdict::Violation);
    let depths = depth.iter().enumerate();
    let depths = depths.filter(|(i, depth)| depth.is_finite() && !is_wrong(*i));
    depths.fold(None, |range, (_, depth)| {
        let [least, greatest] = range.unwrap_or([*depth; 2]);
        Some([depth.min(least), depth.max(greatest)])
    })
}

/// The colour of a depth, bright for the nearest and dark for the farthest.
fn depth_color(depth: f32, depths: Option<[f32; 2]>) -> [u8; 3] {
    if !depth.is_finite() {
        return MISS;
    }
    let [least, greatest] = depths.unwrap_or([0.0; 2]).map(f64::from);
    let part = (f64::from(depth) - least) / (greatest - least).max(f64::MIN_POSITIVE);
    let color = colorous::VIRIDIS.eval_continuous(1.0 - part.clamp(0.0, 1.0));
    [color.r, color.g, color.b]
}

/// The colour of the worst verdict of a block, so that violations remain visible at the reduced size.
fn mask_color(block: &mut dyn Iterator<Item = usize>, verdicts: &[Verdict], pixels: &[TracedPixel]) -> [u8; 3] {
    let judged = block.filter_map(|i| {
        let verdict = verdicts.get(i)?;
        let rank = Verdict::ALL.iter().position(|of| of == verdict);
        Some((rank, *verdict, pixels.get(i)?.id != NO_ID))
    });
    match judged.max_by_key(|(rank, _, is_hit)| (*rank, *is_hit)) {
        Some((_, Verdict::Decided, true)) => DECIDED_HIT,
        Some((_, verdict, _)) => verdict_color(verdict),
        None => MISS,
    }
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
        for (size, step, shown) in
            [([1, 1], 1, [1, 1]), ([2048, 3], 1, [2048, 3]), ([4096, 4096], 2, [2048, 2048]), ([4097, 1], 3, [1366, 1])]
        {
            let blocks = Blocks::new(size);
            assert_eq!((blocks.step, blocks.shown()), (step, shown), "{size:?}");
        }
    }
}
