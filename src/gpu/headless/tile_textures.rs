//! The textures of one tile of a headless render.

use wgpu::{Buffer, CommandEncoder, Device, TextureFormat};

use crate::accel::PlannedBuffer;
use crate::gpu::error::GpuError;
use crate::gpu::headless::derived::Derived;
use crate::gpu::headless::readback::{ReadableBuffer, ReadableTexture};
use crate::gpu::passes::frame::Frame;
use crate::gpu::passes::targets::{DataTargets, Targets};
use crate::gpu::passes::tiles::Tile;
use crate::gpu::shader::formats::{ColorTarget, DEPTH_FORMAT, ID_FORMAT, NORMAL_FORMAT};
use crate::gpu::shader::records::{self, NO_HIT};
use crate::image::Image;

/// Description of a texture of a tile and of the buffer that it is copied to.
struct TileTexture {
    label: &'static str,
    /// Name of the texture in plans.
    texture: &'static str,
    /// Name of the buffer in plans.
    read_back: &'static str,
    format: TextureFormat,
}

const COLOR: TileTexture = TileTexture {
    label: "pinhole color",
    texture: "color texture",
    read_back: "color read-back",
    format: ColorTarget::Linear32.texture_format(),
};
const DEPTH: TileTexture = TileTexture {
    label: "pinhole depth",
    texture: "depth texture",
    read_back: "depth read-back",
    format: DEPTH_FORMAT,
};
const NORMAL: TileTexture = TileTexture {
    label: "pinhole normal",
    texture: "normal texture",
    read_back: "normal read-back",
    format: NORMAL_FORMAT,
};
const ID: TileTexture = TileTexture {
    label: "pinhole id",
    texture: "id texture",
    read_back: "id read-back",
    format: ID_FORMAT,
};

impl TileTexture {
    fn planned(&self, size: [u32; 2]) -> [PlannedBuffer; 2] {
        [
            PlannedBuffer::one(self.texture, ReadableTexture::texture_bytes(self.format, size)),
            PlannedBuffer::one(self.read_back, ReadableTexture::buffer_bytes(self.format, size)),
        ]
    }

    fn create(&self, device: &Device, size: [u32; 2]) -> ReadableTexture {
        ReadableTexture::new(device, self.label, self.format, size)
    }
}

/// Sizes of the textures of a tile and of the buffers that they are copied to.
pub(in crate::gpu) fn planned(size: [u32; 2], data_layers: bool) -> Vec<PlannedBuffer> {
    let data = [DEPTH, NORMAL, ID].into_iter().filter(|_| data_layers);
    std::iter::once(COLOR).chain(data).flat_map(|texture| texture.planned(size)).collect()
}

/// The textures of a tile, with the buffers through which the host reads them.
#[derive(Debug)]
pub(in crate::gpu) struct TileTextures {
    color: ReadableTexture,
    data: Option<DataTextures>,
    status: ReadableBuffer,
}

#[derive(Debug)]
struct DataTextures {
    depth: ReadableTexture,
    normal: ReadableTexture,
    id: ReadableTexture,
}

impl TileTextures {
    pub(in crate::gpu) fn new(device: &Device, size: [u32; 2], data_layers: bool) -> Self {
        Self {
            color: COLOR.create(device, size),
            data: data_layers.then(|| DataTextures {
                depth: DEPTH.create(device, size),
                normal: NORMAL.create(device, size),
                id: ID.create(device, size),
            }),
            status: ReadableBuffer::new(
                device,
                "pinhole status",
                size_of::<records::Status>() as u64,
            ),
        }
    }

    pub(in crate::gpu) fn targets(&self) -> Targets<'_> {
        Targets {
            color: self.color.view(),
            data: self.data.as_ref().map(|data| DataTargets {
                depth: data.depth.view(),
                normal: data.normal.view(),
                id: data.id.view(),
            }),
        }
    }

    /// Buffer through which the host reads the status word of the kernels.
    pub(in crate::gpu) fn status(&self) -> &ReadableBuffer {
        &self.status
    }

    /// Records the copies of the part of a tile, and of the status word of its frame, to the buffers through which the
    /// host reads them. Returns these buffers, which must be mapped for [`TileTextures::read_into`].
    pub(in crate::gpu) fn record_read_back(
        &self,
        encoder: &mut CommandEncoder,
        frame: &Frame,
        size: [u32; 2],
    ) -> Vec<&Buffer> {
        for texture in self.all() {
            texture.record_copy(encoder, size);
        }
        self.status.record_copy(encoder, frame.status());
        self.all().map(ReadableTexture::buffer).chain([self.status.buffer()]).collect()
    }

    fn all(&self) -> impl Iterator<Item = &ReadableTexture> {
        let data = self.data.as_ref().map(|data| [&data.depth, &data.normal, &data.id]);
        std::iter::once(&self.color).chain(data.into_iter().flatten())
    }

    /// Returns an error if rays took too many steps, according to the mapped status word.
    pub(in crate::gpu) fn check_steps(&self) -> Result<(), GpuError> {
        match self.status.read(|words: &[u32]| words[0])? {
            0 => Ok(()),
            _ => Err(GpuError::Steps),
        }
    }

    /// Copies the contents of the mapped buffers, and the layers that are derived from them, to the tile's part of the
    /// image, and unmaps the buffers. Nothing is copied if rays took too many steps.
    pub(in crate::gpu) fn read_into(
        &self,
        image: &mut Image,
        tile: Tile,
        derived: &Derived<'_>,
    ) -> Result<(), GpuError> {
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
        let Some(data) = &self.data else {
            return Ok(());
        };
        data.depth.read_rows(tile.size, |j, depths: &[f32]| {
            derived.set_by_depths(&mut rows[j], columns.clone(), y + j, depths);
            let Some(row) = &mut rows[j].depth else {
                return;
            };
            for (pixel, t) in row[columns.clone()].iter_mut().zip(depths) {
                *pixel = if *t >= NO_HIT { f32::INFINITY } else { *t };
            }
        })?;
        data.normal.read_rows(tile.size, |j, normals: &[[f32; 4]]| {
            let Some(row) = &mut rows[j].normal else {
                return;
            };
            for (pixel, [x, y, z, _]) in row[columns.clone()].iter_mut().zip(normals) {
                *pixel = [*x, *y, *z];
            }
        })?;
        data.id.read_rows(tile.size, |j, ids: &[u32]| {
            derived.set_by_ids(&mut rows[j], columns.clone(), ids);
            let Some(row) = &mut rows[j].id else { return };
            row[columns.clone()].copy_from_slice(ids);
        })
    }
}
