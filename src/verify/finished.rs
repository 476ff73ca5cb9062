//! Judges finished pictures as they are in files, pixel by pixel, against the picture that exact arithmetic gives.
//!
//! The random numbers of a picture follow from its seed. So the f64 reference takes the very samples of the device, and
//! the same code finishes both: it removes noise, draws lines and annotations, and encodes. What rounding changes within
//! a pixel is mostly less than a step of the file, so that almost every pixel of a correct device *equals* the exact
//! one. Where a ray passes an edge, rounding may decide otherwise, and a pixel differs. Such a pixel is legal if an
//! interval of legal samples contains it ([`written`](super::written), for one ray through each pixel without lines and
//! annotations). For other pictures there are no intervals: a pixel that differs stays open, and the picture undecided.

use super::certificate::{CHUNK, KEPT, Outcome, channel_name};
use super::written::{WrittenError, WrittenPicture, WrittenViolation};
use crate::camera::View;
use crate::parallel::{map_parts, ranges};
use crate::recording::pixel_at;
use crate::render::RenderSettings;
use crate::verify::{Checker, Verdict};

/// The least share of exact pixels in a picture that is proved.
pub const LEAST_EXACT: f64 = 0.99;

/// The verdict about a pixel of a finished picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PixelVerdict {
    /// It is what exact arithmetic gives, to the resolution of the file.
    Exact,
    /// It is another value to which rounding may lead.
    Legal,
    /// It differs, and nothing says whether rounding may lead there.
    Open,
    /// Rounding cannot lead there.
    Violated,
}

impl PixelVerdict {
    /// All verdicts, in the order of reports.
    pub const ALL: &'static [Self] = &[Self::Exact, Self::Legal, Self::Open, Self::Violated];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Legal => "legal",
            Self::Open => "open",
            Self::Violated => "violated",
        }
    }
}

/// A pixel that differs from the exact one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PixelDifference {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// The first channel that differs, from 0 for red to 3 for alpha.
    pub channel: usize,
    /// The sample.
    pub found: f64,
    /// The exact sample.
    pub exact: f64,
}

impl std::fmt::Display for PixelDifference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { pixel: [i, j], channel, found, exact } = self;
        write!(f, "pixel ({i}, {j}): {} is {found}, and the exact one {exact}", channel_name(*channel))
    }
}

/// The verdicts about all pixels of a picture in a file.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FinishedCertificate {
    /// The verdict about every pixel, row by row from the top.
    pub verdicts: Vec<PixelVerdict>,
    /// The first violations, in the order of pixels.
    pub violations: Vec<WrittenViolation>,
    /// The first pixels that are open, in the order of pixels.
    pub open: Vec<PixelDifference>,
}

impl FinishedCertificate {
    /// The number of pixels with a verdict.
    #[must_use]
    pub fn count(&self, verdict: PixelVerdict) -> usize {
        self.verdicts.iter().filter(|other| **other == verdict).count()
    }

    /// The outcome: proved if at least [`LEAST_EXACT`] of all pixels are exact and all others legal.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let [exact, _, open, violated] = [0, 1, 2, 3].map(|index| self.count(PixelVerdict::ALL[index]));
        match (violated, open) {
            (0, 0) if exact > 0 && exact as f64 >= LEAST_EXACT * self.verdicts.len() as f64 => Outcome::Proved,
            (0, _) => Outcome::Undecided,
            _ => Outcome::Violated,
        }
    }
}

impl Checker<'_> {
    /// Judges every pixel of a finished picture. `exact` is the picture of the CPU reference with the same settings,
    /// finished and encoded by the same code. `is_annotated` says whether something is drawn over both.
    ///
    /// # Errors
    /// Returns an error if a picture is not as large as the view, or has another number of samples.
    pub fn certify_finished(
        &self,
        view: &View<'_>,
        settings: &RenderSettings,
        [picture, exact]: [&WrittenPicture<'_>; 2],
        is_annotated: bool,
    ) -> Result<FinishedCertificate, WrittenError> {
        let size = exact.size;
        picture.check(size)?;
        exact.check(size)?;
        let has_intervals = !is_annotated && size == [view.film.width(), view.film.height()];
        let by_intervals = settings.primary().filter(|_| has_intervals);
        let legal = by_intervals.map(|primary| self.certify_written(view, &primary, picture)).transpose()?;
        let count = size[0] as usize * size[1] as usize;
        let parts = map_parts(ranges(count, CHUNK), |range| {
            let mut part = FinishedCertificate::default();
            for index in range {
                let difference = picture.difference(exact, index);
                let legal = legal.as_ref().map(|legal| legal.verdicts[index]);
                part.verdicts.push(match (legal, difference) {
                    (Some(Verdict::Violation), _) => PixelVerdict::Violated,
                    (_, None) => PixelVerdict::Exact,
                    (Some(_), _) => PixelVerdict::Legal,
                    (None, Some((channel, [found, exact]))) => {
                        part.open.push(PixelDifference { pixel: pixel_at(index, size[0]), channel, found, exact });
                        PixelVerdict::Open
                    }
                });
            }
            part.open.truncate(KEPT);
            part
        });
        let mut all = FinishedCertificate::default();
        for part in parts {
            all.verdicts.extend(part.verdicts);
            all.open.extend(part.open);
        }
        all.open.truncate(KEPT);
        all.violations = legal.map(|legal| legal.violations).unwrap_or_default();
        Ok(all)
    }
}
