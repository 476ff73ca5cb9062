//! The checker decides whether a conforming device may have rendered a picture.
//!
//! The f32 arithmetic of a GPU is not exact, and WGSL gives it freedom: a result may be rounded to either neighbour,
//! operations may be fused, and sums may be evaluated in any order. Devices therefore differ, and comparing pictures
//! with a tolerance tells little. The checker instead starts from the device's exact inputs. With error bounds in
//! f64, it computes a set that holds all answers that a conforming implementation of the kernels may give: which spheres may be
//! the nearest and at which distances, whether a miss is possible, and which normals, depths and colours follow. These
//! answers are *legal*. A pixel is *decided* if only one answer is legal, apart from distances within their bounds.
//!
//! Stages are judged separately, each from the device's recorded result of the previous stage, so that errors do not
//! accumulate: the camera's ray, the nearest hit, and the shading. The checker has kernels of its own, and does not use the
//! structure that found the spheres. With the CPU reference it shares the scene, random numbers and tables of lights.
//!
//! The picture of [`Headless::render`](crate::gpu::Headless::render) comes from kernels that do not record rays. It is
//! compared with the recording's picture, value by value. A pixel that differs is judged separately, against every ray
//! that a device may compute for that pixel.
//!
//! In addition to WGSL's table of accuracies, the checker assumes that `fence` in `shaders/math/fence.wgsl` stops a
//! compiler from optimising across it, and that the square root of zero is zero;
//! [`Headless::self_test`](crate::gpu::Headless::self_test) tests both. It also assumes that among spheres that are
//! equal to the bit the smallest id wins, even if they are in different bricks, because all kernels of a picture
//! compute the same result from the same numbers.
//!
//! The paths of pictures with lighting are judged in the same way, dispatch by dispatch ([`Checker::certify_lit`]). For
//! them, the checker also assumes that a fenced number is the same wherever a kernel's text computes it, and that
//! products of sums are not expanded.
//!
//! ```no_run
//! # use pinhole::{RenderSettings, Scene, View, gpu::{Headless, HeadlessOptions, Wait}};
//! # fn f(scene: &Scene, view: &View<'_>) -> Result<(), Box<dyn std::error::Error>> {
//! let headless = Headless::open(&HeadlessOptions::default()).wait()?;
//! let certificate = headless.verify(scene, view, &RenderSettings::default()).wait()?;
//! assert!(certificate.is_legal(), "{certificate}");
//! # Ok(())
//! # }
//! ```
#![cfg_attr(not(feature = "gpu"), allow(rustdoc::broken_intra_doc_links, reason = "gpu is off"))]

mod bias;
mod camera;
mod certificate;
mod checker;
mod choices;
pub(crate) mod cone;
pub mod conformance;
pub mod denoised;
pub mod finished;
mod hit;
pub(crate) mod lit;
mod lit_check;
mod normals;
mod number;
mod paths;
#[cfg(feature = "run-file")]
pub mod picture_certificate;
mod rounding;
#[cfg(feature = "run-file")]
pub mod run_file;
mod sphere;
mod studio;
mod tree;
mod uploaded;
mod witness;
pub mod written;

pub use crate::recording::lit::{LitInputs, LitRecording, RecordedSample};
pub use crate::recording::{
    NO_HIT, PlainRender, Recording, RequestedCamera, TracedPixel, TracedRay, UploadError, UploadedView,
};
pub use bias::{Deviation, Deviations, LARGEST_MEAN};
pub use camera::LegalCameraRay;
pub use certificate::{Certificate, MOST_UNDECIDED, Outcome, Verdict, Violation};
pub use checker::Checker;
pub use hit::{LegalHit, LegalHits};
pub use lit::certificate::{LitCertificate, LitOpen, LitShare, LitStage, LitViolation, StageCounts};
pub use rounding::Interval;
#[cfg(feature = "gpu")]
pub(crate) use rounding::{DIVIDE_UNITS, SQRT_ULP, gamma};
pub use witness::Witness;
