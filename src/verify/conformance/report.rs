//! What was found about a picture.

use std::fmt;

use crate::image::NO_ID;
use crate::verify::outcome::Outcome;

/// The largest number of pixels that are explained.
pub(super) const KEPT: usize = 100;

/// Exponents of two of the first and the last limit of the histogram.
const FIRST: i32 = -4;
const LAST: i32 = 24;

/// How well the answers of a renderer hold, pixel by pixel: the result of
/// [`Checker::certify_answers`](crate::verify::Checker::certify_answers).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Conformance {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The limit of k.
    pub at_most: f64,
    /// The outcome of every pixel, row by row from the top. A pixel is proved if its answer is the only one that is
    /// legal within the limit, undecided if others are as well, and violated if it needs a larger k.
    pub outcomes: Vec<Outcome>,
    /// The least k of every pixel; infinity where no k makes it legal.
    pub least: Vec<f32>,
    /// The pixels that need the largest k, the worst first; at most a hundred.
    pub worst: Vec<Finding>,
}

/// Why a pixel needs its k.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Finding {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// The sphere that the renderer found; [`NO_ID`] for a miss.
    pub id: u32,
    /// The depth that the renderer found, as it was given.
    pub depth: Option<f64>,
    /// The outcome of the pixel.
    pub outcome: Outcome,
    /// The least k.
    pub least: f64,
    /// The same as a length in scene units: by how much a sphere must be moved.
    pub margin: f64,
    /// What needs it.
    pub reason: Reason,
    /// The sphere that the exact ray hits, and its distance.
    pub exact: Option<(u32, f64)>,
}

/// What is wrong with an answer unless the ray is changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Reason {
    /// The ray does not hit the sphere.
    Missed,
    /// The sphere is hit at another distance.
    Depth,
    /// The sphere has another normal there.
    Normal,
    /// This sphere is hit first, or is hit although the answer is a miss.
    Hidden(u32),
    /// The camera has no ray there.
    NoRay,
}

impl Reason {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Missed => "missed",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Hidden(_) => "hidden",
            Self::NoRay => "no-ray",
        }
    }
}

impl Conformance {
    /// The number of pixels with an outcome.
    #[must_use]
    pub fn count(&self, outcome: Outcome) -> usize {
        self.outcomes.iter().filter(|of_pixel| **of_pixel == outcome).count()
    }

    /// The fraction of pixels of which only one answer is legal within the limit, and the renderer gave it.
    #[must_use]
    pub fn decided_fraction(&self) -> f64 {
        self.count(Outcome::Proved) as f64 / self.outcomes.len().max(1) as f64
    }

    /// The outcome of the picture.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let violated = self.count(Outcome::Violated) > 0;
        Outcome::of(violated, self.count(Outcome::Undecided) as u64, self.outcomes.len() as u64)
    }

    /// The largest k that a pixel needs; 0 without pixels.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.least.iter().copied().fold(0.0, f32::max).into()
    }

    /// How many pixels need which k: the upper limits of k, which are powers of two from 1/16 on, and the number of
    /// pixels up to each that are above the one before. It ends with the largest k; the last limit is infinite if that
    /// is above 2²⁴.
    #[must_use]
    pub fn histogram(&self) -> Vec<(f64, usize)> {
        let limits = (FIRST..=LAST).map(|exponent| 2_f64.powi(exponent)).chain([f64::INFINITY]);
        let mut bins: Vec<(f64, usize)> = limits.map(|limit| (limit, 0)).collect();
        for least in &self.least {
            let bin = bins.partition_point(|(limit, _)| *limit < f64::from(*least));
            bins[bin].1 += 1;
        }
        let used = bins.iter().rposition(|(_, count)| *count > 0).map_or(0, |last| last + 1);
        bins.truncate(used);
        bins
    }
}

impl fmt::Display for Conformance {
    /// Writes a table, the histogram, and the worst pixel.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pixels = self.outcomes.len().max(1) as f64;
        let mut row = |name: &str, count: usize| {
            writeln!(f, "{name:<16}{count:>12}  {:8.4} %", 100.0 * count as f64 / pixels)
        };
        for outcome in Outcome::ALL {
            row(outcome.name(), self.count(*outcome))?;
        }
        for (limit, count) in self.histogram() {
            row(&format!("k up to {}", limit_in_words(limit)), count)?;
        }
        write!(f, "{:<16}{:>12.4}  of {}", "largest k", self.largest(), self.at_most)?;
        match self.worst.first() {
            Some(worst) => write!(f, "\nworst: {worst}"),
            None => Ok(()),
        }
    }
}

fn limit_in_words(limit: f64) -> String {
    if limit < 1.0 { format!("1/{}", 1.0 / limit) } else { limit.to_string() }
}

impl fmt::Display for Finding {
    /// Writes the finding on one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([i, j], id) = (self.pixel, self.id);
        write!(f, "pixel ({i}, {j}): ")?;
        match self.depth {
            _ if id == NO_ID => f.write_str("a miss")?,
            Some(depth) => write!(f, "sphere {id} at {depth}")?,
            None => write!(f, "sphere {id}")?,
        }
        write!(f, " needs k = {:.4}", self.least)?;
        if self.margin.is_finite() {
            write!(f, ", which moves it by {:.3e}", self.margin)?;
        }
        match self.reason {
            Reason::Missed => f.write_str(": the ray misses it")?,
            Reason::Depth => f.write_str(": it is hit elsewhere")?,
            Reason::Normal => f.write_str(": its normal is another")?,
            Reason::Hidden(other) => write!(f, ": sphere {other} is hit")?,
            Reason::NoRay => return f.write_str(": the camera has no ray there"),
        }
        match self.exact {
            Some((id, t)) => write!(f, "; the exact ray hits sphere {id} at {t:.9e}"),
            None => f.write_str("; the exact ray misses everything"),
        }
    }
}
