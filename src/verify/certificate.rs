//! Certificates: the results of the checker.

use std::fmt;

use crate::image::NO_ID;
use crate::recording::UploadError;
use crate::verify::bias::Deviations;
use crate::verify::hit::LegalHits;
use crate::verify::rounding::Interval;

/// The largest share of undecided answers in a certificate that proves something.
pub const MOST_UNDECIDED: f64 = 0.01;

/// The outcome of a whole certificate.
///
/// Only [`Outcome::Proved`] means that a picture is legal. A picture with too many undecided answers is not called
/// legal, even if nothing in it is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Outcome {
    /// Nothing is wrong, and at most [`MOST_UNDECIDED`] of all answers are undecided.
    Proved,
    /// Nothing is known to be wrong, but more than [`MOST_UNDECIDED`] of all answers are undecided, or there are none.
    Undecided,
    /// At least one answer is wrong.
    Violated,
}

impl Outcome {
    /// All outcomes, from good to bad.
    pub const ALL: &'static [Self] = &[Self::Proved, Self::Undecided, Self::Violated];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Proved => "proved",
            Self::Undecided => "undecided",
            Self::Violated => "violated",
        }
    }

    /// The outcome of `all` answers.
    pub(super) fn of(is_violated: bool, undecided: u64, all: u64) -> Self {
        match (is_violated, undecided as f64 <= MOST_UNDECIDED * all as f64 && all > 0) {
            (true, _) => Self::Violated,
            (false, true) => Self::Proved,
            (false, false) => Self::Undecided,
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The verdict about a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Verdict {
    /// There is a single legal answer, and the device gave it.
    Decided,
    /// Both a shape and a miss are legal, and the device gave one of them.
    Silhouette,
    /// Several shapes are legal, and the device gave one of them.
    Tie,
    /// The device gave an answer that is not legal.
    Violation,
}

impl Verdict {
    /// All verdicts, in the order of reports.
    pub const ALL: &'static [Self] = &[Self::Decided, Self::Silhouette, Self::Tie, Self::Violation];

    /// The verdict about an answer that is among the legal ones.
    pub(super) fn of(legal: &LegalHits) -> Self {
        match (legal.count(), legal.miss) {
            (1, _) => Self::Decided,
            (_, true) => Self::Silhouette,
            (_, false) => Self::Tie,
        }
    }

    pub(super) fn count(self, all: &[Self]) -> usize {
        all.iter().filter(|verdict| **verdict == self).count()
    }

    /// The number of pixels with several legal answers.
    pub(super) fn undecided(all: &[Self]) -> usize {
        Self::Silhouette.count(all) + Self::Tie.count(all)
    }

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

/// The number of pixels that a thread takes at a time.
pub(super) const CHUNK: usize = 1 << 12;

/// The largest number of violations that are kept. All are counted.
pub(super) const KEPT: usize = 1000;

/// The name of a shape in messages. `first_cone` is the id of the first cone, if there are cones.
pub(super) fn shape_name(first_cone: Option<u32>, id: u32) -> String {
    let kind = if first_cone.is_some_and(|first| id >= first) { "cone or cylinder with id" } else { "sphere" };
    format!("{kind} {id}")
}

impl LegalHits {
    /// An answer in words, with the legal answers.
    #[must_use]
    pub fn message(&self, id: u32, t: f32) -> String {
        match id {
            NO_ID => format!("a miss; legal is {self}"),
            id => format!("{} at {t:?}; legal is {self}", shape_name(self.first_cone, id)),
        }
    }
}

impl fmt::Display for LegalHits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut answers: Vec<String> = Vec::new();
        for hit in &self.spheres {
            let name = shape_name(self.first_cone, hit.id);
            answers.extend(hit.crossings().map(|side| format!("{name} at {side}")));
        }
        if self.miss {
            answers.push("a miss".to_owned());
        }
        f.write_str(&answers.join(", or "))?;
        if self.spheres.len() > 1 && self.limit.is_finite() {
            write!(f, ", but none beyond {:.10e}", self.limit)?;
        }
        Ok(())
    }
}

/// A result that is not legal.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Violation {
    /// Column and row of the pixel, from the top left.
    pub pixel: [u32; 2],
    /// The stage with the illegal result: `cull`, `camera`, `hit`, `id`, `depth`, `normal`, `color`; or `render`, in the
    /// picture of [`Headless::render`](crate::gpu::Headless::render), where distances of hits are from the camera.
    pub stage: &'static str,
    /// The result that was found, and the legal results.
    pub message: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixel: [i, j], stage, message } = self;
        write!(f, "pixel ({i}, {j}), {stage}: {message}")
    }
}

