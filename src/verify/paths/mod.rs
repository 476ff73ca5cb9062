//! The checker of paths decides whether a conforming device may have followed them.
//!
//! A recording contains the state of every path between two dispatches. Each dispatch is judged separately, from the
//! very numbers that the device had before it: the camera ray of a sample, the nearest hit of a ray, the shading of the
//! hit, the occlusion of a light, and the contribution of the sample. Errors therefore do not accumulate along a path.
//! Searches are judged like those of pictures with a single ray for each pixel (`verify/hit.rs`). A shading kernel is
//! evaluated with intervals, number by number (`verify/number`), once for every combination of decisions that the
//! intervals leave open: which side of a sphere, which lobe, reflection or refraction, which texel, and whether the
//! path ends.

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
