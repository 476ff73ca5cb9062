//! The host's copy of a tile: textures, rays and hits, and the layers that it computes from them.

use wgpu::{Buffer, CommandEncoder, Device, Texture, TextureFormat, TextureView};

use crate::accel::PlannedBuffer;
use crate::camera::View;
use crate::camera::film::Film;
use crate::gpu::error::GpuError;
use crate::gpu::passes::frame::Frame;
use crate::gpu::passes::targets::{DataTargets, Targets};
use crate::gpu::passes::tiles::Tile;
use crate::gpu::resources::{buffer, extent, texture};
use crate::gpu::shader::formats::{ColorTarget, DEPTH_FORMAT, ID_FORMAT, NORMAL_FORMAT};
use crate::gpu::shader::records::{self, NO_HIT};
use crate::image::color::LinearRgb;
use crate::image::{Image, NO_ID, RowMut, put};
use crate::recording::{TracedPixel, TracedRay};
use crate::scene::SceneAppearance;

/// A texture that kernels write, with a buffer through which the host reads it.
#[derive(Debug)]
pub(crate) struct ReadableTexture {
    texture: Texture,
    view: TextureView,
    back: ReadableBuffer,
}

impl ReadableTexture {
    pub(crate) fn new(device: &Device, label: &'static str, format: TextureFormat, size: [u32; 2]) -> Self {
        let usage = wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let texture = texture(device, label, format, size, usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let back = ReadableBuffer::new(device, label, Self::buffer_bytes(format, size));
        Self { texture, view, back }
    }

    /// Size of the texture in bytes.
    pub(crate) fn texture_bytes(format: TextureFormat, [width, height]: [u32; 2]) -> u64 {
        u64::from(width) * u64::from(height) * u64::from(bytes_per_pixel(format))
    }

    /// Size of the buffer in bytes.
    pub(crate) fn buffer_bytes(format: TextureFormat, [width, height]: [u32; 2]) -> u64 {
        u64::from(padded_row(width, bytes_per_pixel(format))) * u64::from(height)
    }

    /// Records a copy of the upper left part of the texture to the buffer.
    pub(crate) fn record_copy(&self, encoder: &mut wgpu::CommandEncoder, size: [u32; 2]) {
        encoder.copy_texture_to_buffer(
            self.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.back.buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row(size[0], bytes_per_pixel(self.texture.format()))),
                    rows_per_image: None,
                },
            },
            extent(size),
        );
    }

    /// Calls `row` with every row of the part that was copied, then unmaps the buffer, which must be mapped.
    pub(crate) fn read_rows<T: bytemuck::AnyBitPattern>(
        &self,
        [width, height]: [u32; 2],
        mut row: impl FnMut(usize, &[T]),
    ) -> Result<(), GpuError> {
        let of_pixel = bytes_per_pixel(self.texture.format());
        let (padded, used) = (padded_row(width, of_pixel) as usize, (width * of_pixel) as usize);
        self.back.read(|bytes: &[u8]| {
            for (j, bytes) in bytes.chunks(padded).take(height as usize).enumerate() {
                row(j, bytemuck::cast_slice(&bytes[..used]));
            }
        })
    }
}

/// A buffer through which the host reads a buffer that kernels write.
#[derive(Debug)]
pub(crate) struct ReadableBuffer {
    pub(crate) buffer: Buffer,
}

impl ReadableBuffer {
    pub(crate) fn new(device: &Device, label: &'static str, size: u64) -> Self {
        Self { buffer: buffer(device, label, size, wgpu::BufferUsages::MAP_READ) }
    }

    /// Records a copy of a buffer of the same size, or of the start of a larger one, to this buffer.
    pub(crate) fn record_copy(&self, encoder: &mut wgpu::CommandEncoder, written: &Buffer) {
        encoder.copy_buffer_to_buffer(written, 0, &self.buffer, 0, self.buffer.size());
    }

