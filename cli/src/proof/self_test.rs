//! Parts of `pinhole info`: the self-test of a device, and the files of all kernels.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use serde::Serialize;

use crate::output::files::{NewFolder, name_all, unnamed};
use crate::proof::quick_test::failure;
use crate::render::device::{AdapterReport, WantedAdapter, explained_alone};
use crate::terminal::failure::Failure;
use crate::terminal::interrupt;
use crate::terminal::progress::{self, answer};
use pinhole::gpu::{Headless, PropertyOutcome, SelfTestExtent, SelfTestReport, TestedProperty, Wait, composed_kernels};

/// The results of the self-test of an adapter.
#[derive(Serialize)]
pub(crate) struct SelfTestResults {
    adapter: AdapterReport,
    passed: bool,
    properties: Vec<PropertyReport>,
    /// The message about the first property that failed.
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

impl SelfTestResults {
    /// Opens an adapter and runs the full test.
    pub(crate) fn new(wanted: &WantedAdapter) -> Result<Self, Failure> {
        let headless = wanted.open_any()?;
        let report = test(&headless)?;
        progress::clear();
        Ok(Self {
            adapter: AdapterReport::of(headless.adapter_info()),
            passed: report.passed(),
            properties: report.properties().iter().map(PropertyReport::new).collect(),
            failure: failure(&headless.adapter_info().name, &report),
        })
    }

    pub(crate) fn readable(&self) -> String {
        let mut text = self.adapter.line() + "\n";
        for PropertyReport { name, outcome, words, .. } in &self.properties {
            text += &format!("  {outcome:<6}  {name}: {words}\n");
        }
        text
    }

    /// Returns the failure if a property failed.
    pub(crate) fn verdict(&self) -> Result<(), Failure> {
        check_failed(self.failure.as_deref())
    }
}

/// Runs the full test on an open adapter, and returns a failure if a property failed.
pub(crate) fn check(headless: &Headless) -> Result<(), Failure> {
    let report = test(headless)?;
    check_failed(failure(&headless.adapter_info().name, &report).as_deref())
}

fn test(headless: &Headless) -> Result<SelfTestReport, Failure> {
    progress::stage("testing the adapter");
    let tested = interrupt::on_device(|| headless.self_test(SelfTestExtent::Full).wait())?;
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

/// The list of pipelines: the file of the kernel, and the values of its `override` constants.
const PIPELINES: &str = "pipelines.txt";

/// Writes all kernels and the list of pipelines into a folder, or nothing.
pub(crate) fn dump(folder: &Path) -> Result<(), Failure> {
    let mut kernels: Vec<(PathBuf, String)> = Vec::new();
    let mut pipelines = String::new();
    for kernel in composed_kernels() {
        let file = file_name(&kernel.name);
        for constants in &kernel.pipelines {
            let constants = constants.iter().map(|(name, value)| format!(" {name}={value}"));
            pipelines += &format!("{file}{}\n", constants.collect::<String>());
        }
        kernels.push((folder.join(file), kernel.source));
    }
    let text = format!(
        "{}: {} kernels, and {PIPELINES} with the constants of {} pipelines\n",
        folder.display(),
        kernels.len(),
        pipelines.lines().count(),
    );
    kernels.push((folder.join(PIPELINES), pipelines));
    let first = kernels.first().map(|(path, _)| path.clone()).unwrap_or_default();
    NewFolder::new(folder, &first.file_name().unwrap_or_default().to_string_lossy())?.with(|| {
        let files = kernels.iter().map(|(path, source)| Ok((path, unnamed(path, source.as_bytes())?)));
        name_all(files.collect::<anyhow::Result<Vec<_>>>()?)
    })?;
    Ok(answer(text.as_bytes())?)
}

/// Makes the name of a file from the words that distinguish a kernel.
fn file_name(kernel: &str) -> String {
    kernel.replace([' ', '#'], "-") + ".wgsl"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tested(failure: Option<&str>) -> SelfTestResults {
        let text = || "some".to_owned();
        let adapter =
            AdapterReport { name: text(), backend: text(), device_type: text(), driver: text(), driver_info: text() };
        let property = PropertyReport {
            name: "fence",
            passed: failure.is_none(),
            outcome: if failure.is_none() { "ok" } else { "FAILED" },
            words: "the words".to_owned(),
            figures: BTreeMap::from([("tested", 3.0)]),
        };
        let failure = failure.map(str::to_owned);
        SelfTestResults { adapter, passed: failure.is_none(), properties: vec![property], failure }
    }

    #[test]
    fn a_property_that_fails_is_marked_and_is_the_programs_failure() {
        let failed = tested(Some("some fails the self-test (fence: the words)"));
        assert!(failed.readable().contains("\n  FAILED  fence: the words\n"));
        match failed.verdict() {
            Err(failure @ Failure::CheckFailed(_)) => {
                assert_eq!(failure.to_string(), "error: some fails the self-test (fence: the words)");
                assert_eq!(failure.exit_code(), crate::terminal::failure::CHECK_FAILED.into());
            }
            other => panic!("{other:?}"),
        }
        let passed = tested(None);
        assert!(passed.readable().contains("\n  ok      fence: the words\n"));
        assert!(passed.verdict().is_ok());
    }
}
