//! Bind group layouts. `shaders/README.md` lists the same bindings.

use std::num::NonZeroU64;

use wgpu::{BindGroupLayout, BindGroupLayoutEntry, BindingType, Device};

use super::records;
use super::renderer::{ColorTarget, DEPTH_FORMAT, ID_FORMAT, NORMAL_FORMAT};

/// The layouts of all groups that the kernels use.
#[derive(Debug)]
pub(super) struct Layouts {
    /// Group 0 of every kernel.
    pub(super) frame: BindGroupLayout,
    /// Group 1 of `trace`.
    pub(super) slice: BindGroupLayout,
    /// Group 1 of `shade`.
    pub(super) scene: BindGroupLayout,
    /// Group 2 of `shade`.
    pub(super) targets: BindGroupLayout,
}

impl Layouts {
    pub(super) fn new(device: &Device, color: ColorTarget, data_layers: bool) -> Self {
        let layout = |label, kinds: &[BindingType]| {
            let entries: Vec<_> =
                (0..).zip(kinds).map(|(binding, ty)| entry(binding, *ty)).collect();
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &entries,
            })
        };
        let mut targets = vec![target(color.texture_format())];
        if data_layers {
            targets.extend([DEPTH_FORMAT, NORMAL_FORMAT, ID_FORMAT].map(target));
        }
        Self {
            frame: layout(
                "pinhole frame",
                &[uniform::<records::Frame>(), storage::<records::Hit>(false)],
            ),
            slice: layout(
                "pinhole slice",
                &[uniform::<records::Slice>(), storage::<records::Sphere>(true)],
            ),
            scene: layout(
                "pinhole scene",
                &[storage::<records::Sphere>(true), storage::<records::Color>(true)],
            ),
            targets: layout("pinhole targets", &targets),
        }
    }
}

fn entry(binding: u32, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None }
}

/// With a minimum size, wgpu compares record and WGSL when a pipeline is created.
fn uniform<Record>() -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: NonZeroU64::new(size_of::<Record>() as u64),
    }
}

fn storage<Element>(read_only: bool) -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: NonZeroU64::new(size_of::<Element>() as u64),
    }
}

fn target(format: wgpu::TextureFormat) -> BindingType {
    BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format,
        view_dimension: wgpu::TextureViewDimension::D2,
    }
}
