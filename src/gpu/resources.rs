//! Creating buffers, textures and bind groups.

use std::num::NonZeroU64;

use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Buffer, BufferUsages, Device, Queue, Texture, TextureFormat,
    TextureUsages,
};

/// Creates buffers on a device, and queues their contents.
#[derive(Clone, Copy)]
pub(crate) struct Make<'a> {
    pub(crate) device: &'a Device,
    pub(crate) queue: &'a Queue,
}

impl Make<'_> {
    pub(crate) fn buffer(self, label: &'static str, bytes: u64, usage: BufferUsages) -> Buffer {
        buffer(self.device, label, bytes, usage)
    }

    pub(crate) fn filled(self, label: &'static str, bytes: &[u8], usage: BufferUsages) -> Buffer {
        let buffer = self.buffer(label, bytes.len() as u64, usage);
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }
}

/// A buffer that can be written.
pub(crate) fn buffer(device: &Device, label: &'static str, bytes: u64, usage: BufferUsages) -> Buffer {
    // If device and host share their memory, wgpu clears a buffer that is mapped on the host. A software device takes twice
    // as long to clear a large one.
    let is_mapped = bytes >= LARGE
        && !usage.contains(BufferUsages::MAP_READ)
        && device.features().contains(wgpu::Features::MAPPABLE_PRIMARY_BUFFERS);
    let written = if is_mapped { BufferUsages::MAP_WRITE } else { BufferUsages::empty() };
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes,
        usage: usage | written | BufferUsages::COPY_DST,
        mapped_at_creation: is_mapped,
    });
    if is_mapped {
        buffer.unmap();
    }
    buffer
}

/// Size in bytes of a buffer that takes some time to clear.
const LARGE: u64 = 1 << 20;

/// A texture of two dimensions.
pub(crate) fn texture(
    device: &Device,
    label: &'static str,
    format: TextureFormat,
    size: [u32; 2],
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: extent(size),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

pub(crate) fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}

/// A binding and its resource.
pub(crate) type Entry<'a> = (u32, BindingResource<'a>);

/// A bind group of some resources.
pub(crate) fn bind_group(device: &Device, label: &str, layout: &BindGroupLayout, entries: &[Entry<'_>]) -> BindGroup {
    let entries = entries.iter().cloned();
    let entries: Vec<_> = entries.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    let descriptor = wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries };
    device.create_bind_group(&descriptor)
}

/// A bind group of resources that are numbered from 0.
pub(crate) fn numbered_group<'a>(
    device: &Device,
    label: &str,
    layout: &BindGroupLayout,
    resources: impl IntoIterator<Item = BindingResource<'a>>,
) -> BindGroup {
    bind_group(device, label, layout, &(0..).zip(resources).collect::<Vec<_>>())
}

/// The whole buffer at a binding.
pub(crate) fn whole(binding: u32, buffer: &Buffer) -> Entry<'_> {
    (binding, buffer.as_entire_binding())
}

/// A binding of a part of a buffer. `offset` and `size` are in bytes.
pub(crate) fn part(buffer: &Buffer, offset: usize, size: usize) -> BindingResource<'_> {
    BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: offset as u64, size: NonZeroU64::new(size as u64) })
}
