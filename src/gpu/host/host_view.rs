//! The record of a host's camera, from which kernels compute the host's depth.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::camera::{Camera, CameraKind, DepthOrder, HostCamera};

/// Uniform record. Twin: `HostView` in `shaders/host/clip_depth.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(in crate::gpu) struct HostView {
    pub(in crate::gpu) right: [f32; 3],
    pub(in crate::gpu) is_parallel: u32,
    pub(in crate::gpu) up: [f32; 3],
    pub(in crate::gpu) slope: f32,
    pub(in crate::gpu) forward: [f32; 3],
    pub(in crate::gpu) far: f32,
    pub(in crate::gpu) film_depth: [f32; 3],
    pub(in crate::gpu) zero: u32,
    pub(in crate::gpu) size: [u32; 2],
    pub(in crate::gpu) first_pixel: [u32; 2],
}

impl HostView {
    pub(in crate::gpu) fn new(camera: &HostCamera, size: [u32; 2], first_pixel: [u32; 2]) -> Self {
        let narrow = |v: DVec3| v.as_vec3().to_array();
        let (vectors, depth) = (camera.vectors(), camera.depth());
        Self {
            right: narrow(vectors.right),
            is_parallel: u32::from(camera.kind() == CameraKind::Orthographic),
            up: narrow(vectors.up),
            slope: depth.slope as f32,
            forward: narrow(vectors.forward),
            far: match camera.depth_order() {
                DepthOrder::NearIsZero => 1.0,
                DepthOrder::NearIsOne => 0.0,
            },
            film_depth: narrow(depth.film),
            zero: 0,
            size,
            first_pixel,
        }
    }

    /// The place of a picture in a pass without depth.
    pub(in crate::gpu) fn without_camera(size: [u32; 2], first_pixel: [u32; 2]) -> Self {
        Self { size, first_pixel, ..Self::zeroed() }
    }

    /// A buffer that contains a record.
    pub(in crate::gpu) fn buffer(device: &wgpu::Device, record: &Self) -> wgpu::Buffer {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pinhole host view"),
            size: size_of::<Self>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: true,
        });
        // The device reports what goes wrong here in the caller's error scope.
        if let Ok(mut bytes) = buffer.get_mapped_range_mut(..) {
            bytes.copy_from_slice(bytemuck::bytes_of(record));
        }
        buffer.unmap();
        buffer
    }
}
