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
pub(in crate::gpu) fn planned(size: [u32; 2], data_layers: bool) -> Vec<PlannedBuffer> {
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
pub(in crate::gpu) struct TileTextures {
    color: ReadableTexture,
    /// Depth, normal and id.
    data: Option<[ReadableTexture; 3]>,
    /// Through which the host reads the status word of the kernels.
    pub(in crate::gpu) status: ReadableBuffer,
}

impl TileTextures {
    pub(in crate::gpu) fn new(device: &Device, size: [u32; 2], data_layers: bool) -> Self {
        let create =
            |(label, format, _): TileTexture| ReadableTexture::new(device, label, format, size);
        let status = size_of::<records::Status>() as u64;
        Self {
            color: create(COLOR),
            data: data_layers.then(|| DATA.map(create)),
            status: ReadableBuffer::new(device, "pinhole status", status),
        }
    }

    pub(in crate::gpu) fn targets(&self) -> Targets<'_> {
        let data = self.data.as_ref().map(|data| data.each_ref().map(|texture| &texture.view));
        let data = data.map(|[depth, normal, id]| DataTargets { depth, normal, id });
        Targets { color: &self.color.view, data }
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
        self.all().map(|texture| &texture.buffer).chain([&self.status.buffer]).collect()
    }

    fn all(&self) -> impl Iterator<Item = &ReadableTexture> {
        std::iter::once(&self.color).chain(self.data.iter().flatten())
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
        let Some([depth, normal, id]) = &self.data else {
            return Ok(());
        };
        depth.read_rows(tile.size, |j, depths: &[f32]| {
            derived.set_by_depths(&mut rows[j], columns.clone(), y + j, depths);
            let Some(row) = &mut rows[j].depth else {
                return;
            };
            for (pixel, t) in row[columns.clone()].iter_mut().zip(depths) {
                *pixel = if *t >= NO_HIT { f32::INFINITY } else { *t };
            }
        })?;
        normal.read_rows(tile.size, |j, normals: &[[f32; 4]]| {
            let Some(row) = &mut rows[j].normal else {
                return;
            };
            for (pixel, [x, y, z, _]) in row[columns.clone()].iter_mut().zip(normals) {
                *pixel = [*x, *y, *z];
            }
        })?;
        id.read_rows(tile.size, |j, ids: &[u32]| {
            derived.set_by_ids(&mut rows[j], columns.clone(), ids);
            let Some(row) = &mut rows[j].id else { return };
            row[columns.clone()].copy_from_slice(ids);
        })
    }
}