    /// Returns the result of `read` for the elements, and unmaps the buffer, which must be mapped.
    pub(crate) fn read<T: bytemuck::AnyBitPattern, R>(&self, read: impl FnOnce(&[T]) -> R) -> Result<R, GpuError> {
        let bytes =
            self.buffer.get_mapped_range(..).map_err(|error| GpuError::Device { message: error.to_string() })?;
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

/// The inputs of derived layers besides the pixels of a tile.
pub(crate) struct DerivedLayers<'a> {
    pub(crate) view: View<'a>,
    pub(crate) appearance: &'a SceneAppearance,
}

impl DerivedLayers<'_> {
    /// The point in world space at a distance along the ray of a pixel.
    fn point(&self, [i, j]: [usize; 2], t: f32) -> [f32; 3] {
        let location = self.view.film.relative_location(i as f64 + 0.5, j as f64 + 0.5);
        self.view.camera.ray_in_world(location).at(f64::from(t)).as_vec3().to_array()
    }

    fn albedo(&self, id: u32) -> [f32; 3] {
        let color = if id == NO_ID { None } else { self.appearance.color(id) };
        color.map_or([0.0; 3], LinearRgb::to_array)
    }
}

/// The label of a texture of a tile, its format, and the names of the texture and of its read-back buffer in plans.
type TileTexture = (&'static str, TextureFormat, [&'static str; 2]);

const COLOR: TileTexture =
    ("pinhole color", ColorTarget::Linear32.texture_format(), ["color texture", "color read-back"]);
/// Depth, normal and id.
const DATA: [TileTexture; 3] = [
    ("pinhole depth", DEPTH_FORMAT, ["depth texture", "depth read-back"]),
    ("pinhole normal", NORMAL_FORMAT, ["normal texture", "normal read-back"]),
    ("pinhole id", ID_FORMAT, ["id texture", "id read-back"]),
];

/// Sizes of the textures of a tile and of the buffers that they are copied to.
pub(crate) fn planned(size: [u32; 2], data_layers: bool) -> Vec<PlannedBuffer> {
    let textures = std::iter::once(COLOR).chain(DATA.into_iter().filter(|_| data_layers));
    let planned = textures.map(|(_, format, [texture, read_back])| {
        [
            PlannedBuffer::one(texture, ReadableTexture::texture_bytes(format, size)),
            PlannedBuffer::one(read_back, ReadableTexture::buffer_bytes(format, size)),
        ]
    });
    planned.flatten().collect()
}

/// The textures of a tile, with the buffers through which the host reads them.
#[derive(Debug)]
pub(crate) struct TileTextures {
    color: ReadableTexture,
    /// Depth, normal and id.
    data: Option<[ReadableTexture; 3]>,
    /// The buffer through which the host reads the status word of the kernels.
    pub(crate) status: ReadableBuffer,
}

impl TileTextures {
    pub(crate) fn new(device: &Device, size: [u32; 2], data_layers: bool) -> Self {
        let create = |(label, format, _): TileTexture| ReadableTexture::new(device, label, format, size);
        let status = size_of::<records::Status>() as u64;
        Self {
            color: create(COLOR),
            data: data_layers.then(|| DATA.map(create)),
            status: ReadableBuffer::new(device, "pinhole status", status),
        }
    }

