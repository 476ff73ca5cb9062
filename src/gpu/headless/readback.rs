//! Textures and buffers that the host can read.

use wgpu::{Buffer, Device, Texture, TextureFormat, TextureView};

use crate::gpu::error::GpuError;
use crate::gpu::resources::{buffer, extent, texture};

/// A texture that kernels write, with a buffer through which the host reads it.
#[derive(Debug)]
pub(in crate::gpu) struct ReadableTexture {
    texture: Texture,
    pub(in crate::gpu) view: TextureView,
    pub(in crate::gpu) buffer: Buffer,
    bytes_per_pixel: u32,
}

impl ReadableTexture {
    pub(in crate::gpu) fn new(
        device: &Device,
        label: &'static str,
        format: TextureFormat,
        size: [u32; 2],
    ) -> Self {
        let usage = wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let texture = texture(device, label, format, size, usage);
        let bytes_per_pixel = bytes_per_pixel(format);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let ReadableBuffer { buffer } =
            ReadableBuffer::new(device, label, Self::buffer_bytes(format, size));
        Self { texture, view, buffer, bytes_per_pixel }
    }

    /// Size of the texture in bytes.
    pub(in crate::gpu) fn texture_bytes(format: TextureFormat, [width, height]: [u32; 2]) -> u64 {
        u64::from(width) * u64::from(height) * u64::from(bytes_per_pixel(format))
    }

    /// Size of the buffer in bytes.
    pub(in crate::gpu) fn buffer_bytes(format: TextureFormat, [width, height]: [u32; 2]) -> u64 {
        u64::from(padded_row(width, bytes_per_pixel(format))) * u64::from(height)
    }

    /// Records a copy of the upper left part of the texture to the buffer.
    pub(in crate::gpu) fn record_copy(&self, encoder: &mut wgpu::CommandEncoder, size: [u32; 2]) {
        encoder.copy_texture_to_buffer(
            self.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row(size[0], self.bytes_per_pixel)),
                    rows_per_image: None,
                },
            },
            extent(size),
        );
    }

    /// Calls `row` with every row of the part that was copied, then unmaps the buffer, which must be mapped.
    pub(in crate::gpu) fn read_rows<T: bytemuck::AnyBitPattern>(
        &self,
        [width, height]: [u32; 2],
        mut row: impl FnMut(usize, &[T]),
    ) -> Result<(), GpuError> {
        let bytes = self
            .buffer
            .get_mapped_range(..)
            .map_err(|error| GpuError::Device { message: error.to_string() })?;
        let padded = padded_row(width, self.bytes_per_pixel) as usize;
        let used = (width * self.bytes_per_pixel) as usize;
        for (j, bytes) in bytes.chunks(padded).take(height as usize).enumerate() {
            row(j, bytemuck::cast_slice(&bytes[..used]));
        }
        drop(bytes);
        self.buffer.unmap();
        Ok(())
    }
}

/// A buffer through which the host reads a buffer that kernels write.
#[derive(Debug)]
pub(in crate::gpu) struct ReadableBuffer {
    pub(in crate::gpu) buffer: Buffer,
}

impl ReadableBuffer {
    pub(in crate::gpu) fn new(device: &Device, label: &'static str, size: u64) -> Self {
        Self { buffer: buffer(device, label, size, wgpu::BufferUsages::MAP_READ) }
    }

    /// Records a copy of a buffer of the same size, or of the start of a larger one, to this buffer.
    pub(in crate::gpu) fn record_copy(&self, encoder: &mut wgpu::CommandEncoder, written: &Buffer) {
        encoder.copy_buffer_to_buffer(written, 0, &self.buffer, 0, self.buffer.size());
    }

    /// Returns the result of `read` for the elements, and unmaps the buffer, which must be mapped.
    pub(in crate::gpu) fn read<T: bytemuck::AnyBitPattern, R>(
        &self,
        read: impl FnOnce(&[T]) -> R,
    ) -> Result<R, GpuError> {
        let bytes = self
            .buffer
            .get_mapped_range(..)
            .map_err(|error| GpuError::Device { message: error.to_string() })?;
        let result = read(bytemuck::cast_slice(&bytes));
        drop(bytes);
        self.buffer.unmap();
        Ok(result)
    }
}

/// Size of a texel in bytes. Every format in use is a single uncompressed colour plane.
fn bytes_per_pixel(format: TextureFormat) -> u32 {
    format.block_copy_size(None).unwrap_or(0)
}

/// Size of a row of a copy in bytes, which must be a multiple of 256 in WebGPU.
fn padded_row(width: u32, bytes_per_pixel: u32) -> u32 {
    (width * bytes_per_pixel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}
