//! The host's copy of a tile: textures, rays and hits, and the layers that it computes from them.

use wgpu::{Buffer, CommandEncoder, Device, Texture, TextureFormat, TextureView};

use crate::accel::PlannedBuffer;
use crate::camera::View;
use crate::camera::film::Film;
use crate::gpu::error::GpuError;
use crate::gpu::passes::frame::Frame;
use crate::gpu::passes::targets::{DataTargets, Targets};
use crate::gpu::passes::tiles::{Groups, Tile};
use crate::gpu::resources::{buffer, extent, texture};
use crate::gpu::shader::formats::{ColorTarget, DEPTH_FORMAT, ID_FORMAT, NORMAL_FORMAT};
use crate::gpu::shader::records::{self, NO_HIT};
use crate::image::color::LinearRgb;
use crate::image::{Image, LayerSet, NO_ID, RowMut, put};
use crate::parallel;
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

    /// Sets the depth of a pixel, and what follows from it.
    fn set_depth(&self, row: &mut RowMut<'_>, pixel: [usize; 2], t: f32) {
        let is_miss = t >= NO_HIT;
        put(&mut row.depth, pixel[0], if is_miss { f32::INFINITY } else { t });
        if row.position.is_some() {
            let point = if is_miss { [0.0; 3] } else { self.point(pixel, t) };
            put(&mut row.position, pixel[0], point);
        }
    }

    /// Sets the id of a pixel, and what follows from it.
    fn set_id(&self, row: &mut RowMut<'_>, i: usize, id: u32) {
        put(&mut row.id, i, id);
        put(&mut row.alpha, i, RowMut::coverage(id));
        if row.albedo.is_some() {
            let color = if id == NO_ID { None } else { self.appearance.color(id) };
            put(&mut row.albedo, i, color.map_or([0.0; 3], LinearRgb::to_array));
        }
        // Pixels have a single ray each.
        put(&mut row.samples, i, 1);
        put(&mut row.variance, i, 0.0);
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

/// The data that the host reads of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ReadBack {
    /// The hits, which are not shaded: there are no colours and no normals.
    Hits,
    Color,
    Layers,
}

impl ReadBack {
    pub(crate) fn new(layers: LayerSet, is_shaded: bool) -> Self {
        match (is_shaded, layers == LayerSet::COLOR) {
            (false, _) => Self::Hits,
            (true, true) => Self::Color,
            (true, false) => Self::Layers,
        }
    }

    /// True if kernels write textures of data layers.
    pub(crate) fn has_data(self) -> bool {
        self == Self::Layers
    }
}

/// Sizes of the textures of a tile and of the buffers that they are copied to.
pub(crate) fn planned(size: [u32; 2], what: ReadBack) -> Vec<PlannedBuffer> {
    if what == ReadBack::Hits {
        return vec![PlannedBuffer::one("hits read-back", hit_bytes(size))];
    }
    let textures = std::iter::once(COLOR).chain(DATA.into_iter().filter(|_| what.has_data()));
    let planned = textures.map(|(_, format, [texture, read_back])| {
        [
            PlannedBuffer::one(texture, ReadableTexture::texture_bytes(format, size)),
            PlannedBuffer::one(read_back, ReadableTexture::buffer_bytes(format, size)),
        ]
    });
    planned.flatten().collect()
}

/// Size of the hits of a tile in bytes.
fn hit_bytes([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height) * size_of::<records::Hit>() as u64
}

/// The textures of a tile, with the buffers through which the host reads them.
#[derive(Debug)]
pub(crate) struct TileTextures {
    color: ReadableTexture,
    /// The hits, if they are read instead of textures.
    hits: Option<ReadableBuffer>,
    /// Depth, normal and id.
    data: Option<[ReadableTexture; 3]>,
    /// The buffer through which the host reads the status word of the kernels.
    pub(crate) status: ReadableBuffer,
}

impl TileTextures {
    pub(crate) fn new(device: &Device, size: [u32; 2], what: ReadBack) -> Self {
        let create = |(label, format, _): TileTexture| ReadableTexture::new(device, label, format, size);
        let status = size_of::<records::Status>() as u64;
        Self {
            color: create(COLOR),
            hits: (what == ReadBack::Hits)
                .then(|| ReadableBuffer::new(device, "pinhole hits read-back", hit_bytes(size))),
            data: what.has_data().then(|| DATA.map(create)),
            status: ReadableBuffer::new(device, "pinhole status", status),
        }
    }

