//! Decides whether a picture is one that a conforming device may have made.
//!
//! A GPU's f32 arithmetic is not exact, and WGSL leaves it free in many ways: either neighbour in rounding,
//! fused or not, in any order. So two devices differ, and comparing pictures with a tolerance proves nothing.
//! Here instead, from the very numbers that the device was given, a running error bound in f64 gives the set
//! of answers that a conforming implementation of the kernels may come to: which spheres may be the nearest and
//! at which distances, whether a miss is possible, which normals, depths and colours follow. A pixel is
//! *decided* if that set has one element, up to distances within their bounds.
//!
//! Stages are judged one by one, each given what the device recorded of the one before, so that errors do not
//! add up: the camera's ray, the nearest hit, and what is made of it. The checker shares no code with the
//! kernels' twins and knows nothing of the structure that found the spheres.
//!
//! The picture of [`Headless::render`](crate::gpu::Headless::render) comes from kernels that keep no rays. It is
//! compared with the recording's, value by value; a pixel in which it is another is judged by itself, against every ray
//! that a device may make of that pixel.
//!
//! What is assumed beside WGSL's table of accuracies: `fence` in `shaders/math/fence.wgsl` keeps a compiler from
//! looking through it, and the square root of zero is zero: both of which
//! [`Headless::self_test`](crate::gpu::Headless::self_test) checks. And of spheres that are the same to the bit the
//! smallest id wins, also where they are in different bricks: all kernels of a picture find the same for the same.
//!
//! Paths of lit pictures are judged in the same way, dispatch by dispatch ([`Checker::certify_paths`]). There a number
//! that stands in two places of a kernel's text, and is fenced, is taken to be the same in both; and products of sums
//! are taken not to be multiplied out.
//!
//! ```no_run
//! # use pinhole::{RenderSettings, Scene, View, gpu::{Headless, HeadlessOptions}};
//! # fn f(scene: &Scene, view: &View<'_>) -> Result<(), Box<dyn std::error::Error>> {
//! let headless = Headless::open(&HeadlessOptions::default())?;
//! let certificate = headless.verify(scene, view, &RenderSettings::default())?;
//! assert!(certificate.is_legal(), "{certificate}");
//! # Ok(())
//! # }
//! ```
#![cfg_attr(not(feature = "gpu"), allow(rustdoc::broken_intra_doc_links, reason = "gpu is off"))]

mod camera;
mod candidates;
mod certificate;
mod checker;
mod choices;
mod hit;
mod line;
mod number;
mod paths;
mod pixel;
mod recording;
mod rendered;
mod rounding;
#[cfg(feature = "run-file")]
pub mod run_file;
mod shading;
mod sphere;
mod upload;
mod violation;

pub use camera::LegalCameraRay;
pub use certificate::{Certificate, Verdict};
pub use checker::Checker;
pub use hit::{LegalHit, LegalHits};
pub use paths::{
    PathCertificate, PathRecording, PathStage, PathState, PathUploadError, PathViolation,
    RecordedSample, RecordedSurface, StageCounts, UploadedLighting, UploadedSky,
};
pub use recording::{
    NO_HIT, Recording, Rendered, RequestedCamera, TracedPixel, TracedRay, UploadedView,
};
pub use rounding::Interval;
#[cfg(feature = "gpu")]
pub(crate) use rounding::{DIVIDE_ULP, SQRT_ULP, gamma};
pub use upload::UploadError;
pub use violation::{Violation, ViolationKind};
