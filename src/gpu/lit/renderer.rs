//! Pipelines of lit pictures.

use std::collections::HashMap;
use std::num::NonZeroU64;

use wgpu::{BindGroupLayout, BindingType, ComputePipeline, Device};

use super::kernels::{self, Mode, SkyKind};
use super::records::{Look, Stage};
use crate::accel::Structure;
use crate::camera::CameraKind;
use crate::gpu::error::{GpuError, scoped};
use crate::gpu::layouts::{Layouts, layout_of, storage, uniform};
use crate::gpu::records;
use crate::gpu::renderer::{RendererOptions, pipeline};
use crate::gpu::shaders::{Kernel, ShaderEdit, Turn};

/// What lit renderers differ in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) struct LitKey {
    pub(super) camera: CameraKind,
    pub(super) mode: Mode,
    pub(super) structure: Structure,
    /// Of what casts shadows.
    pub(super) occluders: Structure,
}

/// Group 0, for those who search and those who shade; group 2 and 3.
#[derive(Debug)]
pub(in crate::gpu) struct LitLayouts {
    pub(super) search: BindGroupLayout,
    pub(super) shade: BindGroupLayout,
    pub(super) film: BindGroupLayout,
    pub(super) look: BindGroupLayout,
    pub(super) sky: BindGroupLayout,
}

/// One per device, camera, kind of lighting and structure.
#[derive(Debug)]
pub(in crate::gpu) struct LitRenderer {
    pub(super) layouts: LitLayouts,
    pub(super) start: ComputePipeline,
    pub(super) extend: [ComputePipeline; 2],
    pub(super) deposit: ComputePipeline,
    pub(super) shade: Shaders,
}

#[derive(Debug)]
pub(in crate::gpu) enum Shaders {
    Studio {
        surface: ComputePipeline,
        shadow: ComputePipeline,
        illuminate: ComputePipeline,
        ambient: ComputePipeline,
        gather: ComputePipeline,
    },
    Path {
        scatter: ComputePipeline,
        occlude: ComputePipeline,
    },
}

impl LitLayouts {
    fn new(device: &Device) -> Self {
        let frame = uniform::<records::Frame>();
        let hits = storage::<records::Hit>(false);
        let status = storage::<records::Status>(false);
        let paths = storage::<[f32; 4]>(false);
        let film = storage::<[f32; 4]>(false);
        let stage = BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: NonZeroU64::new(size_of::<Stage>() as u64),
        };
        let read = storage::<[f32; 4]>(true);
        let layout = |label, kinds: &[(u32, BindingType)]| layout_of(device, label, kinds);
        Self {
            search: layout(
                "pinhole search",
                &[(0, frame), (1, hits), (2, status), (3, paths), (4, stage)],
            ),
            shade: layout("pinhole shade", &[(0, frame), (1, hits), (3, paths), (4, stage)]),
            film: layout("pinhole film", &[(0, frame), (3, paths), (4, stage), (5, film)]),
            look: layout("pinhole look", &[(0, uniform::<Look>()), (1, read)]),
            sky: layout("pinhole sky", &[(0, read), (1, storage::<f32>(true))]),
        }
    }
}

impl LitRenderer {
    pub(in crate::gpu) fn new(
        device: &Device,
        key: LitKey,
        edits: &[ShaderEdit],
    ) -> Result<Self, GpuError> {
        let options = RendererOptions {
            cameras: Vec::new(),
            structures: vec![key.structure, key.occluders],
            ..RendererOptions::default()
        };
        let scene = scoped(device, || Layouts::new(device, &options))?;
        let layouts = scoped(device, || LitLayouts::new(device))?;
        let build = |kernel: Kernel, groups: &[&BindGroupLayout]| {
            pipeline(device, &kernel.edited(edits)?, groups)
        };
        let is_studio = key.mode == Mode::Studio;
        let brick = |index: usize| &scene.brick[index].1;
        let LitLayouts { search, shade, film, look, sky } = &layouts;
        let extend = |turn| build(kernels::extend_kernel(key.structure, turn), &[search, brick(0)]);
        let shaders = match key.mode {
            Mode::Studio => Shaders::Studio {
                surface: build(kernels::surface_kernel(), &[shade, &scene.surface, look])?,
                shadow: build(kernels::shadow_kernel(key.occluders), &[search, brick(1), look])?,
                illuminate: build(kernels::illuminate_kernel(), &[shade, &scene.surface, look])?,
                ambient: build(kernels::ambient_kernel(key.occluders), &[search, brick(1), look])?,
                gather: build(kernels::gather_kernel(), &[shade, &scene.surface, look])?,
            },
            Mode::Path(surfaces, sources, kind) => {
                let kernel = kernels::scatter_kernel(surfaces, sources, kind);
                let mut groups = vec![shade, &scene.surface, look];
                if kind == SkyKind::Image {
                    groups.push(sky);
                }
                Shaders::Path {
                    scatter: build(kernel, &groups)?,
                    occlude: build(kernels::occlude_kernel(key.occluders), &[search, brick(1)])?,
                }
            }
        };
        Ok(Self {
            start: build(
                kernels::start_kernel(key.camera, is_studio),
                &[shade, &scene.surface, look],
            )?,
            extend: [extend(Turn::First)?, extend(Turn::Later)?],
            deposit: build(kernels::deposit_kernel(is_studio), &[film])?,
            shade: shaders,
            layouts,
        })
    }
}

/// The lit renderers of a device, each built when it is first wanted.
pub(in crate::gpu) type LitRenderers = HashMap<LitKey, LitRenderer>;
