//! The section of a report about light.

use anyhow::Result;
use serde::Serialize;

use super::verify_light::{Counts, LightReport, Listed, ListedOpen};
use super::verify_page::grouped;
use super::verify_page_spot::{Area, Spot};
use super::verify_pictures::Window;

/// The largest numbers of violations and of open stages that are shown.
const SHOWN: usize = 12;
const SHOWN_OPEN: usize = 6;

/// What the page says about light.
#[derive(Serialize)]
pub(super) struct LightSection<'a> {
    samples: String,
    is_studio: bool,
    rows: Vec<Row>,
    violation_count: String,
    checked: String,
    upload: Option<&'a str>,
    /// The first violations.
    violations: Vec<Zoom>,
    /// The first stages that are open or undecided.
    open: Vec<Zoom>,
    /// What was checked of the picture, if that is not all of it.
    areas: Vec<Area>,
    legal: bool,
}

/// A stage of a sample, with the pixels around it.
#[derive(Serialize)]
struct Zoom {
    number: usize,
    pixel: [u32; 2],
    sample: u32,
    surface: u32,
    stage: &'static str,
    /// What the stage is about.
    meaning: &'static str,
    message: String,
    color: String,
    #[serde(flatten)]
    spot: Spot,
}

/// A row of the table of stages.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    meaning: &'static str,
    numbers: [String; 4],
}

/// What happens in the stages, and in the parts of the stage `scatter`.
const STAGES: [(&str, &str); 13] = [
    ("start", "the camera ray of a sample"),
    ("extend", "the nearest hit of a ray"),
    ("scatter", "light and the next ray at a surface, and what rays see that hit nothing"),
    ("vertex", "the point, the side and the material of the surface that is hit"),
    ("radiance", "the light that the path has gathered so far"),
    ("light", "the light that is looked for from a surface"),
    ("occlude", "whether something hides a light"),
    ("surface", "what is seen of a surface before light is searched for"),
    ("shadow", "whether something hides a light"),
    ("illuminate", "the light of the lights that are not hidden"),
    ("ambient", "whether something is near in a direction of ambient light"),
    ("gather", "the ambient light of the directions in which nothing is near"),
    ("accumulate", "the sums of a pixel, without and with the sample"),
];

const OPEN: &str = "several results are legal here, as at a silhouette or at a random choice on a boundary, and the device \
                    gave one of them";

const UNDECIDED: &str = "the result is legal, but its bounds are so wide that this says little";

/// What is said about a stage that is open or undecided.
fn message_of(open: &ListedOpen) -> String {
    match (open.is_undecided, open.legal.is_empty()) {
        (true, _) => UNDECIDED.to_owned(),
        (false, true) => OPEN.to_owned(),
        (false, false) => format!("legal is {}", open.legal.join(", or ")),
    }
}

fn meaning(stage: &str) -> &'static str {
    STAGES.into_iter().find(|(name, _)| *name == stage).map_or("", |(_, meaning)| meaning)
}

impl<'a> LightSection<'a> {
    /// The section about light in a film of this size. `draw` draws a part of the lit picture.
    pub(super) fn new(
        report: &'a LightReport,
        film: [u32; 2],
        draw: impl Fn(Window) -> Result<String>,
    ) -> Result<Self> {
        let numbers = |counts: &Counts| {
            let Counts { checked, decided, open, undecided } = *counts;
            [checked, decided, open, undecided].map(grouped)
        };
        let row = |name: &&'static str| {
            let counts = report.stages.get(name)?;
            Some(Row { name, meaning: meaning(name), numbers: numbers(counts) })
        };
        let violations = report.violations.iter().map(|violation| {
            let Listed { pixel, sample, surface, stage, message } = violation;
            (*pixel, *sample, *surface, *stage, message.clone())
        });
        let open = report
            .open
            .iter()
            .map(|open| (open.pixel, open.sample, open.surface, open.stage, message_of(open)));
        let zoom = |(number, (pixel, sample, surface, stage, message))| {
            let (window, spot) = Spot::around(pixel, film);
            let (color, meaning) = (draw(window)?, meaning(stage));
            Ok(Zoom { number, pixel, sample, surface, stage, meaning, message, color, spot })
        };
        let is_part = |of: &&[u32; 4]| of[2..] != film;
        Ok(Self {
            samples: grouped(report.paths.or(report.samples).unwrap_or_default()),
            is_studio: report.is_studio(),
            rows: report.order.iter().filter_map(row).collect(),
            violation_count: grouped(report.violation_count),
            checked: grouped(report.stages.values().map(|counts| counts.checked).sum()),
            upload: report.upload.as_deref(),
            violations: (1..=SHOWN).zip(violations).map(zoom).collect::<Result<_>>()?,
            open: (1..=SHOWN_OPEN).zip(open).map(zoom).collect::<Result<_>>()?,
            areas: report
                .rectangles
                .iter()
                .filter(is_part)
                .map(|of| Area::new(*of, film))
                .collect(),
            legal: report.legal,
        })
    }
}
