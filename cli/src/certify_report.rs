//! The report of `pinhole certify`, as JSON and as text.

use std::collections::BTreeMap;

use serde::Serialize;

use super::input::Input;
use super::verify_report::{Scene, command_line};
use pinhole::image::NO_ID;
use pinhole::verify::Outcome;
use pinhole::verify::conformance::{Answers, Conformance, DepthKind, Finding};
use pinhole::verify::run_file::scene_sha256;

/// The number of pixels that the text lists.
const LISTED: usize = 10;

/// The JSON document.
#[derive(Serialize)]
pub(super) struct Report {
    version: &'static str,
    scene: Scene,
    picture: Picture,
    checked: Vec<&'static str>,
    at_most: f64,
    counts: BTreeMap<&'static str, usize>,
    decided_fraction: f64,
    largest: Option<f64>,
    histogram: Vec<Bin>,
    worst: Vec<Listed>,
    outcome: &'static str,
    command: String,
    /// The results as a table of text.
    #[serde(skip)]
    table: String,
}

#[derive(Serialize)]
struct Picture {
    width: u32,
    height: u32,
    /// The camera, unless rays were given.
    camera: Option<&'static str>,
}

#[derive(Serialize)]
struct Bin {
    up_to: Option<f64>,
    count: usize,
}

/// A pixel with its message.
#[derive(Serialize)]
struct Listed {
    pixel: [u32; 2],
    id: Option<u32>,
    depth: Option<f64>,
    outcome: &'static str,
    k: Option<f64>,
    margin: Option<f64>,
    reason: &'static str,
    exact_id: Option<u32>,
    exact_distance: Option<f64>,
    message: String,
}

/// A finite number, which JSON can hold.
fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

impl From<&Finding> for Listed {
    fn from(finding: &Finding) -> Self {
        let id = Some(finding.id).filter(|id| *id != NO_ID);
        Self {
            pixel: finding.pixel,
            id,
            depth: id.and(finding.depth),
            outcome: finding.outcome.name(),
            k: finite(finding.least),
            margin: finite(finding.margin),
            reason: finding.reason.name(),
            exact_id: finding.exact.map(|(id, _)| id),
            exact_distance: finding.exact.map(|(_, t)| t),
            message: finding.to_string(),
        }
    }
}

impl Report {
    pub(super) fn new(
        input: &Input,
        answers: &Answers<'_>,
        has_rays: bool,
        found: &Conformance,
    ) -> Self {
        let [width, height] = found.size;
        let depth = match answers.depth_kind {
            DepthKind::Distance => "depth as t",
            DepthKind::AlongAxis => "depth as z",
        };
        let checked =
            [Some("id"), answers.depths.map(|_| depth), answers.normals.map(|_| "normal")];
        let count = |outcome: &Outcome| (outcome.name(), found.count(*outcome));
        Self {
            version: env!("CARGO_PKG_VERSION"),
            scene: Scene { spheres: input.scene.len(), sha256: scene_sha256(&input.scene) },
            picture: Picture {
                width,
                height,
                camera: (!has_rays).then(|| input.camera.kind().name()),
            },
            checked: checked.into_iter().flatten().collect(),
            at_most: found.at_most,
            counts: Outcome::ALL.iter().map(count).collect(),
            decided_fraction: found.decided_fraction(),
            largest: finite(found.largest()),
            histogram: found
                .histogram()
                .into_iter()
                .map(|(up_to, count)| Bin { up_to: finite(up_to), count })
                .collect(),
            worst: found.worst.iter().map(Listed::from).collect(),
            outcome: found.outcome().name(),
            command: command_line(),
            table: table(found),
        }
    }

    /// Returns the report as text.
    pub(super) fn table(&self) -> String {
        let Scene { spheres, sha256 } = &self.scene;
        let Picture { width, height, camera } = self.picture;
        let rays = camera.map_or("given rays".to_owned(), |camera| format!("{camera} camera"));
        format!(
            "scene: {spheres} spheres, {} bytes, sha256 {sha256}\npicture: {width}x{height}, {rays}\n\
             checked: {}\n{}{}\n",
            16 * spheres,
            self.checked.join(", "),
            self.table,
            self.outcome
        )
    }
}

/// Returns the counts, the histogram, and the first of the worst pixels.
fn table(found: &Conformance) -> String {
    let mut text = found.to_string();
    // The first is there already.
    for finding in found.worst.iter().take(LISTED).skip(1) {
        text += &format!("\n       {finding}");
    }
    text + "\n"
}
