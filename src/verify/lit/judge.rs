//! The verdict about a stage, and how it is found and counted.

use super::certificate::{LitCertificate, LitOpen, LitViolation, OPEN_KEPT, StageCounts};
use super::expected::{Expected, Mismatch};
use super::kernel::Address;
use super::recording::PathState;
use super::stage::LitStage;
use crate::parallel::{map_parts, ranges};
use crate::verify::certificate::KEPT;
use crate::verify::choices::Choices;
use crate::verify::hit::LegalHits;

/// The number of pixels that a thread takes at a time.
const CHUNK: usize = 256;

/// The verdict about a stage.
pub(in crate::verify) enum StageOutcome {
    Decided,
    Open,
    Undecided,
}

/// A stage without an illegal result.
pub(in crate::verify) struct Judged {
    verdict: StageOutcome,
    /// The legal answers of an open search, in words.
    alternatives: Vec<String>,
    /// How far numbers are from the middle of their bounds, if these say something.
    deviations: Vec<(LitStage, &'static str, f64)>,
}

impl From<StageOutcome> for Judged {
    fn from(verdict: StageOutcome) -> Self {
        Self { verdict, alternatives: Vec::new(), deviations: Vec::new() }
    }
}

impl From<Expected> for Judged {
    /// A stage without open decisions.
    fn from(expected: Expected) -> Self {
        if expected.is_wide {
            return StageOutcome::Undecided.into();
        }
        Self { deviations: expected.deviations, ..StageOutcome::Decided.into() }
    }
}

impl LitCertificate {
    /// Adds the results for other samples.
    pub fn join(&mut self, part: Self) {
        self.paths += part.paths;
        self.start = self.start.plus(part.start);
        self.extend = self.extend.plus(part.extend);
        self.scatter = self.scatter.plus(part.scatter);
        self.occlude = self.occlude.plus(part.occlude);
        self.surface = self.surface.plus(part.surface);
        self.shadow = self.shadow.plus(part.shadow);
        self.illuminate = self.illuminate.plus(part.illuminate);
        self.ambient = self.ambient.plus(part.ambient);
        self.gather = self.gather.plus(part.gather);
        self.accumulate = self.accumulate.plus(part.accumulate);
        self.deviations.join(&part.deviations);
        self.is_studio |= part.is_studio;
        self.violation_count += part.violation_count;
        self.upload = self.upload.take().or(part.upload);
        part.open.into_iter().for_each(|open| self.add_open(open));
        let new = part.rectangles.into_iter().filter(|new| !self.rectangles.contains(new));
        let new: Vec<_> = new.collect();
        self.rectangles.extend(new);
        self.film_pixels = self.film_pixels.max(part.film_pixels);
        self.film_samples = self.film_samples.max(part.film_samples);
        let room = KEPT.saturating_sub(self.violations.len());
        self.violations.extend(part.violations.into_iter().take(room));
    }
}

impl StageCounts {
    fn count(&mut self, verdict: &StageOutcome) {
        self.checked += 1;
        match verdict {
            StageOutcome::Decided => self.decided += 1,
            StageOutcome::Open => self.open += 1,
            StageOutcome::Undecided => self.undecided += 1,
        }
    }
}

impl LitCertificate {
    /// The counts of the stages among which a stage counts: along paths, its parts count as one.
    fn counts(&mut self, stage: LitStage) -> &mut StageCounts {
        match stage {
            LitStage::Start => &mut self.start,
            LitStage::Extend => &mut self.extend,
            LitStage::Vertex | LitStage::Radiance | LitStage::Light | LitStage::Scatter => {
                &mut self.scatter
            }
            LitStage::Occlude => &mut self.occlude,
            LitStage::Surface => &mut self.surface,
            LitStage::Shadow => &mut self.shadow,
            LitStage::Illuminate => &mut self.illuminate,
            LitStage::Ambient => &mut self.ambient,
            LitStage::Gather => &mut self.gather,
            LitStage::Accumulate => &mut self.accumulate,
        }
    }

    fn add_open(&mut self, open: LitOpen) {
        let of_kind = self.open.iter().filter(|other| other.is_undecided == open.is_undecided);
        if of_kind.count() < OPEN_KEPT {
            self.open.push(open);
        }
    }

    /// Records the verdict about a stage.
    pub(in crate::verify) fn note(
        &mut self,
        stage: LitStage,
        Address { pixel, sample, surface }: Address,
        result: Result<Judged, Mismatch>,
    ) {
        match result {
            Ok(Judged { verdict, alternatives, deviations }) => {
                self.counts(stage).count(&verdict);
                let is_undecided = matches!(verdict, StageOutcome::Undecided);
                if is_undecided || matches!(verdict, StageOutcome::Open) {
                    let legal = alternatives;
                    self.add_open(LitOpen { pixel, sample, surface, stage, is_undecided, legal });
                }
                for (stage, what, deviation) in deviations {
                    self.deviations.add(stage.name(), what, deviation);
                }
            }
            Err(mismatch) => {
                self.counts(stage).checked += 1;
                let (stage, message) = (mismatch.stage, mismatch.to_string());
                self.violations.push(LitViolation { pixel, sample, surface, stage, message });
            }
        }
    }
}

/// Evaluates a stage for every combination of open decisions, until one leads to the device's result.
pub(in crate::verify) fn along_choices(
    mut follow: impl FnMut(&mut Choices) -> Result<Expected, Mismatch>,
) -> Result<Judged, Mismatch> {
    let mut choices = Choices::default();
    let mut nearest: Option<Mismatch> = None;
    loop {
        match follow(&mut choices) {
            Ok(expected) if expected.is_wide => return Ok(StageOutcome::Undecided.into()),
            Ok(_) if choices.were_open() => return Ok(StageOutcome::Open.into()),
            Ok(expected) => return Ok(expected.into()),
            Err(mismatch) => {
                if nearest.as_ref().is_none_or(|best| mismatch.after > best.after) {
                    nearest = Some(mismatch);
                }
            }
        }
        if !choices.advance() {
            break;
        }
    }
    match nearest {
        Some(mismatch) if !choices.were_too_many() => Err(mismatch),
        _ => Ok(StageOutcome::Undecided.into()),
    }
}

/// Judges the samples of all pixels, on all cores. `judge` is called with the index of a pixel.
pub(in crate::verify) fn judge_pixels(
    count: usize,
    judge: impl Fn(usize, &mut LitCertificate, &mut LegalHits) + Sync,
) -> LitCertificate {
    let parts = map_parts(ranges(count, CHUNK), |range| {
        let mut part = LitCertificate::default();
        let mut legal = LegalHits::default();
        for index in range {
            part.paths += 1;
            judge(index, &mut part, &mut legal);
        }
        part.violation_count = part.violations.len() as u64;
        part.violations.truncate(KEPT);
        part
    });
    let mut all = LitCertificate::default();
    parts.into_iter().for_each(|part| all.join(part));
    all
}

/// Checks that the state of a ray that has ended does not change.
pub(in crate::verify) fn unchanged(
    name: (LitStage, &'static str),
    [before, after]: [&PathState; 2],
) -> Result<(), Mismatch> {
    let mut expected = Expected::default();
    (0..PathState::SLOTS).try_for_each(|slot| expected.same(name, [before, after], slot))
}

/// A search; `alternatives` names the legal answers if there are several.
pub(in crate::verify) fn searched(
    is_open: bool,
    alternatives: impl FnOnce() -> Vec<String>,
) -> Judged {
    match is_open {
        true => Judged { alternatives: alternatives(), ..StageOutcome::Open.into() },
        false => StageOutcome::Decided.into(),
    }
}
