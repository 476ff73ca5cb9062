//! Creating buffers and bind groups.

use wgpu::{BindGroup, BindGroupLayout, Buffer, BufferUsages, Device, Queue};

/// Creates buffers and bind groups on a device.
#[derive(Clone, Copy)]
pub(in crate::gpu) struct Make<'a> {
    pub(in crate::gpu) device: &'a Device,
    pub(in crate::gpu) queue: &'a Queue,
}

/// A binding and its resource.
pub(in crate::gpu) type Entry<'a> = (u32, wgpu::BindingResource<'a>);

impl Make<'_> {
    pub(in crate::gpu) fn buffer(
        &self,
        label: &'static str,
        bytes: usize,
        usage: BufferUsages,
    ) -> Buffer {
        buffer(self.device, label, bytes as u64, usage)
    }

    pub(in crate::gpu) fn filled(
        &self,
        label: &'static str,
        bytes: &[u8],
        usage: BufferUsages,
    ) -> Buffer {
        let buffer = self.buffer(label, bytes.len(), usage);
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }
}

/// A buffer that can be written.
pub(in crate::gpu) fn buffer(
    device: &Device,
    label: &'static str,
    bytes: u64,
    usage: BufferUsages,
) -> Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes,
        usage: usage | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// A bind group of some resources.
pub(in crate::gpu) fn bind_group(
    device: &Device,
    label: &str,
    layout: &BindGroupLayout,
    entries: &[Entry<'_>],
) -> BindGroup {
    let entries: Vec<_> = entries
        .iter()
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: resource.clone(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}

/// The whole buffer at a binding.
pub(in crate::gpu) fn whole(binding: u32, buffer: &Buffer) -> Entry<'_> {
    (binding, buffer.as_entire_binding())
}