    pub(crate) fn targets(&self) -> Targets<'_> {
        let data = self.data.as_ref().map(|data| data.each_ref().map(|texture| &texture.view));
        let data = data.map(|[depth, normal, id]| DataTargets { depth, normal, id });
        Targets { color: &self.color.view, data }
    }

    /// True if the hits of a tile are shaded before they are read.
    pub(crate) fn are_shaded(&self) -> bool {
        self.hits.is_none()
    }

    /// Records the copies of the part of a tile, and of the status word of its frame, to the buffers through which the
    /// host reads them. Returns these buffers, which must be mapped for [`TileTextures::read_into`].
    pub(crate) fn record_read_back(&self, encoder: &mut CommandEncoder, frame: &Frame, size: [u32; 2]) -> Vec<&Buffer> {
        self.status.record_copy(encoder, frame.status());
        if let Some(hits) = &self.hits {
            hits.record_copy(encoder, frame.traced().0);
            return vec![&hits.buffer, &self.status.buffer];
        }
        let all = || std::iter::once(&self.color).chain(self.data.iter().flatten());
        all().for_each(|texture| texture.record_copy(encoder, size));
        all().map(|texture| &texture.back.buffer).chain([&self.status.buffer]).collect()
    }

    /// Returns an error if rays took too many steps, according to the mapped status word.
    pub(crate) fn check_steps(&self) -> Result<(), GpuError> {
        match self.status.read(|words: &[u32]| words[0])? {
            0 => Ok(()),
            _ => Err(GpuError::Steps),
        }
    }

    /// Copies the contents of the mapped buffers, and the layers that are derived from them, to the tile's part of the
    /// image, and unmaps the buffers. Nothing is copied if rays took too many steps. Hits are those of `traced` workgroups.
    pub(crate) fn read_into(
        &self,
        image: &mut Image,
        tile: Tile,
        traced: Groups,
        derived: &DerivedLayers<'_>,
    ) -> Result<(), GpuError> {
        self.check_steps()?;
        let [x, y] = tile.origin.map(|start| start as usize);
        let [width, height] = tile.size.map(|side| side as usize);
        let columns = x..x + width;
        let mut rows = image.rows_mut(y..y + height);
        if let Some(hits) = &self.hits {
            return hits.read(|hits: &[records::Hit]| {
                let [traced_columns, traced_rows] = traced.pixels_in(tile.size);
                let with_hits = rows.iter_mut().zip(hits.chunks(width)).enumerate();
                let traced = with_hits.filter(|(j, _)| traced_rows.contains(j)).collect();
                parallel::for_each(traced, |(j, (row, hits)): (usize, (&mut RowMut<'_>, &[records::Hit]))| {
                    for i in traced_columns.clone() {
                        let [along, id, _, before] = hits[i];
                        let t = if id == NO_ID { NO_HIT } else { f32::from_bits(before) + f32::from_bits(along) };
                        derived.set_depth(row, [x + i, y + j], t);
                        derived.set_id(row, x + i, id);
                    }
                });
            });
        }
        self.color.read_rows(tile.size, |j, rgba: &[[f32; 4]]| {
            for (pixel, [r, g, b, _]) in rows[j].color[columns.clone()].iter_mut().zip(rgba) {
                *pixel = [*r, *g, *b];
            }
        })?;
        let Some([depth, normal, id]) = &self.data else {
            return Ok(());
        };
        depth.read_rows(tile.size, |j, depths: &[f32]| {
            for (i, t) in columns.clone().zip(depths) {
                derived.set_depth(&mut rows[j], [i, y + j], *t);
            }
        })?;
        normal.read_rows(tile.size, |j, normals: &[[f32; 4]]| {
            for (i, [x, y, z, _]) in columns.clone().zip(normals) {
                put(&mut rows[j].normal, i, [*x, *y, *z]);
            }
        })?;
        id.read_rows(tile.size, |j, ids: &[u32]| {
            for (i, id) in columns.clone().zip(ids) {
                derived.set_id(&mut rows[j], i, *id);
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
