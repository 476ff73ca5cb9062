//! Comparing the results of a kernel with the legal ones, number by number, and the verdict about a stage.

use std::fmt::Display;

use crate::parallel::{map_parts, ranges};
use crate::recording::lit::PathState;
use crate::verify::bias::deviation;
use crate::verify::certificate::KEPT;
use crate::verify::choices::Choices;
use crate::verify::hit::LegalHits;
use crate::verify::lit::certificate::{Address, LitCertificate, LitOpen, LitStage, LitViolation, OPEN_KEPT};
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::Interval;

/// The relative width above which a bound is too wide to decide anything.
const WIDE: f64 = 0.1;

/// A result of a device that is not legal.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mismatch {
    pub(crate) stage: LitStage,
    pub(crate) message: String,
    /// The number of comparisons that succeeded before.
    pub(crate) after: u32,
}

/// The stage and the name of a number, for reports.
pub(crate) type Name = (LitStage, &'static str);

/// Compares results with legal ones, and records whether a bound is too wide to decide anything.
#[derive(Debug, Default)]
pub(crate) struct Judge {
    passed: u32,
    /// Whether some bound was too wide to decide anything.
    pub(crate) is_wide: bool,
    /// The deviations of numbers from the middle of their bounds.
    pub(crate) deviations: Vec<(LitStage, &'static str, f64)>,
}

impl Judge {
    pub(crate) fn bits(&mut self, (stage, what): Name, found: u32, legal: u32) -> Result<(), Mismatch> {
        if found != legal {
            let message = format!("{what} is {found:#x}; legal is {legal:#x}");
            return Err(Mismatch { stage, message, after: self.passed });
        }
        self.passed += 1;
        Ok(())
    }

    /// Compares a number. Its bound is narrow or wide relative to `scale`.
    fn within(&mut self, (stage, what): Name, found: f32, legal: Interval, scale: f64) -> Result<(), Mismatch> {
        if !legal.contains(found.into()) {
            let message = format!("{what} is {found:?}; legal is {legal}");
            return Err(Mismatch { stage, message, after: self.passed });
        }
        self.passed += 1;
        let deviation = deviation(found.into(), legal);
        self.deviations.extend(deviation.map(|deviation| (stage, what, deviation)));
        self.is_wide |= legal.high - legal.low > WIDE * scale + f64::from(f32::MIN_POSITIVE) * 4.0;
        Ok(())
    }

    pub(crate) fn number(&mut self, name: Name, found: f32, legal: Number) -> Result<(), Mismatch> {
        self.number_of(name, found, legal, 0.0)
    }

    /// Compares a number. Its bound is narrow or wide relative to `size` or to itself.
    pub(crate) fn number_of(&mut self, name: Name, found: f32, legal: Number, size: f64) -> Result<(), Mismatch> {
        let legal = legal.interval();
        self.within(name, found, legal, legal.size().max(size))
    }

    /// Compares a vector. Its bounds are narrow or wide relative to its largest component.
    pub(crate) fn vector(&mut self, name: Name, found: [f32; 3], legal: Vector) -> Result<(), Mismatch> {
        self.vector_of(name, found, legal, 0.0)
    }

    /// Compares a vector. Its bounds are narrow or wide relative to `size` or its largest component.
    pub(crate) fn vector_of(&mut self, name: Name, found: [f32; 3], legal: Vector, size: f64) -> Result<(), Mismatch> {
        let legal = legal.intervals();
        let scale = legal.iter().map(|axis| axis.size()).fold(size, f64::max);
        let mut pairs = found.iter().zip(&legal);
        pairs.try_for_each(|(found, legal)| self.within(name, *found, *legal, scale))
    }

    /// Checks that a state has not changed.
    pub(crate) fn unchanged(&mut self, name: Name, states: [&PathState; 2]) -> Result<(), Mismatch> {
        (0..PathState::SLOTS).try_for_each(|slot| self.same(name, states, slot))
    }

    /// Checks that a slot has not changed.
    pub(crate) fn same(&mut self, name: Name, [before, after]: [&PathState; 2], slot: usize) -> Result<(), Mismatch> {
        let mut pairs = after.slots[slot].iter().zip(&before.slots[slot]);
        pairs.try_for_each(|(found, legal)| self.bits(name, *found, *legal))
    }

    pub(crate) fn fail(&self, (stage, what): Name, words: impl Display) -> Mismatch {
        Mismatch { stage, message: format!("{what}: {words}"), after: self.passed }
    }
}

/// The number of pixels that a thread takes at a time.
const CHUNK: usize = 256;

/// The verdict about a stage.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum StageOutcome {
    Decided,
    Open,
    Undecided,
}

/// A stage without an illegal result.
pub(crate) struct StageResult {
    verdict: StageOutcome,
    /// The legal answers of an open search, in words.
    alternatives: Vec<String>,
    /// The deviations of numbers from the middle of their bounds, if the bounds allow measuring them.
    deviations: Vec<(LitStage, &'static str, f64)>,
}

impl From<StageOutcome> for StageResult {
    fn from(verdict: StageOutcome) -> Self {
        Self { verdict, alternatives: Vec::new(), deviations: Vec::new() }
    }
}

impl From<Judge> for StageResult {
    /// A stage without open decisions.
    fn from(judge: Judge) -> Self {
        if judge.is_wide {
            return StageOutcome::Undecided.into();
        }
        Self { deviations: judge.deviations, ..StageOutcome::Decided.into() }
    }
}

impl LitCertificate {
    /// Adds the results for other samples.
    pub fn join(&mut self, part: Self) {
        self.paths += part.paths;
        for (counts, more) in self.counts.iter_mut().zip(part.counts) {
            *counts = counts.plus(more);
        }
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

    fn add_open(&mut self, open: LitOpen) {
        let of_kind = self.open.iter().filter(|other| other.is_undecided == open.is_undecided);
        if of_kind.count() < OPEN_KEPT {
            self.open.push(open);
        }
    }

    pub(crate) fn note(
        &mut self,
        stage: LitStage,
        Address { pixel, sample, surface }: Address,
        result: Result<StageResult, Mismatch>,
    ) {
        let counts = &mut self.counts[stage as usize];
        counts.checked += 1;
        match result {
            Ok(StageResult { verdict, alternatives: legal, deviations }) => {
                match verdict {
                    StageOutcome::Decided => counts.decided += 1,
                    StageOutcome::Open => counts.open += 1,
                    StageOutcome::Undecided => counts.undecided += 1,
                }
                if verdict != StageOutcome::Decided {
                    let is_undecided = verdict == StageOutcome::Undecided;
                    self.add_open(LitOpen { pixel, sample, surface, stage, is_undecided, legal });
                }
                for (stage, what, deviation) in deviations {
                    self.deviations.add(stage.name(), what, deviation);
                }
            }
            Err(Mismatch { stage, message, .. }) => {
                self.violations.push(LitViolation { pixel, sample, surface, stage, message });
            }
        }
    }
}

/// Evaluates a stage for every combination of open decisions, until one leads to the device's result.
pub(crate) fn along_choices(
    mut follow: impl FnMut(&mut Choices) -> Result<Judge, Mismatch>,
) -> Result<StageResult, Mismatch> {
    let mut choices = Choices::default();
    let mut nearest: Option<Mismatch> = None;
    loop {
        match follow(&mut choices) {
            Ok(judge) if judge.is_wide => return Ok(StageOutcome::Undecided.into()),
            Ok(_) if choices.were_open() => return Ok(StageOutcome::Open.into()),
            Ok(judge) => return Ok(judge.into()),
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
pub(crate) fn judge_pixels(
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

/// The result of a search. `alternatives` names the legal answers if there are several.
pub(crate) fn searched(is_open: bool, alternatives: impl FnOnce() -> Vec<String>) -> StageResult {
    match is_open {
        true => StageResult { alternatives: alternatives(), ..StageOutcome::Open.into() },
        false => StageOutcome::Decided.into(),
    }
}
