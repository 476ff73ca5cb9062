//! What the checker found of paths.

use std::fmt;

use super::upload::PathUploadError;

/// A stage of a path: the kernel that does it, or a part of what it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PathStage {
    /// The camera's ray of a sample.
    Start,
    /// What a ray meets.
    Extend,
    /// Where that is, on which side, and of what.
    Vertex,
    /// What light is found at the end, or by chance.
    Radiance,
    /// The light that a surface looks for.
    Light,
    /// Where the path goes on, and what it carries.
    Scatter,
    /// Whether anything is between a surface and the light that it looks for.
    Occlude,
    /// What the sample adds to the picture.
    Accumulate,
}

impl PathStage {
    /// What it is called in reports.
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

/// An answer that is not legal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathViolation {
    /// Column and row in the film, from the upper left.
    pub pixel: [u32; 2],
    /// Which of the pixel's samples.
    pub sample: u32,
    /// Which of the surfaces that the path meets, from 0.
    pub surface: u32,
    /// Where it went wrong.
    pub stage: PathStage,
    /// What was found, and what is legal.
    pub message: String,
}

impl fmt::Display for PathViolation {
    /// On one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixel: [i, j], sample, surface, stage, message } = self;
        let stage = stage.name();
        write!(f, "pixel ({i}, {j}), sample {sample}, surface {surface}, {stage}: {message}")
    }
}

/// How many stages were judged, and what is known of them. A stage counts once for each path that passes it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageCounts {
    /// All that were judged.
    pub checked: u64,
    /// With one legal answer, up to narrow bounds, which the device gave.
    pub decided: u64,
    /// Several answers are legal, as at a silhouette or where chances are equal, and the device gave one of them.
    pub open: u64,
    /// Legal, but a bound is so wide that this says little.
    pub undecided: u64,
}

/// Whether a device followed paths as a conforming WGSL implementation may.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathCertificate {
    /// How many paths were followed: samples of pixels.
    pub paths: u64,
    /// Rays of samples.
    pub start: StageCounts,
    /// What rays meet.
    pub extend: StageCounts,
    /// Surfaces, and what is behind everything.
    pub scatter: StageCounts,
    /// Searches for what hides a light.
    pub occlude: StageCounts,
    /// What samples add.
    pub accumulate: StageCounts,
    /// How many stages are not legal.
    pub violation_count: u64,
    /// The first of them, in the order of samples, surfaces and pixels.
    pub violations: Vec<PathViolation>,
    /// What the device was given is not what was asked for: then nothing that it made of it counts.
    pub upload: Option<PathUploadError>,
}

impl PathCertificate {
    /// All stages together.
    #[must_use]
    pub fn stages(&self) -> StageCounts {
        [self.start, self.extend, self.scatter, self.occlude, self.accumulate]
            .into_iter()
            .fold(StageCounts::default(), StageCounts::plus)
    }

    /// Whether every stage is as it may be.
    #[must_use]
    pub fn is_legal(&self) -> bool {
        self.upload.is_none() && self.violation_count == 0
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
    /// On one line.
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
