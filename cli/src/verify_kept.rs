//! What `pinhole verify` keeps of a lit picture for a run file and for the page.

use std::path::Path;

use anyhow::{Context, Result};

#[cfg(feature = "gpu")]
use super::output;
use super::read_file::open_seekable;
use super::{progress, verify_denoiser};
use pinhole::image::Image;
use pinhole::verify::denoised::DenoiseCertificate;
use pinhole::verify::run_file::{Extras, LitSamples, Run, RunFile, ShownPicture};
use pinhole::verify::{Checker, LitCertificate};

/// What is kept of a lit picture.
#[derive(Default)]
pub(super) struct Kept {
    /// The samples that were recorded, if a run file is written.
    pub(super) samples: Option<LitSamples>,
    /// The noisy picture and the denoised one.
    pub(super) denoised: Option<[Image; 2]>,
    /// The lit picture for people.
    pub(super) shown: Option<ShownPicture>,
}

impl Kept {
    /// Nothing yet. If a run file is written, samples will be kept in a temporary file beside it.
    #[cfg(feature = "gpu")]
    pub(super) fn beside(save: Option<&Path>) -> Result<Self> {
        let spool = save.map(output::scratch).transpose()?;
        let samples = spool.map(|spool| LitSamples::new(Box::new(spool)));
        Ok(Self { samples, ..Self::default() })
    }

    /// What a run file holds of it.
    pub(super) fn extras(&self) -> Extras<'_> {
        Extras {
            light: self.samples.as_ref(),
            denoised: self.denoised.as_ref().map(|[noisy, quiet]| [noisy, quiet]),
            shown: self.shown.as_ref(),
        }
    }
}

/// A run that was read, and the certificates of its light.
pub(super) struct Replayed {
    pub(super) run: Run,
    pub(super) light: Option<LitCertificate>,
    pub(super) denoiser: Option<DenoiseCertificate>,
    pub(super) kept: Kept,
}

/// Reads a run file and judges the light in it, sample by sample.
pub(super) fn replay(path: &Path) -> Result<Replayed> {
    progress::stage(format!("reading {}", path.display()));
    let mut source = open_seekable(path)?;
    let of_file = || path.display().to_string();
    let file = RunFile::open(&mut source).with_context(of_file)?;
    let run = file.run().with_context(of_file)?;
    let checker = Checker::new(&run.scene).context("the checker cannot be prepared")?;
    progress::stage("checking light");
    let mut certificate = LitCertificate::default();
    let has_light = file.light(&run, &mut |recording| {
        certificate.join(checker.certify_lit(recording));
    });
    let has_light = has_light.with_context(of_file)?;
    drop(checker);
    let denoised = file.denoised().with_context(of_file)?;
    let denoiser = denoised.as_ref().map(verify_denoiser::judge).transpose()?;
    let kept = Kept { shown: file.shown().with_context(of_file)?, ..Kept::default() };
    Ok(Replayed { run, light: has_light.then_some(certificate), denoiser, kept })
}
