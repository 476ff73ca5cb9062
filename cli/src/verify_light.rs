//! `pinhole verify` of a scene with light: checks some samples of every pixel, stage by stage.

use std::collections::BTreeMap;

use serde::Serialize;

use super::verify_listed::LISTED;
use pinhole::verify::{LitCertificate, LitOpen, LitShare, LitViolation, StageCounts};

#[cfg(feature = "gpu")]
mod recorded;

#[cfg(feature = "gpu")]
pub(super) use recorded::certify;

/// The largest number of open searches in the table.
const LINES: usize = 3;

/// The object `paths` or `studio` of the JSON document.
#[derive(Serialize)]
pub(super) struct LightReport {
    /// Number of paths, or of samples of a studio.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) paths: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) samples: Option<u64>,
    pub(super) stages: BTreeMap<&'static str, Counts>,
    /// First column and row, width and height of the parts of the film in which samples were checked.
    pub(super) rectangles: Vec<[u32; 4]>,
    pub(super) judged: Judged,
    pub(super) upload: Option<String>,
    pub(super) violation_count: u64,
    pub(super) violations: Vec<Listed>,
    pub(super) outcome: &'static str,
    pub(super) legal: bool,
    /// The certificate as one line of text.
    #[serde(skip)]
    pub(super) line: String,
    /// The first stages with several legal results, and those of which the check says little.
    pub(super) open: Vec<ListedOpen>,
}

impl LightReport {
    /// Lines of text about the counts, and about the first open searches.
    pub(super) fn lines(&self) -> String {
        let open = self.open.iter().filter(|open| !open.legal.is_empty());
        let lines = open.take(LINES).map(|open| format!("open: {}\n", open.line));
        std::iter::once(format!("{}\n", self.line)).chain(lines).collect()
    }

    /// Whether nothing is known to be wrong.
    pub(super) fn is_without_fault(&self) -> bool {
        self.violation_count == 0 && self.upload.is_none()
    }
}

/// How much of the picture was judged.
#[derive(Serialize)]
pub(super) struct Judged {
    samples: u64,
    of_samples: u64,
    pixels: u64,
    of_pixels: u64,
    fraction: f64,
}

impl From<LitShare> for Judged {
    fn from(share: LitShare) -> Self {
        let LitShare { samples, of_samples, pixels, of_pixels, .. } = share;
        Self { samples, of_samples, pixels, of_pixels, fraction: share.fraction() }
    }
}

impl Judged {
    /// The share in words.
    pub(super) fn words(&self) -> String {
        let Self { samples, of_samples, pixels, of_pixels, fraction } = self;
        // Rounded down, so that nothing but all of them is called 100 %.
        let percent = (fraction * 1e6).floor() / 1e4;
        format!(
            "{percent} % of the samples of its light ({samples} of {of_samples} in {pixels} of {of_pixels} pixels)"
        )
    }
}

/// A stage that is open, or of which the check says little.
#[derive(Serialize)]
pub(super) struct ListedOpen {
    pub(super) pixel: [u32; 2],
    pub(super) sample: u32,
    pub(super) surface: u32,
    pub(super) stage: &'static str,
    pub(super) is_undecided: bool,
    /// Of an open search, up to four legal answers.
    pub(super) legal: Vec<String>,
    /// The same as one line of text.
    #[serde(skip)]
    pub(super) line: String,
}

impl From<&LitOpen> for ListedOpen {
    fn from(open: &LitOpen) -> Self {
        let LitOpen { pixel, sample, surface, stage, is_undecided, ref legal, .. } = *open;
        let (stage, legal, line) = (stage.name(), legal.clone(), open.to_string());
        Self { pixel, sample, surface, stage, is_undecided, legal, line }
    }
}

#[derive(Serialize)]
pub(super) struct Counts {
    pub(super) checked: u64,
    pub(super) decided: u64,
    pub(super) open: u64,
    pub(super) undecided: u64,
}

#[derive(Serialize)]
pub(super) struct Listed {
    pub(super) pixel: [u32; 2],
    pub(super) sample: u32,
    pub(super) surface: u32,
    pub(super) stage: &'static str,
    pub(super) message: String,
}

impl From<StageCounts> for Counts {
    fn from(StageCounts { checked, decided, open, undecided, .. }: StageCounts) -> Self {
        Self { checked, decided, open, undecided }
    }
}

impl From<&LitViolation> for Listed {
    fn from(violation: &LitViolation) -> Self {
        let LitViolation { pixel, sample, surface, stage, message, .. } = violation;
        let (stage, message) = (stage.name(), message.clone());
        Self { pixel: *pixel, sample: *sample, surface: *surface, stage, message }
    }
}

impl From<&LitCertificate> for LightReport {
    fn from(certificate: &LitCertificate) -> Self {
        let LitCertificate { paths, is_studio, .. } = *certificate;
        let stages = certificate.named();
        Self {
            paths: (!is_studio).then_some(paths),
            samples: is_studio.then_some(paths),
            stages: stages.into_iter().map(|(name, counts)| (name, counts.into())).collect(),
            rectangles: certificate.rectangles.clone(),
            judged: certificate.share().into(),
            open: certificate.open.iter().map(ListedOpen::from).collect(),
            upload: certificate.upload.as_ref().map(ToString::to_string),
            violation_count: certificate.violation_count,
            violations: certificate.violations.iter().take(LISTED).map(Listed::from).collect(),
            outcome: certificate.outcome().name(),
            legal: certificate.is_legal(),
            line: certificate.to_string(),
        }
    }
}
