//! Parts that the host programs among the examples share: textures, spheres, and a way to see a texture.
#![allow(dead_code, reason = "not every example uses all of it")]

use std::error::Error;

use pinhole::gpu::wgpu;
use pinhole::{LinearRgb, Sphere};

/// A helix of spheres around the y axis.
pub(crate) fn helix() -> Vec<Sphere> {
    let sphere = |i: u8| {
        let angle = f64::from(i) * 0.4;
        let color = LinearRgb::from_srgb8([255 - 3 * i, 120, 60 + 3 * i]);
        let height = f64::from(i) * 0.1 - 3.0;
        Sphere::new([2.0 * angle.cos(), height, 2.0 * angle.sin()], 0.4, color)
    };
    (0..60).map(sphere).collect()
}

pub(crate) fn texture(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the host's texture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Waits for the device, and writes a texture of four bytes for each pixel to a file.
pub(crate) fn save(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
    path: &str,
) -> Result<(), Box<dyn Error>> {
    let (width, height) = (texture.width(), texture.height());
    // WebGPU aligns rows to 256 bytes.
    let row = (4 * width).next_multiple_of(256);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read-back"),
        size: u64::from(row * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        texture.size(),
    );
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let bytes = buffer.get_mapped_range(..)?;
    let rows = bytes.chunks(row as usize).flat_map(|bytes| &bytes[..4 * width as usize]);
    let pixels: Vec<u8> = rows.copied().collect();
    image::save_buffer(path, &pixels, width, height, image::ExtendedColorType::Rgba8)?;
    Ok(())
}
