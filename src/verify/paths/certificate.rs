//! The certificate of paths: the results of the checker.

use std::fmt;

use super::upload::PathUploadError;
use crate::verify::outcome::Outcome;

/// A stage of a path: a kernel, or a part of its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PathStage {
    /// The camera ray of a sample.
    Start,
    /// The nearest hit of a ray.
    Extend,
    /// The surface at the hit: its point, side and material.
    Vertex,
    /// The light that the path hits at its end or at an emissive surface.
    Radiance,
    /// The sampled light at a surface.
    Light,
    /// The scattered ray, and the throughput of the path.
    Scatter,
    /// Whether a surface occludes the sampled light.
    Occlude,
    /// The contribution of the sample to the picture.
    Accumulate,
}

impl PathStage {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Extend => "extend",
            Self::Vertex => "vertex",
            Self::Radiance => "radiance",
            Self::Light => "light",
            Self::Scatter => "scatter",
            Self::Occlude => "occlude",
            Self::Accumulate => "accumulate",
        }
    }
}

/// A result that is not legal.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PathViolation {
    /// Column and row in the film, from the top left.
    pub pixel: [u32; 2],
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// Index of the surface on the path, from 0.
    pub surface: u32,
    /// The stage with the illegal result.
    pub stage: PathStage,
    /// The result that was found, and the legal ones.
    pub message: String,
}

impl fmt::Display for PathViolation {
    /// Writes the violation on one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixel: [i, j], sample, surface, stage, message } = self;
        let stage = stage.name();
        write!(f, "pixel ({i}, {j}), sample {sample}, surface {surface}, {stage}: {message}")
    }
}

/// The number of stages that were judged, by verdict. A stage counts once for each path that passes through it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct StageCounts {
    /// All stages that were judged.
    pub checked: u64,
    /// Stages with a single legal answer, up to narrow bounds, which the device gave.
    pub decided: u64,
    /// Stages with several legal answers, as at a silhouette or at a random choice on a boundary, of which the device
    /// gave one.
    pub open: u64,
    /// Stages with a legal answer whose bound is so wide that the check says little.
    pub undecided: u64,
}

/// Whether a device followed paths as a conforming WGSL implementation may.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PathCertificate {
    /// The number of paths, which are samples of pixels.
    pub paths: u64,
    /// Camera rays of samples.
    pub start: StageCounts,
    /// Nearest hits of rays.
    pub extend: StageCounts,
    /// Shading at surfaces, and of rays that hit nothing.
    pub scatter: StageCounts,
    /// Searches for surfaces that occlude a light.
    pub occlude: StageCounts,
    /// Contributions of samples to the picture.
    pub accumulate: StageCounts,
    /// The number of stages with an illegal result.
    pub violation_count: u64,
    /// The first violations, in the order of samples, surfaces and pixels.
    pub violations: Vec<PathViolation>,
    /// A mismatch between the data on the device and the requested data. If there is one, no path is judged.
    pub upload: Option<PathUploadError>,
}

impl PathCertificate {
    /// The sum of the counts of all stages.
    #[must_use]
    pub fn stages(&self) -> StageCounts {
        [self.start, self.extend, self.scatter, self.occlude, self.accumulate]
            .into_iter()
            .fold(StageCounts::default(), StageCounts::plus)
    }

    /// The outcome: violated if the uploaded data are wrong or a stage is not legal, and undecided if too much is
    /// undecided in any kind of stages.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let is_violated = self.upload.is_some() || self.violation_count > 0;
        let stages = [self.start, self.extend, self.scatter, self.occlude, self.accumulate];
        let of = |counts: StageCounts| Outcome::of(is_violated, counts.undecided, counts.checked);
        let used = stages.into_iter().filter(|counts| counts.checked > 0).map(of).max();
        used.unwrap_or(Outcome::of(is_violated, 0, 0))
    }

    /// Whether the outcome is [`Outcome::Proved`]: the uploaded data are correct, every stage is legal, and almost
    /// nothing is undecided.
    #[must_use]
    pub fn is_legal(&self) -> bool {
        self.outcome() == Outcome::Proved
    }
}

impl StageCounts {
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            checked: self.checked + other.checked,
            decided: self.decided + other.decided,
            open: self.open + other.open,
            undecided: self.undecided + other.undecided,
        }
    }
}

impl fmt::Display for PathCertificate {
    /// Writes a summary on one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let StageCounts { checked, decided, open, undecided } = self.stages();
        let percent = |count: u64| 100.0 * count as f64 / checked.max(1) as f64;
        write!(
            f,
            "{} paths, {checked} stages: {:.4} % decided, {:.4} % open, {:.4} % undecided, {} violations",
            self.paths,
            percent(decided),
            percent(open),
            percent(undecided),
            self.violation_count
        )?;
        if let Some(error) = &self.upload {
            write!(f, "; upload: {error}")?;
        }
        if let Some(first) = self.violations.first() {
            write!(f, "; first: {first}")?;
        }
        Ok(())
    }
}
