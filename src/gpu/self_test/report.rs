//! What the self-test found.

use std::fmt;

/// How much is tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelfTestExtent {
    /// Operations that round, on a few hundred inputs each: a few milliseconds.
    Quick,
    /// All, on 131,072 inputs each.
    Full,
}

/// What became of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PropertyOutcome {
    /// The device has it.
    Passed,
    /// The device has it, and does something beside it that is worth knowing.
    Noted,
    /// The device lacks it: bounds of errors do not hold there.
    Failed,
}

/// A property that the bounds of errors count on.
#[derive(Clone, Debug, PartialEq)]
pub struct TestedProperty {
    /// One word, which does not change between versions.
    pub name: &'static str,
    /// What became of it.
    pub outcome: PropertyOutcome,
    /// What was measured, in one sentence without a full stop.
    pub words: String,
    /// The same in numbers, by names that say their units.
    pub figures: Vec<(&'static str, f64)>,
}

impl TestedProperty {
    /// Whether the device has it.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.outcome != PropertyOutcome::Failed
    }
}

impl fmt::Display for TestedProperty {
    /// The name and the words.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.name, self.words)
    }
}

/// What a self-test found, property by property.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfTestReport {
    properties: Vec<TestedProperty>,
}

impl SelfTestReport {
    /// A report of what was tested.
    #[must_use]
    pub fn new(properties: Vec<TestedProperty>) -> Self {
        Self { properties }
    }

    /// All that were tested, in a fixed order.
    #[must_use]
    pub fn properties(&self) -> &[TestedProperty] {
        &self.properties
    }

    /// Whether the device has all of them.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.first_failure().is_none()
    }

    /// The first that the device lacks.
    #[must_use]
    pub fn first_failure(&self) -> Option<&TestedProperty> {
        self.properties.iter().find(|property| !property.passed())
    }
}

/// Goes through inputs and keeps the first that is wrong.
#[derive(Debug, Default)]
pub(super) struct Tally {
    tested: usize,
    wrong: usize,
    first: Option<String>,
}

impl Tally {
    pub(super) fn check(&mut self, holds: bool, words: impl FnOnce() -> String) {
        self.tested += 1;
        if !holds {
            self.wrong += 1;
            self.first.get_or_insert_with(words);
        }
    }

    pub(super) fn tested(&self) -> usize {
        self.tested
    }

    /// The property, `words` being for the case that nothing was wrong.
    pub(super) fn property(
        self,
        name: &'static str,
        words: String,
        mut figures: Vec<(&'static str, f64)>,
    ) -> TestedProperty {
        figures.insert(0, ("tested", self.tested as f64));
        figures.insert(1, ("wrong", self.wrong as f64));
        let (outcome, words) = match self.first {
            // A test of nothing is no test.
            None if self.tested == 0 => (PropertyOutcome::Failed, "nothing was tested".to_owned()),
            None => (PropertyOutcome::Passed, words),
            Some(first) => {
                let words = format!("{} of {} are wrong, first {first}", self.wrong, self.tested);
                (PropertyOutcome::Failed, words)
            }
        };
        TestedProperty { name, outcome, words, figures }
    }
}

/// What part of all, in percent; 0 of nothing.
pub(super) fn percent(part: usize, all: usize) -> f64 {
    100.0 * part as f64 / all.max(1) as f64
}
