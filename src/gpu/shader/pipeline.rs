//! Pipelines of kernels.

use wgpu::{ComputePipeline, Device};

use super::kernel::Kernel;
use crate::gpu::error::{GpuError, scoped};

/// A pipeline of a kernel, with its groups in their order.
pub(in crate::gpu) fn pipeline(
    device: &Device,
    kernel: &Kernel,
    groups: &[&wgpu::BindGroupLayout],
) -> Result<ComputePipeline, GpuError> {
    let name = kernel.name();
    let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
    scoped(device, || {
        let module = shader_module(
            device,
            wgpu::ShaderModuleDescriptor {
                label: Some(&name),
                source: wgpu::ShaderSource::Wgsl(kernel.source().into()),
            },
        );
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(&name),
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&name),
            layout: Some(&layout),
            module: &module,
            entry_point: Some(kernel.entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    })
    .map_err(|error| match error {
        GpuError::Device { message } => {
            GpuError::Device { message: kernel.with_positions_in_files(&message) }
        }
        other => other,
    })
}

/// Without the counter that wgpu puts into every loop against endless ones, which takes 4 to 14 % of a
/// trace; bounds checks stay.
#[expect(unsafe_code, reason = "every loop of our kernels ends by itself, see below")]
fn shader_module(
    device: &Device,
    descriptor: wgpu::ShaderModuleDescriptor<'_>,
) -> wgpu::ShaderModule {
    let checks = wgpu::ShaderRuntimeChecks {
        force_loop_bounding: false,
        ..wgpu::ShaderRuntimeChecks::checked()
    };
    // SAFETY: what a loop without wgpu's counter must not do is run for ever. Loops over a tree's or a grid's
    // levels and cells ask `spend` in every iteration and leave when it says so. The others end by data: a
    // loop over all spheres at a number from a uniform, a loop over a list or a leaf at a mark in buffers that
    // only `SceneBuffers` writes, from structures whose builders end every list, and the loops of the self-test,
    // of samples in flight and of directions of light at numbers from a uniform; and reads beyond a buffer are bounded
    // all the same.
    unsafe { device.create_shader_module_trusted(descriptor, checks) }
}
