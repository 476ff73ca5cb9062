//! The full self-test of an adapter, for `pinhole info` and `verify`.

use std::collections::BTreeMap;

use anyhow::anyhow;
use serde::Serialize;

use super::adapter::AdapterReport;
use super::device::{WantedAdapter, explained_alone};
use super::failure::Failure;
use super::quick_test::failure;
use super::{interrupt, progress};
use pinhole::gpu::{Headless, PropertyOutcome, SelfTestExtent, SelfTestReport, TestedProperty};

/// The results of the self-test of an adapter.
#[derive(Serialize)]
pub(super) struct SelfTested {
    adapter: AdapterReport,
    passed: bool,
    properties: Vec<PropertyReport>,
    /// The first property that failed.
    #[serde(skip)]
    failure: Option<String>,
}

#[derive(Serialize)]
struct PropertyReport {
    name: &'static str,
    passed: bool,
    outcome: &'static str,
    words: String,
    figures: BTreeMap<&'static str, f64>,
}

impl SelfTested {
    /// Opens an adapter and runs the full test.
    pub(super) fn new(wanted: &WantedAdapter) -> Result<Self, Failure> {
        let headless = wanted.open_any()?;
        let report = test(&headless)?;
        progress::clear();
        Ok(Self {
            adapter: AdapterReport::of(&headless),
            passed: report.passed(),
            properties: report.properties().iter().map(PropertyReport::new).collect(),
            failure: failure(&headless.adapter_info().name, &report),
        })
    }

    pub(super) fn readable(&self) -> String {
        let mut text = self.adapter.line() + "\n";
        for PropertyReport { name, outcome, words, .. } in &self.properties {
            text += &format!("  {outcome:<6}  {name}: {words}\n");
        }
        text
    }

    /// Returns a failure if a property failed.
    pub(super) fn verdict(&self) -> Result<(), Failure> {
        check_failed(self.failure.as_deref())
    }
}

/// Runs the full test on an open adapter, and returns a failure if a property failed.
pub(super) fn check(headless: &Headless) -> Result<(), Failure> {
    let report = test(headless)?;
    check_failed(failure(&headless.adapter_info().name, &report).as_deref())
}

fn test(headless: &Headless) -> Result<SelfTestReport, Failure> {
    progress::stage("testing the adapter");
    let tested = interrupt::on_device(|| headless.self_test(SelfTestExtent::Full))?;
    tested.map_err(|error| explained_alone(headless, &error))
}

fn check_failed(failure: Option<&str>) -> Result<(), Failure> {
    failure.map_or(Ok(()), |failure| Err(Failure::CheckFailed(anyhow!("{failure}"))))
}

impl PropertyReport {
    fn new(property: &TestedProperty) -> Self {
        let TestedProperty { name, outcome, ref words, ref figures } = *property;
        Self {
            name,
            passed: property.passed(),
            outcome: match outcome {
                PropertyOutcome::Passed => "ok",
                PropertyOutcome::Noted => "note",
                PropertyOutcome::Failed => "FAILED",
            },
            words: words.clone(),
            figures: figures.iter().copied().collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tested(failure: Option<&str>) -> SelfTested {
        let text = || "some".to_owned();
        let adapter = AdapterReport {
            name: text(),
            backend: text(),
            device_type: text(),
            driver: text(),
            driver_info: text(),
        };
        let property = PropertyReport {
            name: "fence",
            passed: failure.is_none(),
            outcome: if failure.is_none() { "ok" } else { "FAILED" },
            words: "the words".to_owned(),
            figures: BTreeMap::from([("tested", 3.0)]),
        };
        let failure = failure.map(str::to_owned);
        SelfTested { adapter, passed: failure.is_none(), properties: vec![property], failure }
    }

    #[test]
    fn a_property_that_fails_is_marked_and_is_the_programs_failure() {
        let failed = tested(Some("some fails the self-test (fence: the words)"));
        assert!(failed.readable().contains("\n  FAILED  fence: the words\n"));
        match failed.verdict() {
            Err(failure @ Failure::CheckFailed(_)) => {
                assert_eq!(
                    failure.to_string(),
                    "error: some fails the self-test (fence: the words)"
                );
                assert_eq!(failure.exit_code(), super::super::failure::CHECK_FAILED.into());
            }
            other => panic!("{other:?}"),
        }
        let passed = tested(None);
        assert!(passed.readable().contains("\n  ok      fence: the words\n"));
        assert!(passed.verdict().is_ok());
    }
}
