//! Options for opening a headless device.

use std::time::Duration;

use wgpu::Limits;

use crate::gpu::edit::{KernelRewrite, ShaderEdit};
use crate::gpu::profile::Profile;

/// Options for opening a headless device.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadlessOptions {
    /// Selects the adapter whose name contains this text, as [`candidates`](crate::gpu::adapter::candidates) does.
    /// `None` selects the best adapter.
    pub adapter: Option<String>,
    /// The limits that the device is opened with.
    pub limits: LimitChoice,
    /// The time that one submission may take before the render fails. The size of submissions adapts to the device, so
    /// that each takes about 60 milliseconds.
    pub timeout: Duration,
    /// Whether indirect dispatches are used where the device supports them. Only experiments and tests turn them off.
    /// The picture does not depend on this option.
    pub indirect: bool,
    /// Whether one pass takes whole samples of studios, if all spheres are opaque and in one brick. It takes less time
    /// than several passes. Only experiments and tests turn it off. The picture is the same except for rounding.
    pub one_pass: bool,
    /// Whether the device is opened for ray queries, which
    /// [`AccelChoice::RayQuery`](crate::accel::AccelChoice::RayQuery) needs. wgpu calls them experimental: mistakes in
    /// wgpu or in the driver can do anything.
    pub ray_query: bool,
    /// The type of device whose sizes of tiles and submissions are used; `None` is the type of the adapter. Only
    /// experiments and tests choose another. The picture does not depend on this option.
    pub device_type: Option<wgpu::DeviceType>,
    /// A record of where time goes, which the device fills in. The picture does not depend on this option.
    pub profile: Option<Profile>,
    /// Edits of the shader source. Only experiments and tests have any.
    pub edits: Vec<ShaderEdit>,
    /// A function that returns what the device gets in place of each kernel. Only tests set it.
    pub rewrite: Option<KernelRewrite>,
}

/// The limits that a device is opened with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LimitChoice {
    /// The limits of the adapter.
    #[default]
    Adapter,
    /// The default limits of WebGPU, which every browser guarantees, or lower limits if the adapter has lower ones.
    WebGpu,
}

impl Default for HeadlessOptions {
    /// Returns options for the best adapter with its own limits and a timeout of ten minutes.
    fn default() -> Self {
        let timeout = Duration::from_secs(600);
        let edits = Vec::new();
        Self {
            adapter: None,
            limits: LimitChoice::Adapter,
            timeout,
            indirect: true,
            one_pass: true,
            ray_query: false,
            device_type: None,
            profile: None,
            edits,
            rewrite: None,
        }
    }
}

/// Features that are used if the adapter has them: time stamps and, if device and host share their
/// memory, buffers that the host can map.
pub(super) fn wanted_features(device_type: wgpu::DeviceType) -> wgpu::Features {
    match device_type {
        wgpu::DeviceType::Cpu | wgpu::DeviceType::IntegratedGpu => {
            wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::MAPPABLE_PRIMARY_BUFFERS
        }
        _ => wgpu::Features::TIMESTAMP_QUERY,
    }
}

pub(super) fn required_limits(available: &Limits, choice: LimitChoice) -> Limits {
    // The limits of WebGPU if the adapter reaches them, so that no picture depends on higher limits by accident.
    let webgpu = Limits::default().or_worse_values_from(available);
    match choice {
        LimitChoice::WebGpu => webgpu,
        // The limits that bound the size of pictures and scenes are those of the adapter.
        LimitChoice::Adapter => Limits {
            max_buffer_size: available.max_buffer_size,
            max_storage_buffer_binding_size: available.max_storage_buffer_binding_size,
            ..webgpu.using_resolution(available.clone())
        },
    }
}
