//! Decides whether paths are as a conforming device may have followed them.
//!
//! A recording keeps the state of every path between two dispatches. Each dispatch is judged by itself, given the
//! very numbers that the device had before it: the camera's ray of a sample, what a ray meets, what is made of that,
//! whether a light is hidden, and what the sample adds. So errors do not add up along a path. Searches are judged as
//! those of pictures with one ray (`verify/hit.rs`); a shading kernel is followed number by number, as intervals
//! (`verify/number`), once for every combination of decisions that the intervals leave open: which wall, which side,
//! which lobe, reflected or refracted, which texel, whether the path ends.

mod bsdf;
mod certificate;
mod check;
mod expected;
mod kernel;
mod light;
mod material;
mod recording;
mod search;
mod sky;
mod start;
mod tables;
mod upload;
mod vertex;
mod warp;

pub use certificate::{PathCertificate, PathStage, PathViolation, StageCounts};
pub use recording::{
    PathRecording, PathState, RecordedSample, RecordedSurface, UploadedLighting, UploadedSky,
};
pub use upload::PathUploadError;
