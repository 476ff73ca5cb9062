//! All passes that a lit picture needs.

use std::collections::HashMap;
use std::num::NonZeroU64;

use wgpu::{
    BindGroup, BindGroupLayout, BindingType, Buffer, CommandEncoder, ComputePassDescriptor, ComputePipeline, Device,
};

use crate::accel::BrickKind;
use crate::gpu::checks::Checks;
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;
use crate::gpu::passes::lit::kernels::{LitKey, Mode, OF_ALL, PassName, SkyKind};
use crate::gpu::passes::lit::records::{DispatchParameters, GROUPS_NEEDED, LightingParameters, QUEUE_HEAD};
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::profile::NotedPass;
use crate::gpu::shader::layouts::{Layouts, layout_of, storage, uniform};
use crate::gpu::shader::{pipeline, records};

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

/// The passes of lit pictures for a device, camera, kind of lighting and structure.
#[derive(Debug)]
pub(crate) struct LitPasses {
    pub(super) key: LitKey,
    pub(crate) layouts: LitLayouts,
    /// The passes that take samples.
    of_samples: HashMap<PassName, Pass>,
    /// The pass that computes the numbers of workgroups of indirect dispatches.
    pub(crate) advance: Pass,
    /// The pass that sums variances and luminances of pixels.
    pub(crate) noise: Pass,
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
            lighting: layout("pinhole lighting", &[(0, uniform::<LightingParameters>()), (1, read), (2, emitters)]),
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
        let kinds: Vec<BrickKind> = key.structures.kinds().chain(key.occluders.kinds()).collect();
        let options = RendererOptions { cameras: Vec::new(), ..RendererOptions::default() }.with_kinds(&kinds);
        let scene = checks.create(device, || Layouts::new(device, &options));
        let layouts = checks.create(device, || LitLayouts::new(device));
        let LitLayouts { frame, advance, film, samples, lighting, sky } = &layouts;
        let build = |name: PassName| {
            let kernel = key.kernel(name).edited(edits)?;
            let (brick, surface) = (scene.brick_of(key.kind_of(name)), scene.surface_of(name.primitive));
            let groups = match name.entry_point {
                "advance" => vec![advance],
                "accumulate" | "noise" => vec![film],
                "extend" => vec![frame, brick?],
                "one_pass" | "whole_paths" => vec![samples, brick?, lighting, &scene.appearance],
                entry_point if LitKey::finds_occluders(entry_point) => vec![frame, brick?, lighting],
                "scatter" if matches!(key.mode, Mode::Path(.., SkyKind::Image)) => {
                    vec![frame, surface, lighting, sky]
                }
                _ => vec![frame, surface, lighting],
            };
            let pipeline = pipeline(device, &kernel, &groups, &checks);
            Ok::<_, GpuError>(Pass { name: kernel.entry_point, pipeline })
        };
        let of_samples = key.passes().into_iter().map(|name| Ok((name, build(name)?)));
        let of_samples: HashMap<_, _> = of_samples.collect::<Result<_, GpuError>>()?;
        let [advance, noise] = OF_ALL.map(build);
        let (advance, noise) = (advance?, noise?);
        checks.passed().await?;
        Ok(Self { key, layouts, of_samples, advance, noise })
    }

    /// The pass with this name that takes samples.
    pub(super) fn named(&self, name: PassName) -> Result<&Pass, GpuError> {
        self.of_samples.get(&name).ok_or(GpuError::OtherRenderer)
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
    /// Records one dispatch, and notes its name. Nothing is submitted.
    pub(super) fn record(
        &self,
        encoder: &mut CommandEncoder,
        bound: Bound<'_>,
        extent: Extent<'_>,
        noted: &mut NotedPass,
    ) {
        noted.note(self.name);
        let mut pass =
            encoder.begin_compute_pass(&ComputePassDescriptor { label: Some("pinhole"), timestamp_writes: None });
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
    use super::super::kernels::one_pass_fits;
    use super::*;
    use crate::accel::Structure;
    use crate::gpu::headless::waiting::Wait;

    /// wgpu checks shaders, layouts, access modes and record sizes, and that no kernel has more buffers than every
    /// device supports, without any driver.
    #[test]
    fn every_pass_is_accepted_by_a_device_with_webgpu_limits() {
        let (device, _) = Device::noop(&wgpu::DeviceDescriptor::default());
        assert_eq!(device.limits().max_storage_buffers_per_shader_stage, 8);
        // A structure with the most buffers.
        let structure = Structure::NestedGrid;
        assert!(one_pass_fits(structure, &device.limits()));
        for key in LitKey::all(&[structure]) {
            LitPasses::new(&device, key, &Edits::default()).wait().unwrap();
        }
    }
}
