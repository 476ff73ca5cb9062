//! What `pinhole verify` checks: a recording, and what is known of its light.

use crate::verify_kept::Kept;
use crate::verify_output::VerifyOutputs;
use pinhole::verify::LitCertificate;
use pinhole::verify::denoised::DenoiseCertificate;
use pinhole::verify::run_file::Run;

/// What is to be checked and written.
pub(super) struct Recorded {
    pub(super) run: Run,
    pub(super) outputs: VerifyOutputs,
    /// The certificate of the light, if it was checked.
    pub(super) light: Option<LitCertificate>,
    /// The certificate of the denoiser, if the scene asks for it.
    pub(super) denoiser: Option<DenoiseCertificate>,
    /// What is kept of the light, for a run file and the page.
    pub(super) kept: Kept,
}
