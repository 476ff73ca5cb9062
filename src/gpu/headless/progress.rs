//! The progress of a render, the decisions of its caller, and its result.

use crate::gpu::error::GpuError;
use crate::gpu::passes::tiles::Groups;
use crate::image::Image;

/// The progress of a render.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// Number of samples that every pixel has.
    pub samples: u32,
    /// Number of samples that every pixel will have; 1 for a picture of primary rays.
    pub total: u32,
    /// Completed fraction of the work, from 0 to 1.
    pub part: f64,
    /// Remaining noise of a lit picture: the square root of the mean variance of pixels, divided by the mean luminance.
    /// It is known after two samples, if [`Decision::MeasureNoise`] requested it.
    pub noise: Option<f64>,
}

/// How a render continues: the answer of the callback that is told about its progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Decision {
    /// Continue.
    GoOn,
    /// Continue, and provide [`Progress::noise`] in later calls.
    MeasureNoise,
    /// Return the picture with the samples that it has. While some pixels have no sample there is no picture, and the
    /// render stops with an error.
    Finish,
    /// Stop the render with an error.
    Stop,
}

/// Callback that is called with the progress after every submission, and decides how the render continues.
pub type Watch<'a> = dyn FnMut(&Progress) -> Decision + 'a;

/// The progress of copying a scene to a device brick by brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct UploadProgress {
    /// What is done next.
    pub step: UploadStep,
    /// The number of the brick, from 0 on.
    pub brick: usize,
    /// How many bricks there are.
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

/// Callback that is called before each step of copying a scene, and decides whether it goes on: [`Decision::Finish`]
/// and [`Decision::Stop`] end it with an error.
pub type UploadWatch<'a> = dyn FnMut(&UploadProgress) -> Decision + 'a;

impl UploadProgress {
    /// Calls `watch`, and returns an error if it stops.
    pub(in crate::gpu) fn tell(self, watch: &mut UploadWatch<'_>) -> Result<(), GpuError> {
        match watch(&self) {
            Decision::GoOn | Decision::MeasureNoise => Ok(()),
            Decision::Finish | Decision::Stop => Err(GpuError::Stopped),
        }
    }
}

/// A [`Watch`] or an [`UploadWatch`] that always continues.
pub(in crate::gpu) fn go_on<T>(_: &T) -> Decision {
    Decision::GoOn
}

/// The result of a render.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Picture {
    /// The image, with the layers that were requested.
    pub image: Image,
    /// Number of samples that every pixel has.
    pub samples: u32,
    /// Remaining noise, as in [`Progress::noise`].
    pub noise: Option<f64>,
    /// Number of camera rays that hit something, over all samples, weighted by opacity. It is `None` for pictures of
    /// primary rays, whose hits are not counted.
    pub hits: Option<f64>,
}

/// Number of pixels for which primary rays were traced, in whole workgroups. A pixel counts once for every brick.
pub(in crate::gpu) struct TracedPixels {
    done: u64,
    /// Number of pixels to be traced: those in which the scene's box may be visible.
    total: u64,
}

impl TracedPixels {
    pub(in crate::gpu) fn of(total: u64) -> Self {
        Self { done: 0, total }
    }

    /// Adds the pixels of some workgroups, and calls `watch` with the progress.
    pub(in crate::gpu) fn add(
        &mut self,
        groups: Groups,
        watch: &mut Watch<'_>,
    ) -> Result<(), GpuError> {
        self.done = (self.done + groups.pixels()).min(self.total);
        let is_done = self.done == self.total;
        // A picture without any pixels to trace is complete at once.
        let part = if is_done { 1.0 } else { self.done as f64 / self.total as f64 };
        match watch(&Progress { samples: is_done.into(), total: 1, part, noise: None }) {
            Decision::GoOn | Decision::MeasureNoise => Ok(()),
            Decision::Finish if is_done => Ok(()),
            Decision::Finish | Decision::Stop => Err(GpuError::Stopped),
        }
    }
}
