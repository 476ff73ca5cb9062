//! Certificates: the results of the checker.

use std::fmt;

use super::bias::Deviations;
use super::outcome::Outcome;
use super::upload::UploadError;
use super::violation::Violation;

/// The verdict about a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// There is a single legal answer, and the device gave it.
    Decided,
    /// Both a sphere and a miss are legal, and the device gave one of them.
    Silhouette,
    /// Several spheres are legal, and the device gave one of them.
    Tie,
    /// The device gave an answer that is not legal.
    Violation,
}

impl Verdict {
    /// All verdicts, in the order of reports.
    pub const ALL: &'static [Self] = &[Self::Decided, Self::Silhouette, Self::Tie, Self::Violation];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Decided => "decided",
            Self::Silhouette => "silhouette",
            Self::Tie => "tie",
            Self::Violation => "violation",
        }
    }
}

/// The largest number of violations that are kept; all are counted.
pub(super) const KEPT: usize = 1000;

/// Whether a device rendered a picture as a conforming WGSL implementation may.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Certificate {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The verdict about every pixel, row by row from the top.
    pub verdicts: Vec<Verdict>,
    /// The first violations, in the order of pixels.
    pub violations: Vec<Violation>,
    /// The number of pixels in which the picture of [`Headless::render`](crate::gpu::Headless::render) differs from the
    /// recording's picture, and which are judged separately; `None` if there is no such picture.
    pub rendered_otherwise: Option<usize>,
    /// A mismatch between the data on the device and the requested data. If there is one, no pixel is judged.
    pub upload: Option<UploadError>,
    /// The largest deviation of a hit's distance from the middle of its legal interval, relative to half the width of
    /// the interval; at most 1 if legal.
    pub worst_depth: f64,
    /// The largest deviation of a normal from the exact one, relative to its bound; at most 1 if legal.
    pub worst_normal: f64,
    /// How far the numbers of decided pixels are from the middle of their bounds.
    pub deviations: Deviations,
}

impl Certificate {
    /// The number of pixels with a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.verdicts.iter().filter(|of_pixel| **of_pixel == verdict).count()
    }

    /// The fraction of pixels with a single legal answer, which the device gave.
    #[must_use]
    pub fn decided_fraction(&self) -> f64 {
        self.count(Verdict::Decided) as f64 / self.verdicts.len().max(1) as f64
    }

    /// The number of pixels for which several answers are legal, of which the device gave one.
    #[must_use]
    pub fn undecided(&self) -> usize {
        self.count(Verdict::Silhouette) + self.count(Verdict::Tie)
    }

    /// The outcome: violated if the uploaded data are wrong or a pixel is not legal, and undecided if too many pixels
    /// have several legal answers.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let is_violated = self.upload.is_some() || !self.violations.is_empty();
        Outcome::of(is_violated, self.undecided() as u64, self.verdicts.len() as u64)
    }

    /// Whether the outcome is [`Outcome::Proved`]: the uploaded data are correct, every pixel is legal, and almost all
    /// pixels have no other legal answer.
    #[must_use]
    pub fn is_legal(&self) -> bool {
        self.outcome() == Outcome::Proved
    }
}

impl fmt::Display for Certificate {
    /// Writes a short table and the first violation.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pixels = self.verdicts.len().max(1) as f64;
        for verdict in Verdict::ALL {
            let count = self.count(*verdict);
            let percent = 100.0 * count as f64 / pixels;
            writeln!(f, "{:<12}{count:>12}  {percent:8.4} %", verdict.name())?;
        }
        writeln!(f, "{:<12}{:>12.4}  of its bound", "worst depth", self.worst_depth)?;
        write!(f, "{:<12}{:>12.4}  of its bound", "worst normal", self.worst_normal)?;
        if let Some(count) = self.rendered_otherwise {
            write!(f, "\n{:<12}{count:>12}  pixels differ from the recorded ones", "rendered")?;
        }
        if let Some(error) = &self.upload {
            write!(f, "\nupload: {error}")?;
        }
        if let Some(first) = self.violations.first() {
            write!(f, "\nfirst violation: {first}")?;
        }
        self.deviations.biased().try_for_each(|biased| write!(f, "\nbiased: {biased}"))
    }
}
