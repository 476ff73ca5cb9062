//! Recording passes and phases in the profile of a device.

use std::time::Duration;

use wgpu::CommandEncoder;

use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::waiting::Instant;
use crate::gpu::passes::tiles::Groups;
use crate::gpu::profile::{NotedPass, ProfilePhase};
use crate::gpu::scene::scene_buffers::SceneBuffers;

impl Headless {
    /// Whether every pass is submitted by itself, so that the host's clock can measure it for a profile.
    pub(crate) fn submits_one_by_one(&self) -> bool {
        self.options.profile.is_some()
    }

    /// Adds the pass of a submission that has just finished to the profile. The device did
    /// not begin the pass before `began`.
    pub(crate) fn note_pass(&self, noted: NotedPass, began: Instant) {
        if let (Some(profile), Some(name)) = (&self.options.profile, noted.0) {
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
        noted: NotedPass,
        groups: Groups,
        scene: &SceneBuffers,
        mapped: &[&wgpu::Buffer],
    ) -> Result<Duration, GpuError> {
        let started = Instant::now();
        self.run_timed(encoder, noted, mapped).await?;
        let elapsed = started.elapsed();
        scene.adapt_submission_size(groups, elapsed);
        Ok(elapsed)
    }

    /// Submits an encoder like [`Headless::run`], and adds its pass to the profile.
    pub(crate) async fn run_timed(
        &self,
        encoder: CommandEncoder,
        noted: NotedPass,
        mapped: &[&wgpu::Buffer],
    ) -> Result<(), GpuError> {
        let submitted = Instant::now();
        self.run(encoder, mapped).await?;
        self.note_pass(noted, submitted);
        Ok(())
    }
}
