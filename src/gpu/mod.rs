//! The renderer that uses compute shaders. This is the only module that uses wgpu.
//!
//! State is divided by its lifetime: [`Renderer`] holds pipelines, [`SceneBuffers`] holds a scene on a device, and
//! [`Frame`] holds the data that change from picture to picture. [`Renderer::record`] records commands into the
//! caller's encoder, which write to the caller's textures, and never submits them. [`Headless`] owns a device and is
//! built on the same functions.

pub use wgpu;

/// The version of wgpu whose types this module takes and returns, which is re-exported as [`wgpu`]. A program that
/// depends on another major version has other types of the same names, which the compiler refuses.
/// `docs/how-to/embed.md` says what to do then.
pub const WGPU_VERSION: &str = "30.0";

pub mod adapter;
mod cache;
mod checks;
mod device_shape;
pub(crate) mod edit;
mod error;
mod headless;
mod host;
mod kernels;
mod options;
pub(crate) mod passes;
mod profile;
mod resources;
mod scene;
mod self_test;
mod shader;

pub use device_shape::DeviceLimits;
pub use error::GpuError;
pub use headless::Headless;
pub use headless::lit_recording::{EachSample, LitPart, SampleRequest};
pub use headless::measure::TraceTime;
pub use headless::plan::{PictureRequest, RenderPlan, StructurePlans};
pub use headless::progress::{Decision, Picture, Progress, UploadProgress, UploadStep, UploadWatch, Watch};
#[cfg(not(target_arch = "wasm32"))]
pub use headless::waiting::{Wait, catches_panics};
pub use host::composite::{Composite, CompositeDepth, CompositeOptions, CompositePicture, Coverage, TargetEncoding};
pub use host::depth_test::{DepthTest, HostDepth};
pub use host::lit_picture::{LitPicture, LitProgress, LitState, LitSums};
pub use host::lit_renderer::LitRenderer;
pub use host::live_picture::{LivePicture, LiveProgress};
pub use host::pick::{PickError, PickedHit, PickedPixel, Picker};
pub use kernels::{ComposedKernel, composed_kernels};
pub use options::{HeadlessOptions, LimitChoice};
pub use passes::frame::Frame;
pub use passes::renderer::Renderer;
pub use passes::renderer_options::RendererOptions;
pub use passes::targets::{DataTargets, TargetTextures, Targets};
pub use profile::{Profile, ProfilePhase, ProfileTotal, ProfileTrack};
pub use scene::recolor::Recolor;
pub use scene::scene_buffers::SceneBuffers;
pub use scene::structures::{Retry, Structures, with_retries};
pub use self_test::{PropertyOutcome, SelfTestExtent, SelfTestReport, TestedProperty};
pub use shader::formats::ColorTarget;