    pub(crate) fn targets(&self) -> Targets<'_> {
        let data = self.data.as_ref().map(|data| data.each_ref().map(|texture| &texture.view));
        let data = data.map(|[depth, normal, id]| DataTargets { depth, normal, id });
        Targets { color: &self.color.view, data }
    }

    /// Records the copies of the part of a tile, and of the status word of its frame, to the buffers through which the
    /// host reads them. Returns these buffers, which must be mapped for [`TileTextures::read_into`].
    pub(crate) fn record_read_back(&self, encoder: &mut CommandEncoder, frame: &Frame, size: [u32; 2]) -> Vec<&Buffer> {
        for texture in self.all() {
            texture.record_copy(encoder, size);
        }
        self.status.record_copy(encoder, frame.status());
        self.all().map(|texture| &texture.back.buffer).chain([&self.status.buffer]).collect()
    }

    fn all(&self) -> impl Iterator<Item = &ReadableTexture> {
        std::iter::once(&self.color).chain(self.data.iter().flatten())
    }

    /// Returns an error if rays took too many steps, according to the mapped status word.
    pub(crate) fn check_steps(&self) -> Result<(), GpuError> {
        match self.status.read(|words: &[u32]| words[0])? {
            0 => Ok(()),
            _ => Err(GpuError::Steps),
        }
    }

    /// Copies the contents of the mapped buffers, and the layers that are derived from them, to the tile's part of the
    /// image, and unmaps the buffers. Nothing is copied if rays took too many steps.
    pub(crate) fn read_into(&self, image: &mut Image, tile: Tile, derived: &DerivedLayers<'_>) -> Result<(), GpuError> {
        self.check_steps()?;
        let [x, y] = tile.origin.map(|start| start as usize);
        let [width, height] = tile.size.map(|side| side as usize);
        let columns = x..x + width;
        let mut rows = image.rows_mut(y..y + height);
        self.color.read_rows(tile.size, |j, rgba: &[[f32; 4]]| {
            for (pixel, [r, g, b, _]) in rows[j].color[columns.clone()].iter_mut().zip(rgba) {
                *pixel = [*r, *g, *b];
            }
        })?;
        let Some([depth, normal, id]) = &self.data else {
            return Ok(());
        };
        depth.read_rows(tile.size, |j, depths: &[f32]| {
            let row = &mut rows[j];
            for (i, t) in columns.clone().zip(depths) {
                let is_miss = *t >= NO_HIT;
                put(&mut row.depth, i, if is_miss { f32::INFINITY } else { *t });
                if row.position.is_some() {
                    let point = if is_miss { [0.0; 3] } else { derived.point([i, y + j], *t) };
                    put(&mut row.position, i, point);
                }
            }
        })?;
        normal.read_rows(tile.size, |j, normals: &[[f32; 4]]| {
            for (i, [x, y, z, _]) in columns.clone().zip(normals) {
                put(&mut rows[j].normal, i, [*x, *y, *z]);
            }
        })?;
        id.read_rows(tile.size, |j, ids: &[u32]| {
            let row = &mut rows[j];
            for (i, id) in columns.clone().zip(ids) {
                put(&mut row.id, i, *id);
                put(&mut row.alpha, i, RowMut::coverage(*id));
                if row.albedo.is_some() {
                    put(&mut row.albedo, i, derived.albedo(*id));
                }
                // Pixels have a single ray each.
                put(&mut row.samples, i, 1);
                put(&mut row.variance, i, 0.0);
            }
        })
    }
}

/// Buffers from which the host reads the rays and hits of a tile.
#[derive(Debug)]
pub(crate) struct ReadableTrace {
    hits: ReadableBuffer,
    rays: ReadableBuffer,
}

impl ReadableTrace {
    /// Creates the buffers, or returns `None` if the frame keeps no rays.
    pub(crate) fn new(device: &Device, frame: &Frame) -> Option<Self> {
        let (hits, rays) = frame.traced();
        Some(Self {
            hits: ReadableBuffer::new(device, "pinhole hits read-back", hits.size()),
            rays: ReadableBuffer::new(device, "pinhole rays read-back", rays?.size()),
        })
    }

    pub(crate) fn buffers(&self) -> [&Buffer; 2] {
        [&self.hits.buffer, &self.rays.buffer]
    }

    pub(crate) fn record_copy(&self, encoder: &mut wgpu::CommandEncoder, frame: &Frame) {
        let (hits, rays) = frame.traced();
        self.hits.record_copy(encoder, hits);
        if let Some(rays) = rays {
            self.rays.record_copy(encoder, rays);
        }
    }

    /// Copies the contents of the mapped buffers to the pixels of the tile, and unmaps the buffers.
    pub(crate) fn read_into(&self, pixels: &mut [TracedPixel], film: &Film, tile: Tile) -> Result<(), GpuError> {
        let [x, y] = tile.origin.map(|start| start as usize);
        let [width, height] = tile.size.map(|side| side as usize);
        let mut rows: Vec<&mut [TracedPixel]> =
            pixels.chunks_mut(film.width() as usize).skip(y).take(height).map(|row| &mut row[x..x + width]).collect();
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
