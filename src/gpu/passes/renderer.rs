//! The pipelines of primary rays.

use wgpu::{ComputePipeline, Device};

use crate::accel::{BrickKind, Primitive};
use crate::camera::CameraKind;
use crate::gpu::error::{GpuError, scoped};
use crate::gpu::passes::renderer_options::{Query, RendererOptions};
use crate::gpu::shader::formats::ColorTarget;
use crate::gpu::shader::layouts::Layouts;
use crate::gpu::shader::pipeline;
use crate::gpu::shader::{self, BrickPass};

/// The pipelines of primary rays for a device and a kind of target. All scenes and frames can share one renderer.
#[derive(Debug)]
pub struct Renderer {
    pub(in crate::gpu) layouts: Layouts,
    pub(in crate::gpu) color: ColorTarget,
    pub(in crate::gpu) data_layers: bool,
    pub(in crate::gpu) keeps_rays: bool,
    pub(in crate::gpu) shade: Vec<(CameraKind, Primitive, ComputePipeline)>,
    pub(in crate::gpu) trace: Vec<(CameraKind, BrickKind, TracePipelines)>,
}

/// Pipelines that trace the first brick of a scene and the later ones.
#[derive(Debug)]
pub(in crate::gpu) struct TracePipelines {
    pub(in crate::gpu) first: ComputePipeline,
    pub(in crate::gpu) later: Option<ComputePipeline>,
}

impl Renderer {
    /// Builds the pipelines on a device that the caller owns.
    ///
    /// # Errors
    /// If the device rejects a kernel, which is a defect of this crate or of the driver.
    pub fn new(device: &Device, options: &RendererOptions) -> Result<Self, GpuError> {
        let RendererOptions { color, data_layers, query, keeps_rays, .. } = *options;
        let layouts = scoped(device, || Layouts::new(device, options))?;
        let (shade, trace) = (Vec::new(), Vec::new());
        let mut renderer = Self { layouts, color, data_layers, keeps_rays, shade, trace };
        for &camera in &options.cameras {
            let Layouts { frame, targets, .. } = &renderer.layouts;
            for &primitive in &options.primitives {
                let kernel = shader::shade_kernel(camera, primitive, color, data_layers)
                    .edited(&options.edits)?;
                let surface = renderer.layouts.surface_of(primitive);
                let shade = pipeline(device, &kernel, &[frame, surface, targets])?;
                renderer.shade.push((camera, primitive, shade));
            }
            for (kind, brick) in &renderer.layouts.brick {
                let groups = [frame, brick];
                let build = |brick_pass| {
                    let kernel = match query {
                        Query::Nearest => {
                            shader::trace_kernel(camera, *kind, brick_pass, keeps_rays)
                        }
                        Query::Any => shader::occluded_kernel(camera, *kind, brick_pass),
                    };
                    pipeline(device, &kernel.edited(&options.edits)?, &groups)
                };
                let later = options.several_bricks.then(|| build(BrickPass::Later)).transpose()?;
                let pipelines = TracePipelines { first: build(BrickPass::First)?, later };
                renderer.trace.push((camera, *kind, pipelines));
            }
        }
        Ok(renderer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::Structure;

    /// wgpu checks shaders, layouts, access modes and record sizes without any driver.
    #[test]
    fn every_pipeline_is_accepted_by_a_device_with_webgpu_limits() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        assert_eq!(device.limits().max_storage_buffer_binding_size, 128 << 20);
        for &color in ColorTarget::ALL {
            for (data_layers, query, keeps_rays) in [
                (false, Query::Nearest, false),
                (true, Query::Nearest, true),
                (true, Query::Any, false),
            ] {
                let options = RendererOptions {
                    color,
                    data_layers,
                    structures: Structure::ALL.to_vec(),
                    primitives: Primitive::ALL.to_vec(),
                    query,
                    keeps_rays,
                    ..RendererOptions::default()
                };
                let renderer = Renderer::new(&device, &options).unwrap();
                assert_eq!(renderer.shade.len(), CameraKind::ALL.len() * Primitive::ALL.len());
            }
        }
    }

    /// Errors in a shader name file and line, whether the parser or the validation finds them.
    #[test]
    fn a_refused_kernel_is_an_error_that_names_the_part() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        let structures = vec![Structure::List];
        let layouts =
            Layouts::new(&device, &RendererOptions { structures, ..RendererOptions::default() });
        for broken in ["fn broken() -> f32 {\n    let x = 1.0;\n}\n", "\nfn broken() -> none {}\n"]
        {
            let kernel = shader::trace_kernel(
                CameraKind::Pinhole,
                layouts.brick[0].0,
                BrickPass::First,
                false,
            )
            .with_part("broken.wgsl", broken);
            match pipeline(&device, &kernel, &[&layouts.frame, &layouts.brick[0].1]) {
                Err(GpuError::Device { message }) => {
                    assert!(message.contains("broken.wgsl:"), "{message}");
                }
                other => panic!("{other:?}"),
            }
        }
    }
}
