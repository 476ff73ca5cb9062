//! The compute-shader renderer. The only module that names wgpu.
//!
//! State is split by how long it lives: [`Renderer`] holds pipelines, [`SceneBuffers`] a scene on a
//! device, [`Frame`] what changes from picture to picture. [`Renderer::record`] writes into the
//! caller's encoder and textures and never submits; [`Headless`], which owns a device of its own,
//! is built on exactly that.

pub use wgpu;

pub mod adapter;
mod appearance;
mod bands;
mod brick_buffers;
mod denoise;
mod derived;
mod edit;
mod error;
mod faults;
mod formats;
mod frame;
mod headless;
mod hosted;
mod kernels;
mod layouts;
mod lit;
mod lit_flow;
mod lit_picture;
mod measure;
mod options;
mod order;
mod path_recording;
mod plan;
mod planning;
mod primary;
mod progress;
mod quirks;
mod readable_trace;
mod readback;
mod recolor;
mod record;
mod recording;
mod records;
mod renderer;
mod renderer_options;
mod renderers;
mod scene_buffers;
mod scene_summary;
mod self_test;
mod shader;
mod shape_ids;
mod structures;
mod submission_size;
mod tile_textures;
mod tiles;
mod timer;
mod update;
mod visible_region;

pub use edit::ShaderEdit;
pub use error::GpuError;
pub use formats::ColorTarget;
pub use frame::{DataTargets, Frame, Targets};
pub use headless::Headless;
#[doc(hidden)]
pub use hosted::{HostedPicture, HostedSums};
pub use kernels::{ComposedKernel, composed_kernels};
pub use options::{HeadlessOptions, LimitChoice};
pub use plan::{DeviceLimits, HostPeak, PictureRequest, RenderPlan, StructurePlans};
pub use progress::{Decision, Picture, Progress, Watch};
pub use recolor::Recolor;
pub use renderer::Renderer;
pub use renderer_options::{Query, RendererOptions};
pub use scene_buffers::SceneBuffers;
pub use self_test::{PropertyOutcome, SelfTestExtent, SelfTestReport, TestedProperty};
pub use structures::{Retry, Structures, with_retries};
pub use timer::TraceTime;
