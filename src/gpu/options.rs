//! How a headless device is opened.

use std::time::Duration;

use wgpu::Limits;

use crate::gpu::edit::ShaderEdit;

/// How a device is opened.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadlessOptions {
    /// The adapter whose name contains this text, as in [`candidates`](crate::gpu::adapter::candidates).
    pub adapter: Option<String>,
    /// What the device may use.
    pub limits: LimitChoice,
    /// How long one submission may take before it is given up. Submissions adapt to the device and take
    /// about 60 milliseconds.
    pub timeout: Duration,
    /// Whether the device itself may say how many workgroups a dispatch has, where it can; off only in experiments
    /// and tests. The picture does not depend on it.
    pub indirect: bool,
    /// Changes of shaders; none, but in experiments and tests.
    pub edits: Vec<ShaderEdit>,
}

/// Which limits a device is opened with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LimitChoice {
    /// What the adapter has.
    #[default]
    Adapter,
    /// WebGPU's defaults, or less where the adapter has less: what every browser guarantees.
    WebGpu,
}

impl Default for HeadlessOptions {
    /// The best adapter with its own limits; ten minutes.
    fn default() -> Self {
        let timeout = Duration::from_secs(600);
        let edits = Vec::new();
        Self { adapter: None, limits: LimitChoice::Adapter, timeout, indirect: true, edits }
    }
}

/// What is used where it exists: a clock and, where the device's memory is the host's, writing into it.
pub(super) fn wanted_features(device_type: wgpu::DeviceType) -> wgpu::Features {
    match device_type {
        wgpu::DeviceType::Cpu | wgpu::DeviceType::IntegratedGpu => {
            wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::MAPPABLE_PRIMARY_BUFFERS
        }
        _ => wgpu::Features::TIMESTAMP_QUERY,
    }
}

pub(super) fn required_limits(available: &Limits, choice: LimitChoice) -> Limits {
    // WebGPU's limits, where the adapter has them, so that a picture does not depend on more.
    let webgpu = Limits::default().or_worse_values_from(available);
    match choice {
        LimitChoice::WebGpu => webgpu,
        // And all that it has of what bounds the size of pictures and scenes.
        LimitChoice::Adapter => Limits {
            max_buffer_size: available.max_buffer_size,
            max_storage_buffer_binding_size: available.max_storage_buffer_binding_size,
            ..webgpu.using_resolution(available.clone())
        },
    }
}
