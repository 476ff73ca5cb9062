//! Pipelines, and recording a frame with them.

use wgpu::{ComputePipeline, Device, TextureFormat};

use super::error::{GpuError, scoped};
use super::frame::Frame;
use super::layouts::Layouts;
use super::scene_buffers::SceneBuffers;
use super::shaders::{self, Kernel};
use super::tiles::WORKGROUP_SIDE;
use crate::camera::CameraKind;

pub(super) const DEPTH_FORMAT: TextureFormat = TextureFormat::R32Float;
pub(super) const NORMAL_FORMAT: TextureFormat = TextureFormat::Rgba32Float;
pub(super) const ID_FORMAT: TextureFormat = TextureFormat::R32Uint;

/// The texture that colour is written to. All of them work on every WebGPU device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ColorTarget {
    /// `Rgba8Unorm`, holding sRGB: a flat colour comes out as exactly its bytes. To sample it as
    /// linear light, view the texture as `Rgba8UnormSrgb`.
    #[default]
    Srgb8,
    /// `Rgba16Float`, holding linear light.
    Linear16,
    /// `Rgba32Float`, holding linear light.
    Linear32,
}

impl ColorTarget {
    /// All of them.
    pub const ALL: &'static [Self] = &[Self::Srgb8, Self::Linear16, Self::Linear32];

    /// The format that the caller's texture must have.
    #[must_use]
    pub const fn texture_format(self) -> TextureFormat {
        match self {
            Self::Srgb8 => TextureFormat::Rgba8Unorm,
            Self::Linear16 => TextureFormat::Rgba16Float,
            Self::Linear32 => TextureFormat::Rgba32Float,
        }
    }
}

/// What a renderer is built for. Fewer cameras are quicker to build.
#[derive(Clone, Debug)]
pub struct RendererOptions {
    /// The colour texture.
    pub color: ColorTarget,
    /// Whether depth, normal and id are written as well.
    pub data_layers: bool,
    /// The cameras that frames will use.
    pub cameras: Vec<CameraKind>,
}

impl Default for RendererOptions {
    /// Eight-bit colour, no data layers, every camera.
    fn default() -> Self {
        Self {
            color: ColorTarget::default(),
            data_layers: false,
            cameras: CameraKind::ALL.to_vec(),
        }
    }
}

/// Pipelines. Long-lived: one per device and kind of target, shared by all scenes and frames.
#[derive(Debug)]
pub struct Renderer {
    pub(super) layouts: Layouts,
    pub(super) color: ColorTarget,
    pub(super) data_layers: bool,
    pipelines: Vec<CameraPipelines>,
}

#[derive(Debug)]
struct CameraPipelines {
    camera: CameraKind,
    trace: ComputePipeline,
    shade: ComputePipeline,
}

impl Renderer {
    /// Builds the pipelines on a device that the caller keeps.
    ///
    /// # Errors
    /// If the device refuses a kernel, which is a defect of this crate or of the driver.
    pub fn new(device: &Device, options: &RendererOptions) -> Result<Self, GpuError> {
        let RendererOptions { color, data_layers, ref cameras } = *options;
        let layouts = scoped(device, || Layouts::new(device, color, data_layers))?;
        let pipelines = cameras
            .iter()
            .map(|&camera| {
                let trace = shaders::trace_kernel(camera);
                let shade = shaders::shade_kernel(camera, color, data_layers);
                Ok(CameraPipelines {
                    camera,
                    trace: pipeline(device, &trace, &[&layouts.frame, &layouts.slice])?,
                    shade: pipeline(
                        device,
                        &shade,
                        &[&layouts.frame, &layouts.scene, &layouts.targets],
                    )?,
                })
            })
            .collect::<Result<_, GpuError>>()?;
        Ok(Self { layouts, color, data_layers, pipelines })
    }

    /// Records the frame's view of the scene into the caller's encoder, as one compute pass.
    ///
    /// Nothing is submitted. The frame's targets hold the picture once the caller's queue has run the
    /// encoder; they are overwritten whole.
    ///
    /// # Errors
    /// If the frame has no view of this scene, was made for other targets, or has a camera that this
    /// renderer was not built for.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneBuffers,
        frame: &Frame,
    ) -> Result<(), GpuError> {
        let view = frame.view(self, scene)?;
        let pipelines = self
            .pipelines
            .iter()
            .find(|pipelines| pipelines.camera == view.camera)
            .ok_or(GpuError::NoCamera { camera: view.camera })?;
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("pinhole"),
            timestamp_writes: None,
        });
        for (band, size) in frame.band_groups().iter().zip(&view.bands) {
            let [width, height] = size.map(|side| side.div_ceil(WORKGROUP_SIDE));
            pass.set_bind_group(0, band, &[]);
            pass.set_pipeline(&pipelines.trace);
            for slice in scene.slices() {
                pass.set_bind_group(1, slice, &[]);
                pass.dispatch_workgroups(width, height, 1);
            }
            pass.set_pipeline(&pipelines.shade);
            pass.set_bind_group(1, scene.group(), &[]);
            pass.set_bind_group(2, frame.target_group(), &[]);
            pass.dispatch_workgroups(width, height, 1);
        }
        Ok(())
    }
}

fn pipeline(
    device: &Device,
    kernel: &Kernel,
    groups: &[&wgpu::BindGroupLayout],
) -> Result<ComputePipeline, GpuError> {
    let name = kernel.name();
    let groups: Vec<_> = groups.iter().map(|group| Some(*group)).collect();
    scoped(device, || {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(&name),
            source: wgpu::ShaderSource::Wgsl(kernel.source().into()),
        });
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
            GpuError::Device { message: kernel.with_places_in_parts(&message) }
        }
        other => other,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// wgpu checks shaders, layouts, access modes and record sizes, with no driver at all.
    #[test]
    fn every_pipeline_is_accepted_by_a_device_with_webgpu_limits() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        assert_eq!(device.limits().max_storage_buffer_binding_size, 128 << 20);
        for &color in ColorTarget::ALL {
            for data_layers in [false, true] {
                let options = RendererOptions { color, data_layers, ..RendererOptions::default() };
                let renderer = Renderer::new(&device, &options).unwrap();
                assert_eq!(renderer.pipelines.len(), CameraKind::ALL.len());
            }
        }
    }

    /// What only validation finds, and not the parser, is reported at its place as well.
    #[test]
    fn a_refused_kernel_is_an_error_that_names_the_part() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        let layouts = Layouts::new(&device, ColorTarget::Srgb8, false);
        for broken in ["fn broken() -> f32 {\n    let x = 1.0;\n}\n", "\nfn broken() -> none {}\n"]
        {
            let kernel =
                shaders::trace_kernel(CameraKind::Pinhole).with_part("broken.wgsl", broken);
            match pipeline(&device, &kernel, &[&layouts.frame, &layouts.slice]) {
                Err(GpuError::Device { message }) => {
                    assert!(message.contains("broken.wgsl:"), "{message}");
                }
                other => panic!("{other:?}"),
            }
        }
    }
}
