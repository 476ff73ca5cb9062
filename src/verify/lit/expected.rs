//! The comparison of what a kernel wrote with what it may have written, number by number.

use std::fmt;

use super::recording::PathState;
use super::stage::LitStage;
use crate::verify::bias::deviation;
use crate::verify::number::{Number, Vector};
use crate::verify::rounding::Interval;

/// The relative width above which a bound says nothing.
const WIDE: f64 = 0.1;

/// A result of a device that is not legal.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) struct Mismatch {
    pub(in crate::verify) stage: LitStage,
    pub(in crate::verify) what: &'static str,
    pub(in crate::verify) answer: Answer,
    /// The number of comparisons that succeeded before.
    pub(in crate::verify) after: u32,
}

#[derive(Clone, Debug, PartialEq)]
pub(in crate::verify) enum Answer {
    Number { found: f32, legal: Interval },
    Bits { found: u32, legal: u32 },
    Words(String),
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, answer, .. } = self;
        match answer {
            Answer::Number { found, legal } => write!(f, "{what} is {found:?}; legal is {legal}"),
            Answer::Bits { found, legal } => write!(f, "{what} is {found:#x}; legal is {legal:#x}"),
            Answer::Words(words) => write!(f, "{what}: {words}"),
        }
    }
}

/// Compares results with legal ones, and records whether a bound is too wide to say anything.
#[derive(Debug, Default)]
pub(in crate::verify) struct Expected {
    passed: u32,
    /// Whether some bound was too wide to say anything.
    pub(in crate::verify) is_wide: bool,
    /// How far numbers are from the middle of their bounds.
    pub(in crate::verify) deviations: Vec<(LitStage, &'static str, f64)>,
}

impl Expected {
    fn mismatch(&self, stage: LitStage, what: &'static str, answer: Answer) -> Mismatch {
        Mismatch { stage, what, answer, after: self.passed }
    }

    /// Compares integers.
    pub(in crate::verify) fn bits(
        &mut self,
        (stage, what): (LitStage, &'static str),
        found: u32,
        legal: u32,
    ) -> Result<(), Mismatch> {
        if found != legal {
            return Err(self.mismatch(stage, what, Answer::Bits { found, legal }));
        }
        self.passed += 1;
        Ok(())
    }

    /// Compares a number; its bound is narrow or wide relative to `scale`.
    fn within(
        &mut self,
        (stage, what): (LitStage, &'static str),
        found: f32,
        legal: Interval,
        scale: f64,
    ) -> Result<(), Mismatch> {
        if !legal.contains(found.into()) {
            return Err(self.mismatch(stage, what, Answer::Number { found, legal }));
        }
        self.passed += 1;
        let deviation = deviation(found.into(), legal);
        self.deviations.extend(deviation.map(|deviation| (stage, what, deviation)));
        self.is_wide |= legal.high - legal.low > WIDE * scale + f64::from(f32::MIN_POSITIVE) * 4.0;
        Ok(())
    }

    pub(in crate::verify) fn number(
        &mut self,
        name: (LitStage, &'static str),
        found: f32,
        legal: Number,
    ) -> Result<(), Mismatch> {
        self.number_of(name, found, legal, 0.0)
    }

    /// Compares a number; its bound is narrow or wide relative to `size` or to itself.
    pub(in crate::verify) fn number_of(
        &mut self,
        name: (LitStage, &'static str),
        found: f32,
        legal: Number,
        size: f64,
    ) -> Result<(), Mismatch> {
        let legal = legal.interval();
        self.within(name, found, legal, legal.high.abs().max(legal.low.abs()).max(size))
    }

    /// Compares a vector; its bounds are narrow or wide relative to its largest component.
    pub(in crate::verify) fn vector(
        &mut self,
        name: (LitStage, &'static str),
        found: [f32; 3],
        legal: Vector,
    ) -> Result<(), Mismatch> {
        self.vector_of(name, found, legal, 0.0)
    }

    /// Compares a vector; its bounds are narrow or wide relative to `size` or its largest component.
    pub(in crate::verify) fn vector_of(
        &mut self,
        name: (LitStage, &'static str),
        found: [f32; 3],
        legal: Vector,
        size: f64,
    ) -> Result<(), Mismatch> {
        let legal = legal.intervals();
        let scale =
            legal.iter().map(|axis| axis.high.abs().max(axis.low.abs())).fold(size, f64::max);
        found
            .into_iter()
            .zip(legal)
            .try_for_each(|(found, legal)| self.within(name, found, legal, scale))
    }

    /// Checks that a slot has not changed.
    pub(in crate::verify) fn same(
        &mut self,
        name: (LitStage, &'static str),
        [before, after]: [&PathState; 2],
        slot: usize,
    ) -> Result<(), Mismatch> {
        let pairs = after.slots[slot].into_iter().zip(before.slots[slot]);
        pairs.into_iter().try_for_each(|(found, legal)| self.bits(name, found, legal))
    }

    pub(in crate::verify) fn fail(
        &self,
        stage: LitStage,
        what: &'static str,
        words: String,
    ) -> Mismatch {
        self.mismatch(stage, what, Answer::Words(words))
    }
}
