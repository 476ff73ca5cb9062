//! Reading the rays and hits of a tile back to the host.

use wgpu::{Buffer, Device};

use crate::camera::film::Film;
use crate::gpu::error::GpuError;
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::passes::frame::Frame;
use crate::gpu::passes::tiles::Tile;
use crate::gpu::shader::records;
use crate::verify::{TracedPixel, TracedRay};

/// Buffers from which the host reads the rays and hits of a tile.
#[derive(Debug)]
pub(in crate::gpu) struct ReadableTrace {
    hits: ReadableBuffer,
    rays: ReadableBuffer,
}

impl ReadableTrace {
    /// Creates the buffers, or returns `None` if the frame keeps no rays.
    pub(in crate::gpu) fn new(device: &Device, frame: &Frame) -> Option<Self> {
        let (hits, rays) = frame.traced();
        Some(Self {
            hits: ReadableBuffer::new(device, "pinhole hits read-back", hits.size()),
            rays: ReadableBuffer::new(device, "pinhole rays read-back", rays?.size()),
        })
    }

    pub(in crate::gpu) fn buffers(&self) -> [&Buffer; 2] {
        [&self.hits.buffer, &self.rays.buffer]
    }

    pub(in crate::gpu) fn record_copy(&self, encoder: &mut wgpu::CommandEncoder, frame: &Frame) {
        let (hits, rays) = frame.traced();
        self.hits.record_copy(encoder, hits);
        if let Some(rays) = rays {
            self.rays.record_copy(encoder, rays);
        }
    }

    /// Copies the contents of the mapped buffers to the pixels of the tile, and unmaps the buffers.
    pub(in crate::gpu) fn read_into(
        &self,
        pixels: &mut [TracedPixel],
        film: &Film,
        tile: Tile,
    ) -> Result<(), GpuError> {
        let [x, y] = tile.origin.map(|start| start as usize);
        let [width, height] = tile.size.map(|side| side as usize);
        let mut rows: Vec<&mut [TracedPixel]> = pixels
            .chunks_mut(film.width() as usize)
            .skip(y)
            .take(height)
            .map(|row| &mut row[x..x + width])
            .collect();
        self.rays.read(|rays: &[records::RecordedRays]| {
            for (row, rays) in rows.iter_mut().zip(rays.chunks(width)) {
                for (pixel, rays) in row.iter_mut().zip(rays) {
                    let [traced, shaded] = [0, 1].map(|which| recorded_ray(&rays[8 * which..]));
                    (pixel.ray, pixel.shading_ray) = (traced, shaded);
                }
            }
        })?;
        self.hits.read(|hits: &[records::Hit]| {
            for (row, hits) in rows.iter_mut().zip(hits.chunks(width)) {
                for (pixel, [t, id, ..]) in row.iter_mut().zip(hits) {
                    if pixel.ray.is_some() {
                        (pixel.t, pixel.id) = (f32::from_bits(*t), *id);
                    }
                }
            }
        })
    }
}

/// A ray of a pixel; `None` if it was not made and its memory is still cleared.
fn recorded_ray(ray: &[f32]) -> Option<TracedRay> {
    let &[ox, oy, oz, distance, dx, dy, dz, is_made, ..] = ray else { return None };
    let (origin, direction) = ([ox, oy, oz], [dx, dy, dz]);
    (is_made != 0.0).then_some(TracedRay { origin, direction, distance })
}
