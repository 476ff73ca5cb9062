//! What the checker found.

use std::fmt;

use super::upload::UploadError;
use super::violation::Violation;

/// What is known of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// There is one legal answer, and the device gave it.
    Decided,
    /// Both a sphere and a miss are legal, and the device gave one of them.
    Silhouette,
    /// Several spheres are legal, and the device gave one of them.
    Tie,
    /// The device gave an answer that is not legal.
    Violation,
}

impl Verdict {
    /// All of them, in the order of reports.
    pub const ALL: &'static [Self] = &[Self::Decided, Self::Silhouette, Self::Tie, Self::Violation];

    /// What it is called in reports.
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

/// At most so many violations are kept in words; all are counted.
pub(super) const KEPT: usize = 1000;

/// Whether a device rendered a picture as a conforming WGSL implementation may.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Of every pixel, row by row from the top.
    pub verdicts: Vec<Verdict>,
    /// The first of them, in the order of pixels.
    pub violations: Vec<Violation>,
    /// In how many pixels the picture of [`Headless::render`](crate::gpu::Headless::render) has other values than the
    /// recording's, which then are judged by themselves; `None` if there is no such picture.
    pub rendered_otherwise: Option<usize>,
    /// What the device was given is not what was asked for: then nothing that it made of it counts.
    pub upload: Option<UploadError>,
    /// Of all hits, how far the distance is at most from the middle of what is legal, in parts of half the
    /// width; at most 1 if it is legal.
    pub worst_depth: f64,
    /// The same of normals, as distances from the exact one.
    pub worst_normal: f64,
}

impl Certificate {
    /// How many pixels have a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.verdicts.iter().filter(|of_pixel| **of_pixel == verdict).count()
    }

    /// The pixels with one legal answer that was given, of all.
    #[must_use]
    pub fn decided_fraction(&self) -> f64 {
        self.count(Verdict::Decided) as f64 / self.verdicts.len().max(1) as f64
    }

    /// Whether every pixel is as it may be.
    #[must_use]
    pub fn is_legal(&self) -> bool {
        self.upload.is_none() && self.violations.is_empty()
    }
}

impl fmt::Display for Certificate {
    /// A short table, and the first violation.
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
        Ok(())
    }
}
