//! What a device notes for its profile, and submissions whose passes it notes.

use std::time::Duration;

use wgpu::CommandEncoder;

use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::waiting::Instant;
use crate::gpu::passes::pass_times::PassTimes;
use crate::gpu::passes::tiles::Groups;
use crate::gpu::profile::{PassClock, ProfilePhase};
use crate::gpu::scene::scene_buffers::SceneBuffers;

impl Headless {
    /// What notes the passes of one submission.
    pub(in crate::gpu) fn pass_times(&self) -> PassTimes {
        match self.profiler() {
            Some(profiler) => PassTimes::new(profiler.stamps(self.device())),
            None => PassTimes::default(),
        }
    }

    /// Whether every pass is submitted by itself, so that the host's clock can measure it.
    pub(in crate::gpu) fn submits_one_by_one(&self) -> bool {
        self.profiler().is_some_and(|profiler| profiler.clock == PassClock::Host)
    }

    /// Adds the passes of a submission to the profile, see [`Profiler::add`].
    pub(in crate::gpu) fn note_passes(
        &self,
        times: PassTimes,
        submitted: Instant,
        began: Instant,
    ) -> Result<(), GpuError> {
        self.profiler().map_or(Ok(()), |profiler| profiler.add(times, submitted, began))
    }

    /// Begins a phase of the host, if there is a profile.
    pub(in crate::gpu) fn phase(&self, name: &'static str) -> Option<ProfilePhase> {
        self.profiler().map(|profiler| profiler.profile.phase(name))
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
        mut encoder: CommandEncoder,
        times: PassTimes,
        mapped: &[&wgpu::Buffer],
    ) -> Result<(), GpuError> {
        times.record_copy(&mut encoder);
        let submitted = Instant::now();
        let submission = self.start(encoder);
        let mapped: Vec<_> = mapped.iter().copied().chain(times.buffer()).collect();
        self.wait(&mapped, submission).await?;
        self.note_passes(times, submitted, submitted)
    }
}
