//! The record of a host's camera, from which kernels compute the host's depth.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::camera::{Camera, CameraKind, DepthOrder, HostCamera};

/// Uniform record. Twin: `HostView` in `shaders/host/host_view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct HostView {
    pub(crate) column: [f32; 3],
    pub(crate) is_parallel: f32,
    pub(crate) row: [f32; 3],
    pub(crate) slope: f32,
    pub(crate) forward: [f32; 3],
    pub(crate) far: f32,
    pub(crate) film_depth: [f32; 3],
    pub(crate) zero: f32,
    pub(crate) size: [f32; 2],
    pub(crate) first_pixel: [f32; 2],
}

impl HostView {
    pub(crate) fn new(camera: &HostCamera, size: [u32; 2], first_pixel: [u32; 2]) -> Self {
        let narrow = |v: DVec3| v.as_vec3().to_array();
        let (vectors, depth) = (camera.vectors(), camera.depth());
        // Half a pixel is 1/size of the way from the middle of the film to its edge, and y is up.
        let [columns, rows] = size.map(f64::from);
        Self {
            column: narrow(vectors.right / columns),
            is_parallel: f32::from(u8::from(camera.kind() == CameraKind::Orthographic)),
            row: narrow(vectors.up / -rows),
            slope: depth.slope as f32,
            forward: narrow(vectors.forward),
            far: match camera.depth_order() {
                DepthOrder::NearIsZero => 1.0,
                DepthOrder::NearIsOne => 0.0,
            },
            film_depth: narrow(depth.film / DVec3::new(columns, -rows, 1.0)),
            zero: 0.0,
            // Textures are so small that these numbers are exact.
            size: size.map(|n| n as f32),
            first_pixel: first_pixel.map(|n| n as f32),
        }
    }

    /// The place of a picture in a pass without depth.
    pub(crate) fn without_camera(size: [u32; 2], first_pixel: [u32; 2]) -> Self {
        let [size, first_pixel] = [size, first_pixel].map(|of| of.map(|n| n as f32));
        Self { size, first_pixel, ..Self::zeroed() }
    }

    /// A buffer that contains a record.
    pub(crate) fn buffer(device: &wgpu::Device, record: &Self) -> wgpu::Buffer {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pinhole host view"),
            size: size_of::<Self>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: true,
        });
        // If this fails, the device reports it in the caller's error scope.
        if let Ok(mut bytes) = buffer.get_mapped_range_mut(..) {
            bytes.copy_from_slice(bytemuck::bytes_of(record));
        }
        buffer.unmap();
        buffer
    }
}
