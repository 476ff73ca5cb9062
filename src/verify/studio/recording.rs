//! Recordings of studios: the state of every ray dispatch by dispatch.

use crate::verify::lit::recording::{LitInputs, PathState, RecordedFilm};
use crate::verify::lit::upload_error::LitUploadError;

/// A recording of a rectangle of a picture of a studio. The checker needs only this and the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct StudioRecording {
    /// What was requested, and the numbers that the device was given.
    pub given: LitInputs,
    /// The samples in the order in which they were taken.
    pub samples: Vec<StudioSample>,
}

/// One sample of every pixel of the rectangle. Lists are row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StudioSample {
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// The state of every ray at the camera.
    pub start: Vec<PathState>,
    /// The surfaces behind each other, up to the one at which the last ray ends.
    pub surfaces: Vec<StudioSurface>,
    /// The sums of the pixels without and with the sample.
    pub film: RecordedFilm,
}

/// The results of all rays at one surface.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StudioSurface {
    /// The hits, as bits: distance, id, index in the structure, and distance from the ray's origin to the scene's box.
    pub hits: Vec<[u32; 4]>,
    /// The state of every ray once the surface is known.
    pub shaded: Vec<PathState>,
    /// The lights, 32 at a time.
    pub lights: Vec<StudioLight>,
    /// The directions of ambient light, 32 at a time.
    pub ambient: Vec<StudioLight>,
}

/// The results of all rays at one surface for up to 32 lights or directions.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StudioLight {
    /// A bit for each light that is hidden.
    pub hidden: Vec<u32>,
    /// Radiance and opacity with the light that is not, as bits.
    pub radiance: Vec<[u32; 4]>,
    /// The bits that are left for the next lights, which should be none.
    pub left: Vec<u32>,
}

/// The number of lights, or of directions of ambient light, of a [`StudioLight`].
pub(super) const BITS: u32 = 32;

impl StudioRecording {
    /// Whether every list has an element for each pixel of the rectangle, and every light and direction is in a list.
    pub(in crate::verify) fn check_size(&self) -> Result<(), LitUploadError> {
        let pixels = self.given.pixels();
        let lighting = &self.given.lighting;
        let is_whole = |length: usize| length as u64 == pixels;
        let has_light = |light: &StudioLight| {
            is_whole(light.hidden.len())
                && is_whole(light.radiance.len())
                && is_whole(light.left.len())
        };
        let are_all = |lights: &[StudioLight], count: u32| {
            lights.len() as u64 == u64::from(count.div_ceil(BITS)) && lights.iter().all(has_light)
        };
        let are_whole = self.samples.iter().all(|sample| {
            is_whole(sample.start.len())
                && sample.film.has(pixels)
                && sample.surfaces.iter().all(|surface| {
                    is_whole(surface.hits.len())
                        && is_whole(surface.shaded.len())
                        && are_all(&surface.lights, lighting.light_count)
                        && are_all(&surface.ambient, lighting.occlusion_samples)
                })
        });
        if are_whole { Ok(()) } else { Err(LitUploadError::Size { pixels }) }
    }
}
