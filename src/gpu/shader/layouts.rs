//! Bind group layouts. `shaders/README.md` lists the same bindings.

use std::num::NonZeroU64;

use wgpu::{BindGroupLayout, BindGroupLayoutEntry, BindingType, Device};

use crate::accel::{BrickKind, Primitive, Structure};
use crate::geometry::cone::ConeInFrame;
use crate::gpu::error::GpuError;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::shader::formats::{DEPTH_FORMAT, ID_FORMAT, NORMAL_FORMAT};
use crate::gpu::shader::records;
use crate::gpu::shader::textures::{Searched, reads_textures};

/// The layouts of all bind groups of the kernels for primary rays.
#[derive(Debug)]
pub(crate) struct Layouts {
    /// Layout of bind group 0 of every kernel.
    pub(crate) frame: BindGroupLayout,
    /// Layouts of bind group 1 of `trace`: brick, shapes, ids, and the words of the structure.
    pub(crate) brick: Vec<(BrickKind, BindGroupLayout)>,
    /// Layout of bind group 1 of `shade`, for spheres.
    pub(crate) surface: BindGroupLayout,
    surface_of_cones: BindGroupLayout,
    /// Layout of bind group 3 of kernels that search a brick and shade its shapes: their appearance.
    pub(crate) appearance: BindGroupLayout,
    /// Layout of bind group 2 of `shade`.
    pub(crate) targets: BindGroupLayout,
}

impl Layouts {
    pub(crate) fn new(device: &Device, options: &RendererOptions) -> Self {
        let RendererOptions { color, data_layers, keeps_rays, .. } = *options;
        let layout = |label, kinds: &[BindingType]| layout(device, label, kinds);
        let surface = |primitive| {
            let (words, palette) = (storage::<u32>(true), storage::<records::Color>(true));
            layout("pinhole surface", &[uniform::<records::Brick>(), shapes(primitive), words, palette])
        };
        let mut targets = vec![target(color.texture_format())];
        if data_layers {
            targets.extend([DEPTH_FORMAT, NORMAL_FORMAT, ID_FORMAT].map(target));
        }
        let mut frame = vec![
            uniform::<records::FrameParameters>(),
            storage::<records::Hit>(false),
            storage::<records::Status>(false),
        ];
        if keeps_rays {
            frame.push(storage::<records::RecordedRays>(false));
        }
        Self {
            frame: layout("pinhole frame", &frame),
            brick: options
                .kinds()
                .map(|kind| {
                    let ids = searched(device, Searched::Ids);
                    let mut kinds = vec![uniform::<records::Brick>(), shapes(kind.primitive), ids];
                    kinds.extend(of_structure(device, kind.structure));
                    (kind, layout("pinhole brick", &kinds))
                })
                .collect(),
            surface: surface(Primitive::Sphere),
            surface_of_cones: surface(Primitive::Cone),
            appearance: layout("pinhole appearance", &[storage::<u32>(true), storage::<records::Color>(true)]),
            targets: layout("pinhole targets", &targets),
        }
    }
}

impl Layouts {
    /// Layout of bind group 1 of `trace`.
    pub(crate) fn brick_of(&self, kind: BrickKind) -> Result<&BindGroupLayout, GpuError> {
        let found = self.brick.iter().find(|(of, _)| *of == kind);
        found.map(|(_, layout)| layout).ok_or(GpuError::NoStructure { kind })
    }

    /// Layout of bind group 1 of `trace` for a grid that may later be searched as a nested grid. Both kinds of grids
    /// have the same bindings.
    pub(crate) fn brick_like(&self, kind: BrickKind) -> Result<&BindGroupLayout, GpuError> {
        let bound_as = |kind: BrickKind| (kind.structure.with_nested(true), kind.primitive);
        let found = self.brick.iter().find(|(of, _)| bound_as(*of) == bound_as(kind));
        found.map(|(_, layout)| layout).ok_or(GpuError::NoStructure { kind })
    }

    /// Layout of bind group 1 of `shade`.
    pub(crate) fn surface_of(&self, primitive: Primitive) -> &BindGroupLayout {
        match primitive {
            Primitive::Sphere => &self.surface,
            Primitive::Cone => &self.surface_of_cones,
        }
    }
}

/// Binding type of the shapes of a brick.
fn shapes(primitive: Primitive) -> BindingType {
    match primitive {
        Primitive::Sphere => storage::<records::Sphere>(true),
        Primitive::Cone => storage::<ConeInFrame>(true),
    }
}

/// Creates a layout of bindings with numbers from 0.
pub(crate) fn layout(device: &Device, label: &str, kinds: &[BindingType]) -> BindGroupLayout {
    let kinds: Vec<_> = (0..).zip(kinds.iter().copied()).collect();
    layout_of(device, label, &kinds)
}

/// Creates a layout of bindings with the given numbers.
pub(crate) fn layout_of(device: &Device, label: &str, kinds: &[(u32, BindingType)]) -> BindGroupLayout {
    let visibility = wgpu::ShaderStages::COMPUTE;
    let entry = |&(binding, ty)| BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let entries: Vec<_> = kinds.iter().map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// Binding type of the data of a structure besides its shapes and ids, at binding 3.
fn of_structure(device: &Device, structure: Structure) -> Option<BindingType> {
    match structure {
        Structure::List => None,
        Structure::Tiles => Some(storage::<u32>(false)),
        Structure::RayQuery => Some(BindingType::AccelerationStructure { vertex_return: false }),
        Structure::WideTree | Structure::Grid | Structure::NestedGrid => Some(searched(device, Searched::Words)),
    }
}

/// Binding type of data that the kernels of a device search.
pub(crate) fn searched(device: &Device, searched: Searched) -> BindingType {
    match searched {
        _ if reads_textures(device) => storage_texture(searched.format(), wgpu::StorageTextureAccess::ReadOnly),
        Searched::Ids => storage::<u32>(true),
        Searched::Words => storage::<[u32; 4]>(true),
    }
}

/// Binding type of a uniform record. Because of the minimum size, wgpu compares the sizes of the record and of the WGSL
/// struct when a pipeline is created.
pub(crate) fn uniform<Record>() -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: NonZeroU64::new(size_of::<Record>() as u64),
    }
}

pub(crate) fn storage<Element>(read_only: bool) -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: NonZeroU64::new(size_of::<Element>() as u64),
    }
}

fn target(format: wgpu::TextureFormat) -> BindingType {
    storage_texture(format, wgpu::StorageTextureAccess::WriteOnly)
}

fn storage_texture(format: wgpu::TextureFormat, access: wgpu::StorageTextureAccess) -> BindingType {
    BindingType::StorageTexture { access, format, view_dimension: wgpu::TextureViewDimension::D2 }
}
