//! All passes that a lit picture needs.

use std::num::NonZeroU64;

use wgpu::{
    BindGroup, BindGroupLayout, BindingType, Buffer, CommandEncoder, ComputePassDescriptor,
    ComputePipeline, Device,
};

use crate::accel::Structure;
use crate::camera::CameraKind;
use crate::gpu::checks::Checks;
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;
use crate::gpu::passes::lit::kernels::{self, Mode, Schedule, SkyKind};
use crate::gpu::passes::lit::one_pass::OnePass;
use crate::gpu::passes::lit::records::{
    DispatchParameters, GROUPS_NEEDED, LightingParameters, QUEUE_HEAD,
};
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::profile::PassNames;
use crate::gpu::scene::scene_summary::ExcludeBy;
use crate::gpu::shader::layouts::{Layouts, layout_of, storage, uniform};
use crate::gpu::shader::{BrickPass, Kernel, pipeline, records};

/// The properties in which sets of passes differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct LitKey {
    pub(crate) camera: CameraKind,
    pub(crate) mode: Mode,
    pub(crate) structure: Structure,
    /// The structure of the spheres that cast shadows.
    pub(crate) occluders: Structure,
    /// How rays exclude the sphere on which they start, among all spheres and among those that cast shadows.
    pub(crate) exclude_by: [ExcludeBy; 2],
    /// Whether the scene has several bricks.
    pub(crate) several_bricks: bool,
    /// The kind of picture, if one pass takes whole samples, which needs one brick.
    pub(crate) one_pass: Option<OnePass>,
}

/// Layouts of bind group 0 of most passes (`frame`), of `advance`, and of passes over sums (`film`), and of groups 2
/// and 3.
#[derive(Debug)]
pub(crate) struct LitLayouts {
    pub(super) frame: BindGroupLayout,
    pub(super) advance: BindGroupLayout,
    pub(crate) film: BindGroupLayout,
    /// Layout of bind group 0 of the pass that takes whole samples.
    pub(crate) samples: BindGroupLayout,
    pub(super) lighting: BindGroupLayout,
    pub(super) sky: BindGroupLayout,
}

/// A pass over the camera rays of all pixels, and one over lists of paths that continue.
#[derive(Debug)]
pub(super) struct BySchedule {
    pub(super) pixels: Pass,
    pub(super) queue: Pass,
}

/// The passes of lit pictures for a device, camera, kind of lighting and structure.
#[derive(Debug)]
pub(crate) struct LitPasses {
    pub(super) layouts: LitLayouts,
    pub(super) of_samples: SamplePasses,
    /// The pass that computes the numbers of workgroups of indirect dispatches.
    pub(crate) advance: Pass,
    /// The pass that sums variances and luminances of pixels.
    pub(crate) noise: Pass,
}

/// The passes that take samples.
#[derive(Debug)]
pub(super) enum SamplePasses {
    /// One pass takes whole samples.
    One(Pass),
    /// Several passes take samples step by step.
    Steps(Box<StepPasses>),
}

/// The passes that take samples step by step.
#[derive(Debug)]
pub(super) struct StepPasses {
    pub(super) start: Pass,
    /// Passes for the first brick, and for later bricks.
    pub(super) extend: (BySchedule, Option<BySchedule>),
    pub(super) shade: ShadePasses,
    pub(super) accumulate: Pass,
}

#[derive(Debug)]
pub(super) struct StudioPasses {
    pub(super) surface: BySchedule,
    pub(super) shadow: Pass,
    pub(super) illuminate: Pass,
    pub(super) ambient: Pass,
    pub(super) gather: Pass,
}

#[derive(Debug)]
pub(super) enum ShadePasses {
    Studio(StudioPasses),
    Path { scatter: BySchedule, occlude: Pass },
}

impl LitLayouts {
    pub(crate) fn new(device: &Device) -> Self {
        let frame = uniform::<records::FrameParameters>();
        let queue = storage_of(QUEUE_HEAD + 4);
        let paths = storage::<[f32; 4]>(false);
        let film = storage::<[f32; 4]>(false);
        let dispatch = BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: NonZeroU64::new(size_of::<DispatchParameters>() as u64),
        };
        let read = storage::<[f32; 4]>(true);
        let emitters = BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Uint,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let layout = |label, kinds: &[(u32, BindingType)]| layout_of(device, label, kinds);
        let common = [(0, frame), (2, queue), (3, paths), (4, dispatch)];
        let with = |more: &[(u32, BindingType)]| [&common, more].concat();
        Self {
            frame: layout("pinhole frame", &common),
            advance: layout("pinhole advance", &with(&[(5, storage_of(GROUPS_NEEDED))])),
            film: layout("pinhole film", &with(&[(5, film), (6, storage::<[f32; 2]>(false))])),
            samples: layout("pinhole samples", &[(0, frame), (2, queue), (4, dispatch), (5, film)]),
            lighting: layout(
                "pinhole lighting",
                &[(0, uniform::<LightingParameters>()), (1, read), (2, emitters)],
            ),
            sky: layout("pinhole sky", &[(0, read), (1, storage::<f32>(true))]),
        }
    }
}

