//! The pass that writes the means of samples to the host's colour texture.

use wgpu::{BindGroupLayout, ComputePipeline, Device};

use crate::gpu::checks::Checks;
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;
use crate::gpu::passes::lit::LitLayouts;
use crate::gpu::shader::formats::ColorTarget;
use crate::gpu::shader::{Kernel, color_target, part, pipeline_with};

pub(in crate::gpu) fn resolve_kernel(color: ColorTarget) -> Kernel {
    let parts = vec![
        part!("scene/records.wgsl"),
        part!("scene/lighting_records.wgsl"),
        part!("scene/frame.wgsl"),
        part!("math/fence.wgsl"),
        part!("path/state.wgsl"),
        part!("math/luminance.wgsl"),
        part!("path/film_sums.wgsl"),
        color_target(color),
        part!("host/mean.wgsl"),
        part!("host/resolve.wgsl"),
    ];
    Kernel::new("resolve", parts)
}

/// Builds the pipeline. `targets` is the layout of the host's textures.
pub(in crate::gpu) async fn resolve_pipeline(
    device: &Device,
    color: ColorTarget,
    targets: &BindGroupLayout,
    edits: &Edits,
) -> Result<ComputePipeline, GpuError> {
    let checks = Checks::default();
    let kernel = resolve_kernel(color).edited(edits)?;
    let film = checks.create(device, || LitLayouts::new(device).film);
    let pipeline = pipeline_with(device, &kernel, &[Some(&film), None, Some(targets)], &checks);
    checks.passed().await?;
    Ok(pipeline)
}
