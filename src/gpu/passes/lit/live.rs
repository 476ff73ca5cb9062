//! The passes of live pictures: one ray of the camera and a few towards light for each pixel, averaged over frames and
//! neighbours.

use std::num::NonZeroU64;

use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroupLayout, BindingType, ComputePipeline, Device};

use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::CameraKind;
use crate::gpu::checks::Checks;
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;
use crate::gpu::passes::lit::kernels::{LitKey, OnePass};
use crate::gpu::passes::lit::passes::LitLayouts;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::scene::scene_summary::ExcludeBy;
use crate::gpu::shader::formats::ColorTarget;
use crate::gpu::shader::layouts::{Layouts, layout_of, storage};
use crate::gpu::shader::{
    Kernel, camera_constant, color_target_choice, data_layers_choice, lit_choices, pipeline, pipeline_with,
};

/// The properties in which sets of passes differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct LiveKey {
    pub(crate) camera: CameraKind,
    pub(crate) structure: Structure,
    pub(crate) exclude_by: ExcludeBy,
    pub(crate) has_ground: bool,
}

/// The cameras of a frame and of the previous one. Twin: `LiveView` in `shaders/live/view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LiveView {
    pub(crate) right: [f32; 3],
    pub(crate) is_parallel: u32,
    pub(crate) up: [f32; 3],
    pub(crate) footprint: f32,
    pub(crate) forward: [f32; 3],
    pub(crate) y_sign: f32,
    pub(crate) shift: [f32; 3],
    pub(crate) has_before: u32,
    pub(crate) across: [f32; 3],
    pub(crate) most_lamps: u32,
    pub(crate) down: [f32; 3],
    pub(crate) most_open: u32,
    pub(crate) along: [f32; 3],
    pub(crate) zero: u32,
    pub(crate) size: [u32; 2],
    pub(crate) pad: [u32; 2],
}

/// The pipelines, and the layouts of their bind groups.
#[derive(Debug)]
pub(crate) struct LivePasses {
    pub(crate) lit: LitLayouts,
    /// Layout of bind group 0 of the passes after the first.
    pub(crate) known: BindGroupLayout,
    pub(crate) live: ComputePipeline,
    pub(crate) reproject: ComputePipeline,
    pub(crate) show: ComputePipeline,
}

/// The kernel that traces the rays of a frame.
fn live_kernel(key: LiveKey) -> Kernel {
    Kernel::new("live", &lit_choices(BrickKind { structure: key.structure, primitive: Primitive::Sphere })).with([
        camera_constant(key.camera),
        key.exclude_by.constant(),
        ("HAS_GROUND", u32::from(key.has_ground)),
    ])
}

/// The kernel that averages over neighbours and writes the picture.
fn show_kernel(color: ColorTarget, has_data: bool) -> Kernel {
    Kernel::new("show", &[color_target_choice(color), data_layers_choice(has_data)])
}

/// All kernels of live pictures.
pub(crate) fn live_kernels() -> Vec<Kernel> {
    let mut kernels = vec![Kernel::new("reproject", &[])];
    for &color in ColorTarget::ALL {
        kernels.extend([false, true].map(|has_data| show_kernel(color, has_data)));
    }
    for &structure in Structure::WITH_KERNELS {
        for exclude_by in ExcludeBy::ALL {
            for &camera in CameraKind::ALL {
                kernels.extend(
                    [false, true].map(|has_ground| live_kernel(LiveKey { camera, structure, exclude_by, has_ground })),
                );
            }
        }
    }
    kernels
}

impl LiveKey {
    /// The key for a studio whose samples one pass can take as a whole.
    pub(crate) fn new(of: &LitKey) -> Option<Self> {
        let LitKey { camera, structures, exclude_by: [exclude_by, _], one_pass, .. } = *of;
        let studio = one_pass.filter(|pass| !pass.is_paths())?;
        Some(Self { camera, structure: structures.spheres?, exclude_by, has_ground: studio == OnePass::Ground })
    }
}

impl LivePasses {
    /// Builds the pipelines. `targets` is the layout of the host's textures, in a renderer with these formats.
    pub(crate) async fn new(
        device: &Device,
        key: LiveKey,
        (color, has_data, targets): (ColorTarget, bool, &BindGroupLayout),
        edits: &Edits,
    ) -> Result<Self, GpuError> {
        let checks = Checks::default();
        let options =
            RendererOptions { cameras: Vec::new(), structures: vec![key.structure], ..RendererOptions::default() };
        let scene = checks.create(device, || Layouts::new(device, &options));
        let lit = checks.create(device, || LitLayouts::new(device));
        let view = BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: NonZeroU64::new(size_of::<LiveView>() as u64),
        };
        let pixels = |is_read| storage::<[u32; 4]>(is_read);
        let known = [(0, view), (1, pixels(true)), (2, pixels(true)), (3, pixels(false))];
        let known = checks.create(device, || layout_of(device, "pinhole live", &known));
        let brick = &scene.brick[0].1;
        let groups = [&lit.samples, brick, &lit.lighting, &scene.appearance];
        let live = pipeline(device, &live_kernel(key).edited(edits)?, &groups, &checks);
        let reproject = pipeline(device, &Kernel::new("reproject", &[]).edited(edits)?, &[&known], &checks);
        let show = show_kernel(color, has_data).edited(edits)?;
        let show = pipeline_with(device, &show, &[Some(&known), None, Some(targets)], &checks);
        checks.passed().await?;
        Ok(Self { lit, known, live, reproject, show })
    }
}