/// The type of a storage buffer that is read and written and has at least `bytes` bytes.
fn storage_of(bytes: u64) -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: false },
        has_dynamic_offset: false,
        min_binding_size: NonZeroU64::new(bytes),
    }
}

impl LitPasses {
    /// Builds all pipelines.
    pub(crate) async fn new(device: &Device, key: LitKey, edits: &Edits) -> Result<Self, GpuError> {
        let checks = Checks::default();
        let passes = Self::begin(device, key, edits, &checks)?;
        checks.passed().await?;
        Ok(passes)
    }

    /// Begins to build all pipelines. Whether the device accepts them is known when the checks have passed.
    fn begin(
        device: &Device,
        key: LitKey,
        edits: &Edits,
        checks: &Checks,
    ) -> Result<Self, GpuError> {
        let options = RendererOptions {
            cameras: Vec::new(),
            structures: vec![key.structure, key.occluders],
            ..RendererOptions::default()
        };
        let scene = checks.create(device, || Layouts::new(device, &options));
        let layouts = checks.create(device, || LitLayouts::new(device));
        let build = |kernel: Kernel, groups: &[&BindGroupLayout]| {
            Pass::new(device, kernel, groups, edits, checks)
        };
        let both = |kernel: &dyn Fn(Schedule) -> Kernel, groups: &[&BindGroupLayout]| {
            Ok::<_, GpuError>(BySchedule {
                pixels: build(kernel(Schedule::Pixels), groups)?,
                queue: build(kernel(Schedule::Queue), groups)?,
            })
        };
        let brick = |index: usize| &scene.brick[index].1;
        let surfaces = &scene.surface;
        let LitLayouts { frame, advance, film, samples, lighting, sky } = &layouts;
        let [exclude_by, light_exclude_by] = key.exclude_by;
        if let Some(pass) = key.one_pass {
            let kernel = pass.kernel(key.camera, key.structure, exclude_by);
            let groups = [samples, brick(0), lighting, &scene.appearance];
            return Ok(Self {
                of_samples: SamplePasses::One(build(kernel, &groups)?),
                advance: build(kernels::advance_kernel(), &[advance])?,
                noise: build(kernels::noise_kernel(), &[film])?,
                layouts,
            });
        }
        let (occluders, lit_brick) = (key.occluders, [frame, brick(1), lighting]);
        let extend = |brick_pass| {
            let kernel = |by| kernels::extend_kernel(key.structure, exclude_by, brick_pass, by);
            both(&kernel, &[frame, brick(0)])
        };
        let shade = match key.mode {
            Mode::Studio => ShadePasses::Studio(StudioPasses {
                surface: both(&kernels::surface_kernel, &[frame, surfaces, lighting])?,
                shadow: build(kernels::shadow_kernel(occluders, light_exclude_by), &lit_brick)?,
                illuminate: build(kernels::illuminate_kernel(), &[frame, surfaces, lighting])?,
                ambient: build(kernels::ambient_kernel(occluders, light_exclude_by), &lit_brick)?,
                gather: build(kernels::gather_kernel(), &[frame, surfaces, lighting])?,
            }),
            Mode::Path(surface, sources, kind) => {
                let kernel = |by| kernels::scatter_kernel(by, surface, sources, kind);
                let mut groups = vec![frame, surfaces, lighting];
                if kind == SkyKind::Image {
                    groups.push(sky);
                }
                ShadePasses::Path {
                    scatter: both(&kernel, &groups)?,
                    occlude: build(
                        kernels::occlude_kernel(occluders, light_exclude_by, key.mode),
                        &lit_brick,
                    )?,
                }
            }
        };
        let start = kernels::start_kernel(key.camera, key.mode);
        Ok(Self {
            of_samples: SamplePasses::Steps(Box::new(StepPasses {
                start: build(start, &[frame, surfaces, lighting])?,
                extend: (
                    extend(BrickPass::First)?,
                    key.several_bricks.then(|| extend(BrickPass::Later)).transpose()?,
                ),
                shade,
                accumulate: build(kernels::accumulate_kernel(key.mode), &[film])?,
            })),
            advance: build(kernels::advance_kernel(), &[advance])?,
            noise: build(kernels::noise_kernel(), &[film])?,
            layouts,
        })
    }
}

