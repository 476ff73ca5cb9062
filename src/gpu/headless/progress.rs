//! The progress of copying scenes to a device, and of tracing primary rays. The progress of lit
//! pictures is in `render/progress.rs`.

use crate::gpu::error::GpuError;
use crate::gpu::passes::tiles::Groups;
pub use crate::render::{Decision, Picture, Progress, Watch};

/// The progress of copying a scene to a device brick by brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct UploadProgress {
    /// The next step.
    pub step: UploadStep,
    /// Index of the brick, from 0.
    pub brick: usize,
    /// Number of bricks.
    pub bricks: usize,
}

/// A step of copying a brick to a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum UploadStep {
    /// The host builds the brick, while the device has nothing to do.
    Building,
    /// The brick is copied to the device.
    Copying,
}

/// Callback that is called before each step of copying a scene, and decides whether copying goes on.
/// [`Decision::Finish`] and [`Decision::Stop`] end it with an error.
pub type UploadWatch<'a> = dyn FnMut(&UploadProgress) -> Decision + 'a;

impl UploadProgress {
    /// Calls `watch`, and returns an error if it stops.
    pub(crate) fn tell(self, watch: &mut UploadWatch<'_>) -> Result<(), GpuError> {
        unless_ended(watch(&self))
    }
}

/// Returns an error for a decision to finish or to stop.
pub(crate) fn unless_ended(decision: Decision) -> Result<(), GpuError> {
    match decision {
        Decision::GoOn | Decision::MeasureNoise => Ok(()),
        Decision::Finish | Decision::Stop => Err(GpuError::Stopped),
    }
}

/// A [`Watch`] or an [`UploadWatch`] that always continues.
pub(crate) fn go_on<T>(_: &T) -> Decision {
    Decision::GoOn
}

/// Number of pixels for which primary rays were traced, in whole workgroups. A pixel counts once for every brick.
pub(crate) struct TracedPixels {
    done: u64,
    /// Number of pixels to be traced: all pixels in which the scene's box may be visible.
    total: u64,
}

impl TracedPixels {
    pub(crate) fn of(total: u64) -> Self {
        Self { done: 0, total }
    }

    /// Adds the pixels of some workgroups, and calls `watch` with the progress.
    pub(crate) fn add(&mut self, groups: Groups, watch: &mut Watch<'_>) -> Result<(), GpuError> {
        self.done = (self.done + groups.pixels()).min(self.total);
        let is_done = self.done == self.total;
        // A picture without any pixels to trace is complete at once.
        let part = if is_done { 1.0 } else { self.done as f64 / self.total as f64 };
        match watch(&Progress { samples: is_done.into(), total: 1, part, noise: None }) {
            Decision::Finish if is_done => Ok(()),
            decision => unless_ended(decision),
        }
    }
}
