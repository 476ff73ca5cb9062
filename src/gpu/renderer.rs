//! Pipelines, and recording a frame with them.

use wgpu::{ComputePass, ComputePipeline, Device, TextureFormat};

use super::error::{GpuError, scoped};
use super::frame::{Frame, Part};
use super::layouts::Layouts;
use super::scene_buffers::SceneBuffers;
use super::shaders::{self, Kernel, ShaderEdit, Turn};
use super::tiles::Groups;
use crate::accel::{BrickKind, Primitive, Structure};
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
    /// The structures that scenes will have.
    pub structures: Vec<Structure>,
    /// What scenes will consist of.
    pub primitives: Vec<Primitive>,
    /// Whether scenes may be too large for one binding, and so consist of several bricks.
    pub several_bricks: bool,
    /// What rays are asked. With [`Query::Any`] a renderer is good for measurements only.
    pub query: Query,
    /// Whether frames keep the ray of every pixel, 32 bytes each, for [`verify`](crate::verify).
    pub keeps_rays: bool,
    /// Changes of shaders; none, but in experiments and tests.
    pub edits: Vec<ShaderEdit>,
}

impl Default for RendererOptions {
    /// Eight-bit colour, no data layers, every camera, every structure that is chosen by itself.
    fn default() -> Self {
        Self {
            color: ColorTarget::default(),
            data_layers: false,
            cameras: CameraKind::ALL.to_vec(),
            structures: Structure::AUTOMATIC.to_vec(),
            primitives: vec![Primitive::Sphere],
            several_bricks: true,
            query: Query::Nearest,
            keeps_rays: false,
            edits: Vec::new(),
        }
    }
}

/// Pipelines. Long-lived: one per device and kind of target, shared by all scenes and frames.
#[derive(Debug)]
pub struct Renderer {
    pub(super) layouts: Layouts,
    pub(super) color: ColorTarget,
    pub(super) data_layers: bool,
    pub(super) keeps_rays: bool,
    shade: Vec<(CameraKind, Primitive, ComputePipeline)>,
    trace: Vec<(CameraKind, BrickKind, TracePipelines)>,
}

/// For the first brick, and for those behind it.
#[derive(Debug)]
struct TracePipelines {
    first: ComputePipeline,
    later: Option<ComputePipeline>,
}

/// What a ray is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Query {
    /// Which sphere is the nearest.
    #[default]
    Nearest,
    /// Whether there is any.
    Any,
}

