//! The progress of a render, the decisions of its caller, and its result, for devices and the CPU.

use crate::image::Image;

/// The progress of a render.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// Number of samples that every pixel has.
    pub samples: u32,
    /// Number of samples that every pixel will have. 1 for a picture of primary rays.
    pub total: u32,
    /// Completed fraction of the work, from 0 to 1.
    pub part: f64,
    /// Remaining noise of a lit picture: the square root of the mean variance of pixels, divided by the mean luminance.
    /// It is known after two samples, if [`Decision::MeasureNoise`] requested it.
    pub noise: Option<f64>,
}

/// The caller's decision how a render continues, returned by the callback that receives its progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Decision {
    /// Continue.
    GoOn,
    /// Continue, and provide [`Progress::noise`] in later calls.
    MeasureNoise,
    /// Return the picture with the samples taken so far. If some pixels have no sample yet, there is no picture, and
    /// the render stops with an error.
    Finish,
    /// Stop the render with an error.
    Stop,
}

/// A callback that receives the progress several times a second, on the thread of the caller, and decides how the
/// render continues.
pub type Watch<'a> = dyn FnMut(&Progress) -> Decision + 'a;

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
    /// Number of places in a smooth picture near which there are more than 256 spheres, so that those which look smallest
    /// do not dim ambient light, and of those from which more than 512 are in the way to a lamp, so that the farthest of
    /// them cast no shadow there.
    pub crowded: usize,
}

impl Picture {
    /// A picture by one ray through the centre of each pixel.
    pub(crate) fn by_primary_rays(image: Image) -> Self {
        Self { image, samples: 1, noise: None, hits: None, crowded: 0 }
    }
}

/// Sums over all pixels.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Totals {
    /// Sum of the opacities of all samples.
    pub(crate) opacity: f64,
    /// Sum of the variances of pixels' means.
    pub(crate) variance: f64,
    /// Sum of the luminances of pixels.
    pub(crate) light: f64,
    pub(crate) pixels: u64,
}

impl Totals {
    pub(crate) fn add(&mut self, more: &Self) {
        self.opacity += more.opacity;
        self.variance += more.variance;
        self.light += more.light;
        self.pixels += more.pixels;
    }

    /// The remaining noise: the square root of the mean variance of pixels, divided by the mean luminance. `None` if it
    /// is not known.
    pub(crate) fn noise(&self, samples: u32) -> Option<f64> {
        let count = self.pixels as f64;
        let is_known = samples > 1 && self.light > 0.0;
        is_known.then(|| (self.variance / count).sqrt() / (self.light / count))
    }
}

/// The size of the next batch of samples when `done` of `total` samples are complete. After each batch there is a
/// picture that could be returned.
pub(crate) fn batch(done: u32, total: u32) -> u32 {
    done.clamp(1, 32).min(total - done)
}
