//! `pinhole verify` of a scene with path tracing: checks some samples of every pixel, stage by stage.

use std::collections::BTreeMap;

use serde::Serialize;

use super::verify_report::LISTED;
use pinhole::verify::{PathCertificate, PathViolation, StageCounts};

/// The object `paths` of the JSON document.
#[derive(Serialize)]
pub(super) struct PathReport {
    pub(super) paths: u64,
    pub(super) stages: BTreeMap<&'static str, Counts>,
    pub(super) upload: Option<String>,
    pub(super) violation_count: u64,
    pub(super) violations: Vec<Listed>,
    pub(super) outcome: &'static str,
    pub(super) legal: bool,
    /// The certificate as one line of text.
    #[serde(skip)]
    pub(super) line: String,
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
    pixel: [u32; 2],
    sample: u32,
    surface: u32,
    stage: &'static str,
    message: String,
}

impl From<StageCounts> for Counts {
    fn from(StageCounts { checked, decided, open, undecided, .. }: StageCounts) -> Self {
        Self { checked, decided, open, undecided }
    }
}

impl From<&PathViolation> for Listed {
    fn from(violation: &PathViolation) -> Self {
        let PathViolation { pixel, sample, surface, stage, message, .. } = violation;
        let (stage, message) = (stage.name(), message.clone());
        Self { pixel: *pixel, sample: *sample, surface: *surface, stage, message }
    }
}

impl From<&PathCertificate> for PathReport {
    fn from(certificate: &PathCertificate) -> Self {
        let PathCertificate { start, extend, scatter, occlude, accumulate, .. } = *certificate;
        let stages = [
            ("start", start),
            ("extend", extend),
            ("scatter", scatter),
            ("occlude", occlude),
            ("accumulate", accumulate),
        ];
        Self {
            paths: certificate.paths,
            stages: stages.map(|(name, counts)| (name, counts.into())).into(),
            upload: certificate.upload.as_ref().map(ToString::to_string),
            violation_count: certificate.violation_count,
            violations: certificate.violations.iter().take(LISTED).map(Listed::from).collect(),
            outcome: certificate.outcome().name(),
            legal: certificate.is_legal(),
            line: certificate.to_string(),
        }
    }
}

#[cfg(feature = "gpu")]
pub(super) use recorded::certify;

#[cfg(feature = "gpu")]
mod recorded {
    use anyhow::Context;

    use super::*;
    use crate::device::explained_alone;
    use crate::failure::Failure;
    use crate::input::Input;
    use crate::views::Views;
    use crate::with_scene::{upload, with_structures};
    use crate::{interrupt, progress, render};
    use pinhole::accel::AccelChoice;
    use pinhole::gpu::Headless;
    use pinhole::image::LayerSet;
    use pinhole::verify::Checker;

    /// Records this number of samples on an adapter, one after the other, and checks them.
    pub(crate) fn certify(
        headless: &Headless,
        input: &Input,
        samples: u32,
        choice: AccelChoice,
    ) -> Result<PathCertificate, Failure> {
        let Input { scene, settings, .. } = input;
        let (view, views) = (input.view(), Views::of(input));
        let plan = |choice| render::plan(headless, input, &views, LayerSet::COLOR, choice);
        let done = with_structures(headless, choice, plan, |plan| {
            let uploaded = interrupt::on_device(|| upload(headless, scene, plan))?;
            let buffers = match uploaded {
                Ok(buffers) => buffers,
                Err(error) => return Ok(Err(error)),
            };
            let checker = Checker::new(scene).context("the checker cannot be prepared")?;
            let mut certificate = PathCertificate::default();
            for sample in 0..samples {
                progress::stage(format!("following paths: sample {sample}"));
                let recording = interrupt::on_device(|| {
                    let watch = &mut |_: &_| interrupt::decide();
                    let range = sample..sample + 1;
                    headless.record_paths(&buffers, &view, settings, range, watch)
                })?;
                match recording {
                    Ok(recording) => {
                        progress::stage("checking paths");
                        certificate.join(checker.certify_paths(&recording));
                    }
                    Err(error) => return Ok(Err(error)),
                }
            }
            Ok(Ok(certificate))
        })?;
        let (certificate, _) = done.map_err(|error| explained_alone(headless, &error))?;
        Ok(certificate)
    }
}
