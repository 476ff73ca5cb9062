//! How far a picture is, what is to be done about it, and what became of it.

use crate::gpu::error::GpuError;
use crate::gpu::passes::tiles::Groups;
use crate::image::Image;

/// How far a picture is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// Samples that every pixel has.
    pub samples: u32,
    /// How many it will have; 1 of a picture of primary rays.
    pub total: u32,
    /// All work that is done, from 0 to 1.
    pub part: f64,
    /// The noise that is left in a lit picture: the root of the mean variance of pixels, over the mean luminance. Known
    /// after two samples, if [`Decision::MeasureNoise`] asked for it.
    pub noise: Option<f64>,
}

/// What is to be done about a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Decision {
    /// Go on.
    GoOn,
    /// Go on, and have [`Progress::noise`] at a later call.
    MeasureNoise,
    /// Take the picture as it is. As long as not every pixel has a sample, there is no picture, and this stops it.
    Finish,
    /// Give it up.
    Stop,
}

/// Told of progress after every submission; decides how the render goes on.
pub type Watch<'a> = dyn FnMut(&Progress) -> Decision + 'a;

/// For whoever does not watch.
pub(in crate::gpu) fn go_on(_: &Progress) -> Decision {
    Decision::GoOn
}

/// What became of a picture.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Picture {
    /// The image, with the layers that were asked for.
    pub image: Image,
    /// How many samples every pixel has.
    pub samples: u32,
    /// See [`Progress::noise`].
    pub noise: Option<f64>,
    /// How many of the camera's rays met something, all samples together, weighted by opacity. `None` of primary rays,
    /// which are not counted.
    pub hits: Option<f64>,
}

/// How many pixels have been traced by primary rays, in whole workgroups; a pixel counts once for every brick.
pub(in crate::gpu) struct TracedPixels {
    done: u64,
    /// How many are to be traced: those in which the scene's box may be seen.
    total: u64,
}

impl TracedPixels {
    pub(in crate::gpu) fn of(total: u64) -> Self {
        Self { done: 0, total }
    }

    /// Tells `watch` that some more are done.
    pub(in crate::gpu) fn add(
        &mut self,
        groups: Groups,
        watch: &mut Watch<'_>,
    ) -> Result<(), GpuError> {
        self.done = (self.done + groups.pixels()).min(self.total);
        let is_done = self.done == self.total;
        // A picture in which nothing is to be traced is done at once.
        let part = if is_done { 1.0 } else { self.done as f64 / self.total as f64 };
        match watch(&Progress { samples: is_done.into(), total: 1, part, noise: None }) {
            Decision::GoOn | Decision::MeasureNoise => Ok(()),
            Decision::Finish if is_done => Ok(()),
            Decision::Finish | Decision::Stop => Err(GpuError::Stopped),
        }
    }
}
