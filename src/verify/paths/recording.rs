//! Recordings of paths: their states dispatch by dispatch.

use crate::verify::lit::recording::{LitInputs, PathState, RecordedFilm};
use crate::verify::lit::upload_error::LitUploadError;

/// A recording of the paths of a rectangle of a film. The checker needs only this and the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct PathRecording {
    /// What was requested, and the numbers that the device was given.
    pub given: LitInputs,
    /// The samples in the order in which they were taken.
    pub samples: Vec<RecordedSample>,
}

/// One sample of every pixel of the rectangle. Lists are row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedSample {
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// The state of every path at the camera.
    pub start: Vec<PathState>,
    /// The surfaces of the paths, in the order in which they are hit.
    pub surfaces: Vec<RecordedSurface>,
    /// The sums of the pixels without and with the sample.
    pub film: RecordedFilm,
}

/// The results of all paths at one surface.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordedSurface {
    /// The hits, as bits: distance, id, index in the structure, and distance from the ray's origin to the scene's box.
    pub hits: Vec<[u32; 4]>,
    /// The state of every path after shading.
    pub scattered: Vec<PathState>,
    /// The visibility of each path's sampled light, as the bits of a number: 0 if it is occluded.
    pub open: Vec<u32>,
}

impl PathRecording {
    /// Whether every list has an element for each pixel of the rectangle.
    pub(in crate::verify) fn check_size(&self) -> Result<(), LitUploadError> {
        let pixels = self.given.pixels();
        let is_whole = |length: usize| length as u64 == pixels;
        let are_whole = self.samples.iter().all(|sample| {
            is_whole(sample.start.len())
                && sample.film.has(pixels)
                && sample.surfaces.iter().all(|surface| {
                    is_whole(surface.hits.len())
                        && is_whole(surface.scattered.len())
                        && is_whole(surface.open.len())
                })
        });
        if are_whole { Ok(()) } else { Err(LitUploadError::Size { pixels }) }
    }
}
