//! The stages of a sample that are judged, and the certificate of lit pictures.

use std::fmt;

use crate::recording::UploadError;
use crate::verify::bias::Deviations;
use crate::verify::certificate::Outcome;

/// A stage of a sample, along a path or in a studio: a kernel, or a part of its work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum LitStage {
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
    /// The surface that a ray of a studio hits: its colour and lobe, and the light that needs no search.
    Surface,
    /// Whether a light is hidden from a surface of a studio.
    Shadow,
    /// The light that lights add to a surface of a studio.
    Illuminate,
    /// Whether something is near in a direction of ambient light.
    Ambient,
    /// The ambient light that directions add to a surface of a studio.
    Gather,
    /// The sums of the samples of a pixel.
    Accumulate,
}

impl LitStage {
    pub(super) const COUNT: usize = Self::Accumulate as usize + 1;

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
            Self::Surface => "surface",
            Self::Shadow => "shadow",
            Self::Illuminate => "illuminate",
            Self::Ambient => "ambient",
            Self::Gather => "gather",
            Self::Accumulate => "accumulate",
        }
    }
}

/// The address of a surface: pixel, sample, and index on the path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Address {
    pub(crate) pixel: [u32; 2],
    pub(crate) sample: u32,
    pub(crate) surface: u32,
}

/// A result that is not legal.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize))]
#[non_exhaustive]
pub struct LitViolation {
    /// Column and row in the film, from the top left.
    pub pixel: [u32; 2],
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// Index of the surface along the ray or the path, from 0.
    pub surface: u32,
    /// The stage with the illegal result.
    pub stage: LitStage,
    /// The result that was found, and the legal results.
    pub message: String,
}

impl fmt::Display for LitViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixel: [i, j], sample, surface, stage, message } = self;
        let stage = stage.name();
        write!(f, "pixel ({i}, {j}), sample {sample}, surface {surface}, {stage}: {message}")
    }
}

/// Maximum number of open stages, and of undecided stages, that are kept. All are counted.
pub(super) const OPEN_KEPT: usize = 32;

/// A stage with several legal results, or with bounds that are too wide for its check to decide much.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize))]
#[non_exhaustive]
pub struct LitOpen {
    /// Column and row in the film, from the top left.
    pub pixel: [u32; 2],
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// Index of the surface along the ray or the path, from 0.
    pub surface: u32,
    /// The stage.
    pub stage: LitStage,
    /// Whether the bounds are too wide; otherwise the device gave one of several legal results.
    pub is_undecided: bool,
    /// Up to four legal answers of a search in words: spheres that may be the nearest, or that may hide a light but
    /// need not. Empty for other stages.
    pub legal: Vec<String>,
}

impl fmt::Display for LitOpen {
    /// Writes the address of the stage and its legal answers, on one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pixel: [i, j], sample, surface, stage, legal, .. } = self;
        let (stage, legal) = (stage.name(), legal.join(", or "));
        write!(f, "pixel ({i}, {j}), sample {sample}, surface {surface}, {stage}: {legal}")
    }
}

/// The number of stages that were judged, by verdict. A stage counts once for each sample that passes through it. In a
/// studio, a search counts once for each light and each direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize))]
#[non_exhaustive]
pub struct StageCounts {
    /// All stages that were judged.
    pub checked: u64,
    /// Stages with a single legal answer, up to narrow bounds. The device gave this answer.
    pub decided: u64,
    /// Stages with several legal answers, as at a silhouette or at a random choice on a
    /// boundary. The device gave one of them.
    pub open: u64,
    /// Stages with a legal answer whose bound is too wide for the check to decide much.
    pub undecided: u64,
}

/// Whether a device took samples of a lit picture as a conforming WGSL implementation may.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct LitCertificate {
    /// The number of samples of pixels. Each is a path, or a ray of a studio with all surfaces that it passes.
    pub paths: u64,
    /// The counts of each stage, indexed by [`LitStage`].
    pub(crate) counts: [StageCounts; LitStage::COUNT],
    /// The number of stages with an illegal result.
    pub violation_count: u64,
    /// The first violations, in the order of samples, surfaces and pixels.
    pub violations: Vec<LitViolation>,
    /// The first open stages, and the first undecided stages.
    pub open: Vec<LitOpen>,
    /// First column and row, width and height of the rectangles of the film in which samples were taken.
    pub rectangles: Vec<[u32; 4]>,
    /// The number of pixels of the film.
    pub film_pixels: u64,
    /// The number of samples of each pixel that the settings ask for.
    pub film_samples: u32,
    /// A mismatch between the data on the device and the requested data. If there is one, nothing is judged.
    pub upload: Option<UploadError>,
    /// The deviations of decided stages from the middle of their bounds.
    pub deviations: Deviations,
    /// Whether the picture is that of a studio.
    pub is_studio: bool,
}

/// The judged share of a lit picture: some samples of some pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize))]
#[non_exhaustive]
pub struct LitShare {
    /// The number of samples that were judged of each of these pixels.
    pub samples: u64,
    /// The number of samples of each pixel of the picture.
    pub of_samples: u64,
    /// The number of pixels with judged samples.
    pub pixels: u64,
    /// The number of pixels of the picture.
    pub of_pixels: u64,
}

