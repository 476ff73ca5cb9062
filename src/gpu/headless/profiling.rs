//! What a device notes for its profile, and submissions whose passes it notes.

use std::time::Duration;

use wgpu::CommandEncoder;

use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::waiting::Instant;
use crate::gpu::passes::tiles::Groups;
use crate::gpu::profile::{PassNames, ProfilePhase};
use crate::gpu::scene::scene_buffers::SceneBuffers;

impl Headless {
    /// What notes the passes of one submission.
    pub(crate) fn pass_names(&self) -> PassNames {
        PassNames(self.options.profile.as_ref().map(|_| Vec::new()))
    }

    /// Whether every pass is submitted by itself, so that the host's clock can measure it for a profile.
    pub(crate) fn submits_one_by_one(&self) -> bool {
        self.options.profile.is_some()
    }

    /// Adds the passes of a submission to the profile, which has just finished. The device may have begun with it at
    /// `began`.
    pub(crate) fn note_passes(&self, names: &PassNames, began: Instant) {
        if let (Some(profile), Some(name)) = (&self.options.profile, names.of_last()) {
            profile.add_pass(name, began.elapsed());
        }
    }

    /// Begins a phase of the host, if there is a profile.
    pub(crate) fn phase(&self, name: &'static str) -> Option<ProfilePhase> {
        self.options.profile.as_ref().map(|profile| profile.phase(name))
    }

    /// Submits an encoder that traces some workgroups, waits until it has finished and the buffers are mapped, and
    /// records the elapsed time for the size of the next submission.
    pub(crate) async fn submit_slice(
        &self,
        encoder: CommandEncoder,
        names: PassNames,
        groups: Groups,
        scene: &SceneBuffers,
        mapped: &[&wgpu::Buffer],
    ) -> Result<Duration, GpuError> {
        let started = Instant::now();
        self.run_timed(encoder, names, mapped).await?;
        let elapsed = started.elapsed();
        scene.adapt_submission_size(groups, elapsed);
        Ok(elapsed)
    }

    /// Submits an encoder like [`Headless::run`], and adds its passes to the profile.
    pub(crate) async fn run_timed(
        &self,
        encoder: CommandEncoder,
        names: PassNames,
        mapped: &[&wgpu::Buffer],
    ) -> Result<(), GpuError> {
        let submitted = Instant::now();
        self.run(encoder, mapped).await?;
        self.note_passes(&names, submitted);
        Ok(())
    }
}
