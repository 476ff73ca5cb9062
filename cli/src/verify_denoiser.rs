//! The denoiser in `pinhole verify`: of a scene whose picture is denoised, what the device makes of a noisy picture.

use anyhow::{Context, Result};
use serde::Serialize;

use super::verify_listed::LISTED;
use pinhole::image::Image;
use pinhole::verify::denoised::{self, DenoiseCertificate};

#[cfg(feature = "gpu")]
mod rendered;

#[cfg(feature = "gpu")]
pub(super) use rendered::render;

/// The object `denoiser` of the JSON document.
#[derive(Serialize)]
pub(super) struct DenoiserReport {
    pixels: u64,
    undecided: u64,
    violation_count: u64,
    violations: Vec<String>,
    outcome: &'static str,
}

impl From<&DenoiseCertificate> for DenoiserReport {
    fn from(certificate: &DenoiseCertificate) -> Self {
        let DenoiseCertificate { pixels, undecided, violation_count, ref violations, .. } =
            *certificate;
        Self {
            pixels,
            undecided,
            violation_count,
            violations: violations.iter().take(LISTED).map(ToString::to_string).collect(),
            outcome: certificate.outcome().name(),
        }
    }
}

impl DenoiserReport {
    /// The report as one line of text.
    pub(super) fn line(&self) -> String {
        let Self { pixels, undecided, violation_count, .. } = self;
        let legal = pixels - undecided - violation_count;
        format!(
            "denoiser: {pixels} pixels: {legal} legal, {undecided} undecided, {violation_count} violations"
        )
    }
}

/// Judges what the device made of a noisy picture.
pub(super) fn judge([noisy, quiet]: &[Image; 2]) -> Result<DenoiseCertificate> {
    denoised::certify(noisy, quiet).context("the denoiser cannot be checked")
}
