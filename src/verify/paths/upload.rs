//! Whether the numbers that a device was given are those of the scene and the lighting that were asked for.

use super::recording::PathRecording;
use crate::scene::Scene;
use crate::verify::candidates::Candidates;
use crate::verify::upload::{UploadError, check_view};

/// A number that the device was given is not what was asked for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PathUploadError {
    /// Of the camera or the scene's box.
    #[error(transparent)]
    View(#[from] UploadError),
    /// Lists of pixels are not as long as the rectangle is large.
    #[error("the recording does not have {pixels} pixels everywhere")]
    Size {
        /// How many there are in the rectangle.
        pixels: u64,
    },
}

/// Compares them.
pub(super) fn check(
    scene: &Scene,
    candidates: &Candidates,
    recording: &PathRecording,
) -> Result<(), PathUploadError> {
    check_view(scene, candidates, &recording.camera, &recording.uploaded)?;
    let pixels = u64::from(recording.size[0]) * u64::from(recording.size[1]);
    let is_whole = |length: usize| length as u64 == pixels;
    let are_whole = recording.samples.iter().all(|sample| {
        is_whole(sample.start.len())
            && is_whole(sample.sums.len())
            && sample.surfaces.iter().all(|surface| {
                is_whole(surface.hits.len())
                    && is_whole(surface.scattered.len())
                    && is_whole(surface.open.len())
            })
    });
    if are_whole { Ok(()) } else { Err(PathUploadError::Size { pixels }) }
}
