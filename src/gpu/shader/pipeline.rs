//! Creating the pipelines of kernels.

use wgpu::{ComputePipeline, Device};

use super::kernel::Kernel;
use super::textures::{reads_textures, with_textures};
use crate::gpu::checks::Checks;
use crate::gpu::error::GpuError;

/// Creates the pipeline of a kernel. `groups` are the layouts of its bind groups, in order. Whether the device accepts
/// the kernel is known when the checks have passed.
pub(crate) fn pipeline(
    device: &Device,
    kernel: &Kernel,
    groups: &[&wgpu::BindGroupLayout],
    checks: &Checks,
) -> ComputePipeline {
    let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
    pipeline_with(device, kernel, &groups, checks)
}

/// Creates the pipeline of a kernel like [`pipeline`], but without bind groups for which `groups` has `None`.
pub(crate) fn pipeline_with(
    device: &Device,
    kernel: &Kernel,
    groups: &[Option<&wgpu::BindGroupLayout>],
    checks: &Checks,
) -> ComputePipeline {
    let name = kernel.name();
    let constants = kernel.values_of_constants();
    let create = || {
        let (source, constants) = source(device, kernel, &constants);
        let label = Some(name.as_str());
        let module = shader_module(device, wgpu::ShaderModuleDescriptor { label, source });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(&name),
            bind_group_layouts: groups,
            immediate_size: 0,
        });
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&name),
            layout: Some(&layout),
            module: &module,
            entry_point: Some(kernel.entry_point),
            compilation_options: with_constants(constants),
            cache: None,
        })
    };
    let refused = kernel.clone();
    checks.create_explained(device, create, move |error| match error {
        GpuError::Device { message } => GpuError::Device { message: refused.with_positions_in_files(&message) },
        other => other,
    })
}

/// The source of a kernel as a device takes it, and the constants that still need values. A browser takes WGSL.
fn source<'a>(
    device: &Device,
    kernel: &Kernel,
    constants: &'a [(&'a str, f64)],
) -> (wgpu::ShaderSource<'static>, &'a [(&'a str, f64)]) {
    let source = kernel.source();
    let source = if reads_textures(device) { with_textures(&source) } else { source };
    #[cfg(not(target_arch = "wasm32"))]
    if let Some(module) = super::fold::folded(&source, kernel.entry_point, constants) {
        return (wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(module)), &[]);
    }
    (wgpu::ShaderSource::Wgsl(source.into()), constants)
}

/// The options of a stage with these values of `override` constants.
pub(crate) fn with_constants<'a>(constants: &'a [(&'a str, f64)]) -> wgpu::PipelineCompilationOptions<'a> {
    wgpu::PipelineCompilationOptions { constants, ..wgpu::PipelineCompilationOptions::default() }
}

/// Creates a shader module without the counter that wgpu inserts into every loop to stop endless ones, because it takes
/// 4 to 14 % of the time of a trace. Bounds checks stay enabled.
#[expect(unsafe_code, reason = "every loop of our kernels ends by itself, see below")]
fn shader_module(device: &Device, descriptor: wgpu::ShaderModuleDescriptor<'_>) -> wgpu::ShaderModule {
    let checks = wgpu::ShaderRuntimeChecks { force_loop_bounding: false, ..wgpu::ShaderRuntimeChecks::checked() };
    // SAFETY: a loop without wgpu's counter must not run forever. Loops over the levels and cells of a tree or a grid
    // call `spend` in every iteration and leave when it returns false. The others are bounded by data: a loop over all
    // spheres by a number from a uniform; a loop over a list or a leaf by a mark in buffers that only `SceneBuffers`
    // writes, from structures whose builders terminate every list; and the loops of the self-test, over samples in
    // flight and over directions of light by numbers from a uniform. Accesses beyond a buffer are still checked.
    unsafe { device.create_shader_module_trusted(descriptor, checks) }
}
