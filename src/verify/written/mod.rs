//! Judges pictures as they are in files: whether a conforming device may have produced every sample.
//!
//! A file has no rays, depths or normals. So a pixel is judged against all rays together that a device may compute for
//! it (`verify/camera/entered.rs`), the spheres that these rays may hit, the normals that the kernel may find there,
//! and the colours that follow. An interval of colours becomes an interval of samples, because the host computes
//! exposure, tone curve and the transfer function of sRGB in the same way everywhere. In pictures with 8 bits, this
//! interval contains one or two samples for most pixels.
//!
//! This judges pictures of [`Integrator::Primary`](crate::Integrator::Primary). All pictures are compared with the exact
//! one by [`finished`](super::finished).

mod samples;

use std::fmt;

pub use samples::{Samples, WrittenError, WrittenPicture};

use samples::{LegalColor, LegalSample, PictureCheck};

use super::certificate::{KEPT, Outcome, Verdict, channel_name};
use super::checker::Checker;
use crate::camera::View;
use crate::parallel;
use crate::recording::pixel_at;
use crate::render::PrimarySettings;
use crate::verify::rounding::Interval;

/// A pixel that no conforming device may have produced.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct WrittenViolation {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// The first channel that is not legal, from 0 for red to 3 for alpha.
    pub channel: usize,
    /// The sample.
    pub found: f64,
    /// The least and the greatest legal sample.
    pub legal: [f64; 2],
}

impl fmt::Display for WrittenViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixel: [i, j], channel, found, legal: [low, high] } = self;
        let name = channel_name(*channel);
        write!(f, "pixel ({i}, {j}): {name} is {found}, but ")?;
        if low >= high { write!(f, "{low} is expected") } else { write!(f, "{low} to {high} are legal") }
    }
}

/// Whether a conforming device may have produced a picture in a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct WrittenCertificate {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The verdict about every pixel, row by row from the top.
    pub verdicts: Vec<Verdict>,
    /// The first violations, in the order of pixels.
    pub violations: Vec<WrittenViolation>,
}

impl WrittenCertificate {
    /// The number of pixels with a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        verdict.count(&self.verdicts)
    }

    /// The number of pixels for which several answers are legal. The picture shows one of them.
    #[must_use]
    pub fn undecided(&self) -> usize {
        Verdict::undecided(&self.verdicts)
    }

    /// The outcome of the picture.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let all = self.verdicts.len() as u64;
        Outcome::of(!self.violations.is_empty(), self.undecided() as u64, all)
    }
}

impl Checker<'_> {
    /// The colours that a conforming device may have for some pixels, by their indices, and their alpha: everything
    /// between the colours of all legal answers.
    pub(super) fn legal_colors(
        &self,
        view: &View<'_>,
        primary: &PrimarySettings,
        indices: &[usize],
    ) -> Vec<Option<[Interval; 4]>> {
        let check = PictureCheck::new(self, view, primary);
        let legal = |index: &usize| {
            let (_, colors) = check.legal(pixel_at(*index, view.film.width()));
            let channels = |color: &LegalColor| {
                let [r, g, b] = color.color;
                let alpha = if color.is_hit || !primary.is_transparent { 1.0 } else { 0.0 };
                [r, g, b, Interval { low: alpha, high: alpha }]
            };
            let join = |a: [Interval; 4], b: [Interval; 4]| [0, 1, 2, 3].map(|c| a[c].union(b[c]));
            colors.iter().map(channels).reduce(join)
        };
        indices.iter().map(legal).collect()
    }

    /// Judges every sample of a picture of primary rays, as it is in its file.
    ///
    /// # Errors
    /// Returns an error if the picture is not as large as the view, or has another number of samples.
    pub fn certify_written(
        &self,
        view: &View<'_>,
        primary: &PrimarySettings,
        picture: &WrittenPicture<'_>,
    ) -> Result<WrittenCertificate, WrittenError> {
        let size = [view.film.width(), view.film.height()];
        picture.check(size)?;
        let check = PictureCheck::new(self, view, primary);
        let judge = |index: usize| {
            let pixel = pixel_at(index, size[0]);
            let (verdict, colors) = check.legal(pixel);
            let allowed: Vec<_> = colors.iter().map(|color| picture.legal(color, primary.is_transparent)).collect();
            let found = picture.at(index);
            match LegalSample::judge(&allowed, &found) {
                None => Ok(verdict),
                Some((channel, legal)) => Err(WrittenViolation { pixel, channel, found: found[channel], legal }),
            }
        };
        let count = size[0] as usize * size[1] as usize;
        let verdicts = parallel::map(count, |index| judge(index).unwrap_or(Verdict::Violation));
        // The few violations that are kept are found again, so that other pixels need no memory for one.
        let illegal = (0..count).filter(|index| verdicts[*index] == Verdict::Violation);
        let violations = illegal.take(KEPT).filter_map(|index| judge(index).err()).collect();
        Ok(WrittenCertificate { size, verdicts, violations })
    }
}
