//! The report of the self-test.

use std::fmt;

/// The extent of the self-test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelfTestExtent {
    /// Tests operations that round, with a few hundred inputs each. It takes a few milliseconds.
    Quick,
    /// Tests all operations, with 131,072 inputs each.
    Full,
}

/// The result of the test of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PropertyOutcome {
    /// The device has the property.
    Passed,
    /// The device has the property, and shows another behaviour that users should know.
    Noted,
    /// The device lacks the property, so error bounds are not valid for it.
    Failed,
}

/// A tested property, on which the error bounds depend.
#[derive(Clone, Debug, PartialEq)]
pub struct TestedProperty {
    /// Name of the property, a single word that does not change between versions.
    pub name: &'static str,
    /// Result of the test.
    pub outcome: PropertyOutcome,
    /// The measurements, as a sentence without a full stop.
    pub words: String,
    /// The measurements as numbers, with names that contain their units.
    pub figures: Vec<(&'static str, f64)>,
}

impl TestedProperty {
    /// Returns whether the device has the property.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.outcome != PropertyOutcome::Failed
    }
}

impl fmt::Display for TestedProperty {
    /// Writes the name and the words.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.name, self.words)
    }
}

/// The results of a self-test, property by property.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfTestReport {
    properties: Vec<TestedProperty>,
}

impl SelfTestReport {
    /// Creates a report of tested properties.
    #[must_use]
    pub fn new(properties: Vec<TestedProperty>) -> Self {
        Self { properties }
    }

    /// The report with one more property.
    #[must_use]
    pub(crate) fn with(mut self, property: TestedProperty) -> Self {
        self.properties.push(property);
        self
    }

    /// Returns all tested properties, in a fixed order.
    #[must_use]
    pub fn properties(&self) -> &[TestedProperty] {
        &self.properties
    }

    /// Returns whether the device has all properties.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.first_failure().is_none()
    }

    /// Returns the first property that the device lacks.
    #[must_use]
    pub fn first_failure(&self) -> Option<&TestedProperty> {
        self.properties.iter().find(|property| !property.passed())
    }
}

/// Counts correct and wrong results, and keeps the description of the first wrong one.
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

    /// The tested property. `words` describe the measurements if no result was wrong.
    pub(super) fn property(
        self,
        name: &'static str,
        words: String,
        mut figures: Vec<(&'static str, f64)>,
    ) -> TestedProperty {
        figures.insert(0, ("tested", self.tested as f64));
        figures.insert(1, ("wrong", self.wrong as f64));
        let (outcome, words) = match self.first {
            // A test without inputs fails.
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

/// The percentage of `part` in `all`; 0 if `all` is 0.
pub(super) fn percent(part: usize, all: usize) -> f64 {
    100.0 * part as f64 / all.max(1) as f64
}