impl LitShare {
    /// The fraction of the picture's samples that were judged, from 0 to 1.
    #[must_use]
    pub fn fraction(&self) -> f64 {
        let of = |part: u64, all: u64| part as f64 / all.max(1) as f64;
        of(self.samples, self.of_samples) * of(self.pixels, self.of_pixels)
    }
}

/// The number of pixels in rectangles, which may overlap.
fn covered(rectangles: &[[u32; 4]]) -> u64 {
    let rows = rectangles.iter().flat_map(|[_, y, _, height]| *y..y.saturating_add(*height));
    let rows: std::collections::BTreeSet<u32> = rows.collect();
    let in_row = |row: u32| {
        let here = rectangles.iter().filter(|[_, y, _, height]| row >= *y && row - y < *height);
        let mut spans: Vec<_> = here.map(|[x, _, width, _]| (*x, x.saturating_add(*width))).collect();
        spans.sort_unstable();
        let mut end = 0;
        spans.into_iter().fold(0_u64, |sum, (first, last)| {
            let new = last.saturating_sub(first.max(end));
            end = end.max(last);
            sum + u64::from(new)
        })
    };
    rows.into_iter().map(in_row).sum()
}

impl LitCertificate {
    /// The share of the picture that was judged. The same number of samples was recorded in each rectangle. If it is
    /// larger than the number in the picture, all samples count as judged.
    #[must_use]
    pub fn share(&self) -> LitShare {
        let area = |[_, _, width, height]: &[u32; 4]| u64::from(*width) * u64::from(*height);
        let recorded: u64 = self.rectangles.iter().map(area).sum();
        let of_samples = u64::from(self.film_samples);
        LitShare {
            samples: (self.paths / recorded.max(1)).min(of_samples),
            of_samples,
            pixels: covered(&self.rectangles),
            of_pixels: self.film_pixels,
        }
    }

    /// The sum of the counts of all stages.
    #[must_use]
    pub fn stages(&self) -> StageCounts {
        self.named().into_iter().map(|(_, counts)| counts).fold(StageCounts::default(), StageCounts::plus)
    }

    /// The counts of the stages of a path, or of a studio, with their names, in order.
    #[must_use]
    pub fn named(&self) -> Vec<(&'static str, StageCounts)> {
        use LitStage::{Accumulate, Ambient, Extend, Gather, Illuminate, Occlude, Scatter, Shadow, Start, Surface};
        let stages: &[LitStage] = if self.is_studio {
            &[Start, Extend, Surface, Shadow, Illuminate, Ambient, Gather, Accumulate]
        } else {
            &[Start, Extend, Scatter, Occlude, Accumulate]
        };
        stages.iter().map(|stage| (stage.name(), self.counts[*stage as usize])).collect()
    }

    /// The outcome: violated if the uploaded data are wrong or a stage is not legal, and undecided if too many stages
    /// of any kind are undecided.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let is_violated = self.upload.is_some() || self.violation_count > 0;
        let of = |counts: StageCounts| Outcome::of(is_violated, counts.undecided, counts.checked);
        let stages = self.named().into_iter().map(|(_, counts)| counts);
        let used = stages.filter(|counts| counts.checked > 0).map(of).max();
        used.unwrap_or(Outcome::of(is_violated, 0, 0))
    }

    /// Returns true if the outcome is [`Outcome::Proved`]: the uploaded data are correct, every stage is legal, and
    /// almost nothing is undecided.
    #[must_use]
    pub fn is_legal(&self) -> bool {
        self.outcome() == Outcome::Proved
    }
}

impl StageCounts {
    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            checked: self.checked + other.checked,
            decided: self.decided + other.decided,
            open: self.open + other.open,
            undecided: self.undecided + other.undecided,
        }
    }
}

impl fmt::Display for LitCertificate {
    /// Writes a summary on one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let StageCounts { checked, decided, open, undecided } = self.stages();
        let percent = |count: u64| 100.0 * count as f64 / checked.max(1) as f64;
        write!(
            f,
            "{} {}, {checked} stages: {:.4} % decided, {:.4} % open, {:.4} % undecided, {} violations",
            self.paths,
            if self.is_studio { "samples" } else { "paths" },
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
        self.deviations.biased().try_for_each(|biased| write!(f, "; biased: {biased}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_in_two_rectangles_count_once() {
        assert_eq!(covered(&[[2, 1, 4, 3]]), 12);
        assert_eq!(covered(&[[2, 1, 4, 3], [4, 2, 4, 3]]), 20);
        assert_eq!(covered(&[[2, 1, 4, 3], [3, 1, 1, 1], [9, 9, 1, 1]]), 13);
        let rectangles = vec![[2, 1, 4, 3], [4, 2, 4, 3]];
        let certificate =
            LitCertificate { paths: 48, rectangles, film_pixels: 100, film_samples: 16, ..LitCertificate::default() };
        let share = certificate.share();
        assert_eq!((share.samples, share.pixels), (2, 20));
        assert!((share.fraction() - 0.025).abs() < 1e-12, "{share:?}");
        // More samples than the picture has.
        let share = LitCertificate { paths: 4800, ..certificate }.share();
        assert_eq!((share.samples, share.pixels), (16, 20));
    }
}
