//! Judges finished pictures as they are in files, pixel by pixel, against the picture that exact arithmetic gives.
//!
//! The random numbers of a picture follow from its seed. So the f64 reference takes the very samples of the device, and
//! the same code finishes both: it removes noise, draws lines and annotations, and encodes. What rounding changes within
//! a pixel is mostly less than a step of the file, so that almost every pixel of a correct device *equals* the exact
//! one. Where a ray passes an edge, rounding may decide otherwise, and a pixel differs. Such a pixel is judged by an
//! interval: in pictures with one ray through each pixel, by [`written`](super::written), and in studios of opaque
//! spheres by following all samples forward, with every branch that rounding may take, and through the removal of noise
//! and the lines (`studio/forward.rs`, `studio/legal_picture.rs`). For other pictures there are no intervals: a pixel
//! that differs stays open, and the picture undecided.

use super::certificate::{CHUNK, KEPT, Outcome, channel_name};
use super::written::{WrittenError, WrittenPicture, WrittenViolation};
use crate::camera::View;
use crate::parallel::{map_parts, ranges};
use crate::recording::pixel_at;
use crate::render::RenderSettings;
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::forward;
use crate::verify::{Checker, Interval, Verdict};

/// The least share of exact pixels in a picture that is proved.
pub const LEAST_EXACT: f64 = 0.99;

/// The largest share of wide pixels in a picture that is proved.
pub const MOST_WIDE: f64 = 0.001;

/// The verdict about a pixel of a finished picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PixelVerdict {
    /// It is what exact arithmetic gives, to the resolution of the file.
    Exact,
    /// It is another value to which rounding may lead.
    Legal,
    /// Rounding may lead there, but also to many other values.
    Wide,
    /// It differs, and nothing says whether rounding may lead there.
    Open,
    /// Rounding cannot lead there.
    Violated,
}

impl PixelVerdict {
    /// All verdicts, in the order of reports.
    pub const ALL: &'static [Self] = &[Self::Exact, Self::Legal, Self::Wide, Self::Open, Self::Violated];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Legal => "legal",
            Self::Wide => "wide",
            Self::Open => "open",
            Self::Violated => "violated",
        }
    }
}

/// A pixel that differs from the exact one, and need not be legal.
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
    /// The first pixels that are wide or open, in the order of pixels.
    pub open: Vec<PixelDifference>,
}

impl FinishedCertificate {
    /// The number of pixels with a verdict.
    #[must_use]
    pub fn count(&self, verdict: PixelVerdict) -> usize {
        self.verdicts.iter().filter(|other| **other == verdict).count()
    }

    /// The outcome: proved if at least [`LEAST_EXACT`] of all pixels are exact, at most [`MOST_WIDE`] are wide, and all
    /// others are legal.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let all = self.verdicts.len() as f64;
        let share = |verdict| self.count(verdict) as f64 / all;
        if self.count(PixelVerdict::Violated) > 0 {
            return Outcome::Violated;
        }
        let is_known = self.count(PixelVerdict::Open) == 0 && share(PixelVerdict::Wide) <= MOST_WIDE;
        // This is also false for a picture without pixels.
        let is_exact = share(PixelVerdict::Exact) >= LEAST_EXACT;
        if is_known && is_exact { Outcome::Proved } else { Outcome::Undecided }
    }

    /// The outcome for a device that rendered the picture just now, so that nobody chose which pixels are open: as for
    /// other checks of devices, at most [`MOST_UNDECIDED`](super::MOST_UNDECIDED) of all pixels may be wide or open.
    #[must_use]
    pub fn outcome_of_device(&self) -> Outcome {
        let undecided = self.count(PixelVerdict::Wide) + self.count(PixelVerdict::Open);
        Outcome::of(self.count(PixelVerdict::Violated) > 0, undecided as u64, self.verdicts.len() as u64)
    }
}

impl Checker<'_> {
    /// The light that a conforming device may have for some pixels of a finished picture of a studio, given by their
    /// indices row by row from the top: red, green and blue. `None` if hardly anything is known, as in pictures that are
    /// not studios, or have translucent spheres.
    #[must_use]
    pub fn legal_light(
        &self,
        view: &View<'_>,
        settings: &RenderSettings,
        indices: &[usize],
    ) -> Vec<Option<[Interval; 3]>> {
        if indices.is_empty() {
            return Vec::new();
        }
        match forward::inputs(self, view, settings) {
            Some(inputs) => {
                let mut check = LitCheck::new(self, &inputs);
                check.brightest = check.most_light_of_paths();
                check.finished_light(indices)
            }
            None => vec![None; indices.len()],
        }
    }

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
        let encoding = picture.encoding;
        let is_plain = has_intervals && !encoding.transparent && encoding.kept_background().is_none();
        let count = size[0] as usize * size[1] as usize;
        let parts = map_parts(ranges(count, CHUNK), |range| {
            range.filter_map(|index| Some((index, picture.difference(exact, index)?))).collect::<Vec<_>>()
        });
        let (indices, differences): (Vec<usize>, Vec<_>) = parts.into_iter().flatten().unzip();
        let lights = if is_plain { self.legal_light(view, settings, &indices) } else { vec![None; indices.len()] };
        let mut all =
            FinishedCertificate { verdicts: vec![PixelVerdict::Exact; count], ..FinishedCertificate::default() };
        for ((index, light), (channel, [found, exact])) in indices.into_iter().zip(lights).zip(differences) {
            let pixel = pixel_at(index, size[0]);
            let judged = light.map(|light| picture.judge_light(index, light));
            all.verdicts[index] = match (&legal, judged) {
                (Some(_), _) | (None, Some(Ok(true))) => PixelVerdict::Legal,
                (None, Some(Ok(false))) => PixelVerdict::Wide,
                (None, None) => PixelVerdict::Open,
                (None, Some(Err((channel, legal)))) => {
                    let found = picture.at(index)[channel];
                    all.violations.push(WrittenViolation { pixel, channel, found, legal });
                    PixelVerdict::Violated
                }
            };
            if matches!(all.verdicts[index], PixelVerdict::Open | PixelVerdict::Wide) {
                all.open.push(PixelDifference { pixel, channel, found, exact });
            }
        }
        if let Some(legal) = legal {
            let illegal =
                legal.verdicts.iter().zip(&mut all.verdicts).filter(|(found, _)| **found == Verdict::Violation);
            illegal.for_each(|(_, verdict)| *verdict = PixelVerdict::Violated);
            all.violations = legal.violations;
        }
        all.open.truncate(KEPT);
        all.violations.truncate(KEPT);
        Ok(all)
    }
}
