//! The section of a report about light.

use serde::Serialize;

use super::verify_light::{Counts, LightReport, Listed};
use super::verify_page::grouped;

/// The largest number of violations that are shown.
const SHOWN: usize = 12;

/// What the page says about light.
#[derive(Serialize)]
pub(super) struct LightSection<'a> {
    samples: String,
    is_studio: bool,
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

/// What happens in the stages.
const STAGES: [(&str, &str); 10] = [
    ("start", "the camera ray of a sample"),
    ("extend", "the nearest hit of a ray"),
    ("scatter", "light and the next ray at a surface, and what rays see that hit nothing"),
    ("occlude", "whether something hides a light"),
    ("surface", "what is seen of a surface before light is searched for"),
    ("shadow", "whether something hides a light"),
    ("illuminate", "the light of the lights that are not hidden"),
    ("ambient", "whether something is near in a direction of ambient light"),
    ("gather", "the ambient light of the directions in which nothing is near"),
    ("accumulate", "the sums of a pixel, without and with the sample"),
];

impl<'a> LightSection<'a> {
    pub(super) fn new(report: &'a LightReport) -> Self {
        let numbers = |counts: &Counts| {
            let Counts { checked, decided, open, undecided } = *counts;
            [checked, decided, open, undecided].map(grouped)
        };
        let row = |name: &&'static str| {
            let (name, meaning) = STAGES.into_iter().find(|(stage, _)| stage == name)?;
            report.stages.get(name).map(|counts| Row { name, meaning, numbers: numbers(counts) })
        };
        let shown = report.violations.len().min(SHOWN);
        Self {
            samples: grouped(report.paths.or(report.samples).unwrap_or_default()),
            is_studio: report.is_studio(),
            rows: report.order.iter().filter_map(row).collect(),
            violation_count: grouped(report.violation_count),
            checked: grouped(report.stages.values().map(|counts| counts.checked).sum()),
            upload: report.upload.as_deref(),
            violations: &report.violations[..shown],
            legal: report.legal,
        }
    }
}
