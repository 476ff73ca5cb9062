//! What a device notes for its profile, and submissions whose passes it notes.

use std::time::Duration;

use wgpu::CommandEncoder;

use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::waiting::Instant;
use crate::gpu::passes::pass_times::PassTimes;
use crate::gpu::passes::tiles::Groups;
use crate::gpu::profile::ProfilePhase;
use crate::gpu::scene::scene_buffers::SceneBuffers;

impl Headless {
    /// What notes the passes of one submission.
    pub(in crate::gpu) fn pass_times(&self) -> PassTimes {
        self.profile().map_or_else(PassTimes::default, |_| PassTimes::new(None))
    }

    /// Whether every pass is submitted by itself, so that the host's clock can measure it for a profile.
    pub(in crate::gpu) fn submits_one_by_one(&self) -> bool {
        self.profile().is_some()
    }

    /// Adds the passes of a submission to the profile, which has just finished. The device may have begun with it at
    /// `began`.
    pub(in crate::gpu) fn note_passes(&self, times: &PassTimes, began: Instant) {
        if let (Some(profile), Some(first)) = (self.profile(), times.names().first()) {
            let is_one = times.names().iter().all(|name| name == first);
            profile.add_pass(if is_one { first } else { "several passes" }, began.elapsed());
        }
    }

    /// Begins a phase of the host, if there is a profile.
    pub(in crate::gpu) fn phase(&self, name: &'static str) -> Option<ProfilePhase> {
        self.profile().map(|profile| profile.phase(name))
    }

    /// Submits an encoder that traces some workgroups, waits until it has finished and the buffers are mapped, and
    /// records the elapsed time for the size of the next submission.
    pub(in crate::gpu) async fn submit_slice(
        &self,
        encoder: CommandEncoder,
        times: PassTimes,
        groups: Groups,
        scene: &SceneBuffers,
        mapped: &[&wgpu::Buffer],
    ) -> Result<Duration, GpuError> {
        let started = Instant::now();
        self.run_timed(encoder, times, mapped).await?;
        let elapsed = started.elapsed();
        scene.adapt_submission_size(groups, elapsed);
        Ok(elapsed)
    }

    /// Submits an encoder like [`Headless::run`], and adds its passes to the profile.
    pub(in crate::gpu) async fn run_timed(
        &self,
        encoder: CommandEncoder,
        times: PassTimes,
        mapped: &[&wgpu::Buffer],
    ) -> Result<(), GpuError> {
        let submitted = Instant::now();
        self.run(encoder, mapped).await?;
        self.note_passes(&times, submitted);
        Ok(())
    }
}
