//! The section of a report about light paths.

use serde::Serialize;

use super::verify_page::grouped;
use super::verify_paths::{Counts, Listed, PathReport};

/// The largest number of violations that are shown.
const SHOWN: usize = 12;

/// What the page says about light paths.
#[derive(Serialize)]
pub(super) struct PathSection<'a> {
    paths: String,
    rows: Vec<Row>,
    violation_count: String,
    checked: String,
    upload: Option<&'a str>,
    violations: &'a [Listed],
    legal: bool,
}

/// A row of the table of stages.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    meaning: &'static str,
    numbers: [String; 4],
}

/// The stages in the order in which a path passes through them.
const STAGES: [(&str, &str); 5] = [
    ("start", "the camera ray of a sample"),
    ("extend", "the nearest hit of a ray"),
    ("scatter", "light and the next ray at a surface, and what rays see that hit nothing"),
    ("occlude", "whether something hides a light"),
    ("accumulate", "what a sample adds to its pixel"),
];

impl<'a> PathSection<'a> {
    pub(super) fn new(report: &'a PathReport) -> Self {
        let numbers = |counts: &Counts| {
            let Counts { checked, decided, open, undecided } = *counts;
            [checked, decided, open, undecided].map(grouped)
        };
        let row = |(name, meaning)| {
            report.stages.get(name).map(|counts| Row { name, meaning, numbers: numbers(counts) })
        };
        let shown = report.violations.len().min(SHOWN);
        Self {
            paths: grouped(report.paths),
            rows: STAGES.into_iter().filter_map(row).collect(),
            violation_count: grouped(report.violation_count),
            checked: grouped(report.stages.values().map(|counts| counts.checked).sum()),
            upload: report.upload.as_deref(),
            violations: &report.violations[..shown],
            legal: report.legal,
        }
    }
}