impl Renderer {
    /// Builds the pipelines on a device that the caller keeps.
    ///
    /// # Errors
    /// If the device refuses a kernel, which is a defect of this crate or of the driver.
    pub fn new(device: &Device, options: &RendererOptions) -> Result<Self, GpuError> {
        let RendererOptions { color, data_layers, query, keeps_rays, .. } = *options;
        let layouts = scoped(device, || Layouts::new(device, options))?;
        let (shade, trace) = (Vec::new(), Vec::new());
        let mut renderer = Self { layouts, color, data_layers, keeps_rays, shade, trace };
        for &camera in &options.cameras {
            let Layouts { frame, targets, .. } = &renderer.layouts;
            for &primitive in &options.primitives {
                let kernel = shaders::shade_kernel(camera, primitive, color, data_layers)
                    .edited(&options.edits)?;
                let surface = renderer.layouts.surface_of(primitive);
                let shade = pipeline(device, &kernel, &[frame, surface, targets])?;
                renderer.shade.push((camera, primitive, shade));
            }
            for (kind, brick) in &renderer.layouts.brick {
                let groups = [frame, brick];
                let build = |turn| {
                    let kernel = match query {
                        Query::Nearest => shaders::trace_kernel(camera, *kind, turn, keeps_rays),
                        Query::Any => shaders::occluded_kernel(camera, *kind, turn),
                    };
                    pipeline(device, &kernel.edited(&options.edits)?, &groups)
                };
                let later = options.several_bricks.then(|| build(Turn::Later)).transpose()?;
                let pipelines = TracePipelines { first: build(Turn::First)?, later };
                renderer.trace.push((camera, *kind, pipelines));
            }
        }
        Ok(renderer)
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
        frame.view(self, scene)?;
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("pinhole"),
            timestamp_writes: None,
        });
        for part in frame.parts() {
            self.record_trace(&mut pass, scene, frame, part)?;
            if part.is_last_of_band {
                self.record_shade(&mut pass, scene, frame, part.band)?;
            }
        }
        Ok(())
    }

    /// Records the tracing of a brick for a band, or a slice of it; the band's record must name its first group.
    pub(super) fn record_trace(
        &self,
        pass: &mut ComputePass<'_>,
        scene: &SceneBuffers,
        frame: &Frame,
        part: Part,
    ) -> Result<(), GpuError> {
        let camera = frame.view(self, scene)?.camera;
        if part.groups.count() == 0 {
            return Ok(());
        }
        let brick = &scene.bricks()[part.brick];
        let kind = brick.kind;
        let pipeline = self
            .trace
            .iter()
            .find(|(of, searched, _)| *of == camera && *searched == kind)
            .and_then(|(_, _, pipelines)| match part.is_first_of_band {
                true => Some(&pipelines.first),
                false => pipelines.later.as_ref(),
            })
            .ok_or(GpuError::NoPipeline { camera, kind })?;
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &frame.band_groups()[part.band], &[]);
        pass.set_bind_group(1, &brick.trace_group, &[]);
        pass.dispatch_workgroups(part.groups.size[0], part.groups.size[1], 1);
        Ok(())
    }

    /// Records the shading of a band whose hits are complete.
    pub(super) fn record_shade(
        &self,
        pass: &mut ComputePass<'_>,
        scene: &SceneBuffers,
        frame: &Frame,
        band: usize,
    ) -> Result<(), GpuError> {
        let view = frame.view(self, scene)?;
        let camera = view.camera;
        let [width, height] = Groups::of_size(view.bands[band]).size;
        pass.set_bind_group(0, &frame.band_groups()[band], &[]);
        pass.set_bind_group(2, frame.target_group(), &[]);
        let mut bound = None;
        for brick in scene.bricks() {
            let kind = brick.kind;
            if bound != Some(kind.primitive) {
                let pipeline = self
                    .shade
                    .iter()
                    .find(|(of, primitive, _)| *of == camera && *primitive == kind.primitive)
                    .map(|(_, _, pipeline)| pipeline)
                    .ok_or(GpuError::NoPipeline { camera, kind })?;
                pass.set_pipeline(pipeline);
                bound = Some(kind.primitive);
            }
            pass.set_bind_group(1, &brick.surface_group, &[]);
            pass.dispatch_workgroups(width, height, 1);
        }
        Ok(())
    }
}

/// A pipeline of a kernel, with its groups in their order.
pub(super) fn pipeline(
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
            GpuError::Device { message: kernel.with_places_in_parts(&message) }
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
    // only `SceneBuffers` writes, from structures whose builders end every list, and the loops of the self-test
    // at numbers from a uniform; and reads beyond a buffer are bounded all the same.
    unsafe { device.create_shader_module_trusted(descriptor, checks) }
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

    /// What only validation finds, and not the parser, is reported at its place as well.
    #[test]
    fn a_refused_kernel_is_an_error_that_names_the_part() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        let structures = vec![Structure::List];
        let layouts =
            Layouts::new(&device, &RendererOptions { structures, ..RendererOptions::default() });
        for broken in ["fn broken() -> f32 {\n    let x = 1.0;\n}\n", "\nfn broken() -> none {}\n"]
        {
            let kernel =
                shaders::trace_kernel(CameraKind::Pinhole, layouts.brick[0].0, Turn::First, false)
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