/// A [`Violation`] at some pixel.
#[derive(Debug)]
pub(super) struct Mismatch {
    pub(super) stage: &'static str,
    pub(super) message: String,
}

impl Mismatch {
    pub(super) fn new(stage: &'static str, message: impl Into<String>) -> Self {
        Self { stage, message: message.into() }
    }

    pub(super) fn value(stage: &'static str, found: f32, legal: Interval) -> Self {
        Self::new(stage, format!("{found:?}; legal is {legal}"))
    }
}

/// Judges a number with a name.
pub(super) fn legal_is(
    stage: &'static str,
    name: impl fmt::Display,
    found: f32,
    legal: Interval,
) -> Result<(), Mismatch> {
    match legal.contains(found.into()) {
        true => Ok(()),
        false => Err(Mismatch::new(stage, format!("{name} is {found:?}; legal is {legal}"))),
    }
}

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// The name of a channel of a colour, from 0 for red to 3 for alpha.
pub(super) fn channel_name(channel: usize) -> &'static str {
    ["red", "green", "blue", "alpha"].get(channel).copied().unwrap_or("a channel")
}

/// Whether a device rendered a picture as a conforming WGSL implementation may.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Certificate {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The verdict about every pixel, row by row from the top.
    pub verdicts: Vec<Verdict>,
    /// The first violations, in the order of pixels.
    pub violations: Vec<Violation>,
    /// The number of pixels in which the picture of [`Headless::render`](crate::gpu::Headless::render) differs from the
    /// recording's picture. They are judged separately. `None` if there is no such picture.
    pub rendered_otherwise: Option<usize>,
    /// A mismatch between the data on the device and the requested data. If there is one, no pixel is judged.
    pub upload: Option<UploadError>,
    /// The largest deviation of a hit's distance from the middle of its legal interval, relative to half the width of
    /// the interval; at most 1 if legal.
    pub worst_depth: f64,
    /// The largest deviation of a normal from the exact normal, relative to its bound; at most 1 if legal.
    pub worst_normal: f64,
    /// The deviations of decided pixels from the middle of their bounds.
    pub deviations: Deviations,
}

impl Certificate {
    /// The number of pixels with a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        verdict.count(&self.verdicts)
    }

    /// The fraction of pixels with a single legal answer, which the device gave.
    #[must_use]
    pub fn decided_fraction(&self) -> f64 {
        self.count(Verdict::Decided) as f64 / self.verdicts.len().max(1) as f64
    }

    /// The number of pixels for which several answers are legal. The device gave one of them.
    #[must_use]
    pub fn undecided(&self) -> usize {
        Verdict::undecided(&self.verdicts)
    }

    /// The outcome: violated if the uploaded data are wrong or a pixel is not legal, and undecided if too many pixels
    /// have several legal answers.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let is_violated = self.upload.is_some() || !self.violations.is_empty();
        Outcome::of(is_violated, self.undecided() as u64, self.verdicts.len() as u64)
    }

    /// Returns true if the outcome is [`Outcome::Proved`]: the uploaded data are correct, every pixel is legal, and
    /// almost all pixels have no other legal answer.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_violation_counts_more_than_what_is_undecided() {
        for (is_violated, undecided, all, outcome) in [
            (false, 0, 1, Outcome::Proved),
            (false, 1, 100, Outcome::Proved),
            (false, 2, 100, Outcome::Undecided),
            (false, 0, 0, Outcome::Undecided),
            (true, 0, 1, Outcome::Violated),
            (true, 2, 100, Outcome::Violated),
        ] {
            assert_eq!(Outcome::of(is_violated, undecided, all), outcome);
        }
        assert!(Outcome::ALL.is_sorted());
    }
}