/// The pipeline of a kernel, which can be recorded into any encoder of its device.
#[derive(Debug)]
pub(crate) struct Pass {
    /// The name of the entry point.
    name: &'static str,
    pipeline: ComputePipeline,
}

/// The bind groups of a dispatch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound<'a> {
    /// Bind group 0: the frame, the lists, the paths and the parameters of the dispatch.
    pub(super) frame: &'a BindGroup,
    /// Offset of the parameters of the dispatch in bytes.
    pub(super) dispatch: u32,
    /// Bind group 1: a brick.
    pub(super) brick: Option<&'a BindGroup>,
    /// Bind group 2: lights and materials.
    pub(super) lighting: &'a BindGroup,
    /// Bind group 3: the image of the sky, or the appearance of the shapes of the brick.
    pub(super) last: Option<&'a BindGroup>,
}

/// The number of workgroups of a dispatch.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Extent<'a> {
    /// The numbers of workgroups along the three axes.
    Groups([u32; 3]),
    /// An indirect dispatch, which reads the numbers from a buffer at an offset in bytes.
    Indirect(&'a Buffer, u64),
}

impl Pass {
    /// Builds the pipeline. `groups` are the layouts of its bind groups, in order. Whether the device accepts it is
    /// known when the checks have passed.
    pub(super) fn new(
        device: &Device,
        kernel: Kernel,
        groups: &[&BindGroupLayout],
        edits: &Edits,
        checks: &Checks,
    ) -> Result<Self, GpuError> {
        let name = kernel.entry_point;
        Ok(Self { name, pipeline: pipeline(device, &kernel.edited(edits)?, groups, checks) })
    }

    /// Records one dispatch, and notes its name. Nothing is submitted.
    pub(super) fn record(
        &self,
        encoder: &mut CommandEncoder,
        bound: Bound<'_>,
        extent: Extent<'_>,
        names: &mut PassNames,
    ) {
        names.note(self.name);
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("pinhole"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bound.frame, &[bound.dispatch]);
        if let Some(brick) = bound.brick {
            pass.set_bind_group(1, brick, &[]);
            pass.set_bind_group(2, bound.lighting, &[]);
            if let Some(last) = bound.last {
                pass.set_bind_group(3, last, &[]);
            }
        }
        match extent {
            Extent::Groups([x, y, z]) => pass.dispatch_workgroups(x, y, z),
            Extent::Indirect(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, offset),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::kernels::{Materials, Sources};
    use super::super::one_pass::one_pass_fits;
    use super::*;
    use crate::gpu::headless::waiting::Wait;

    /// wgpu checks shaders, layouts, access modes and record sizes, and that no kernel has more buffers than every
    /// device supports, without any driver.
    #[test]
    fn every_pass_is_accepted_by_a_device_with_webgpu_limits() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        assert_eq!(device.limits().max_storage_buffers_per_shader_stage, 8);
        let mut modes = vec![Mode::Studio];
        for surfaces in [Materials::Matt, Materials::Any] {
            for sources in [Sources::None, Sources::Any] {
                for sky in [SkyKind::Plain, SkyKind::Image] {
                    modes.push(Mode::Path(surfaces, sources, sky));
                }
            }
        }
        for mode in modes {
            for &camera in CameraKind::ALL {
                // A structure with the most buffers.
                let structure = Structure::NestedGrid;
                let (occluders, several_bricks) = (structure, true);
                for exclude_by in ExcludeBy::ALL {
                    let exclude_by = [exclude_by; 2];
                    let key = LitKey {
                        camera,
                        mode,
                        structure,
                        occluders,
                        exclude_by,
                        several_bricks,
                        one_pass: None,
                    };
                    LitPasses::new(&device, key, &Edits::default()).wait().unwrap();
                    assert!(one_pass_fits(structure, &device.limits()));
                    for pass in OnePass::ALL {
                        let key = LitKey { one_pass: Some(pass), ..key };
                        if mode == Mode::Studio {
                            LitPasses::new(&device, key, &Edits::default()).wait().unwrap();
                        }
                    }
                }
            }
        }
    }
}
