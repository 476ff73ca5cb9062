//! Buffers of a lit picture: its light, the buffers that all tiles share, and the sums of each tile.

use wgpu::{BindGroup, Buffer, BufferUsages, CommandEncoder, Device, Queue, TextureView};

use crate::gpu::checks::scoped;
use crate::gpu::error::{GpuError, check_storage_size};
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::passes::emitter_table;
use crate::gpu::passes::lit::lighting::LightingData;
use crate::gpu::passes::lit::passes::{LitLayouts, LitPasses};
use crate::gpu::passes::lit::records::{DispatchParameters, GROUPS_NEEDED, LitSizes, QUEUE_HEAD};
use crate::gpu::passes::tiles::Tile;
use crate::gpu::resources::{Entry, Make, bind_group, numbered_group, part, whole};
use crate::gpu::shader::records::FrameParameters;
use crate::light::environment::Environment;

/// Maximum number of dispatches in a submission.
pub(crate) const MAX_DISPATCHES: usize = 1024;

/// The workgroups of a tile that a dispatch covers, and the box to which the origins of its rays are moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Area {
    /// All workgroups of the tile.
    Whole,
    /// The workgroups in which the scene may be visible.
    Visible,
    /// The workgroups of [`Area::Visible`], with the box of the spheres that cast shadows.
    Occluders,
}

/// Records of a tile, indexed by [`Area`].
pub(crate) type Frames = [FrameParameters; 3];

/// The buffers of a lit picture in progress.
#[derive(Debug)]
pub(crate) struct LitFrame {
    pub(crate) sizes: LitSizes,
    parameters: Buffer,
    parameter_stride: usize,
    frame_stride: usize,
    pub(super) queue: Buffer,
    pub(super) groups_needed: Buffer,
    /// The state of all paths, slot by slot.
    pub(crate) paths: Buffer,
    variations: Buffer,
    pub(crate) lit: LightingBuffers,
    pub(crate) tiles: Vec<LitTile>,
    /// Read-back buffer of the status word, which is nonzero if an invocation reached its iteration limit.
    pub(crate) spent_back: ReadableBuffer,
    pub(crate) film_back: ReadableBuffer,
    pub(crate) variations_back: ReadableBuffer,
}

/// The program that records the passes of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RecordedBy {
    /// This crate, which submits one recording before it makes the next, and reads the sums.
    Headless,
    /// A host program, which may have several recordings under way, and shows the sums.
    Host {
        /// Maximum number of recordings under way.
        at_once: usize,
    },
}

impl RecordedBy {
    fn at_once(self) -> usize {
        match self {
            Self::Headless => 1,
            Self::Host { at_once } => at_once,
        }
    }
}

/// A tile, and the sums of its pixels.
#[derive(Debug)]
pub(crate) struct LitTile {
    pub(crate) tile: Tile,
    pub(super) frames: Frames,
    records: Buffer,
    /// The sums of the tile's pixels, as in `shaders/path/film_sums.wgsl`.
    pub(crate) film: Buffer,
    /// Bind group 0 of most passes, indexed by [`Area`].
    pub(super) groups: [BindGroup; 3],
    pub(super) advance: BindGroup,
    /// Bind group 0 of the passes that process sums.
    pub(super) sums: BindGroup,
    /// Bind group 0 of the pass that takes whole samples.
    pub(super) samples: BindGroup,
}

impl LitFrame {
    /// Creates the buffers for some tiles, none of which may be larger than `sizes.tile`.
    pub(crate) async fn new(
        make: Make<'_>,
        passes: &LitPasses,
        sizes: LitSizes,
        lighting: &LightingData,
        by: RecordedBy,
        tiles: impl Iterator<Item = (Tile, Frames)>,
    ) -> Result<Self, GpuError> {
        let device = make.device;
        let alignment = device.limits().min_uniform_buffer_offset_alignment as usize;
        let parameter_stride = size_of::<DispatchParameters>().next_multiple_of(alignment);
        let frame_stride = size_of::<FrameParameters>().next_multiple_of(alignment);
        check_storage_size(device, "the paths of a tile", sizes.path_bytes())?;
        check_storage_size(device, "the lists of paths", sizes.queue_bytes())?;
        check_storage_size(device, "the sums of a tile", sizes.film_bytes())?;
        let lit = LightingBuffers::new(make, &passes.layouts, lighting, None).await?;
        scoped(device, || {
            let storage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
            let parameters = make.buffer(
                "pinhole parameters",
                (by.at_once() * MAX_DISPATCHES * parameter_stride) as u64,
                BufferUsages::UNIFORM,
            );
            let of_paths = |label, bytes| make.buffer(label, bytes, storage);
            let paths = of_paths("pinhole paths", sizes.path_bytes());
            let lists = of_paths("pinhole lists of paths", sizes.queue_bytes());
            let variations = of_paths("pinhole variations", sizes.variation_bytes());
            let needed = storage | BufferUsages::INDIRECT;
            let groups_needed = make.buffer("pinhole groups needed", GROUPS_NEEDED, needed);
            let LitLayouts { frame, advance, film: of_sums, samples, .. } = &passes.layouts;
            let group = |label, layout, entries: &[Entry<'_>]| bind_group(device, label, layout, entries);
            let new_tile = |(tile, frames): (Tile, Frames)| {
                let records = strided(&frames, frame_stride);
                let records = make.filled("pinhole frames", &records, BufferUsages::UNIFORM);
                // The buffers are copied completely, so all have the same size.
                let film = of_paths("pinhole sums", sizes.film_bytes());
                let dispatch = (4, part(&parameters, 0, size_of::<DispatchParameters>()));
                let record = |area: usize| (0, part(&records, area * frame_stride, size_of::<FrameParameters>()));
                let common = |area| [record(area), whole(2, &lists), whole(3, &paths), dispatch.clone()];
                let taken = [record(0), whole(2, &lists), dispatch.clone(), whole(5, &film)];
                let of_advance = [&common(0)[..], &[whole(5, &groups_needed)]].concat();
                let summed = [&common(0)[..], &[whole(5, &film), whole(6, &variations)]].concat();
                LitTile {
                    tile,
                    frames,
                    groups: [0, 1, 2].map(|area| group("pinhole frame", frame, &common(area))),
                    samples: group("pinhole samples", samples, &taken),
                    advance: group("pinhole advance", advance, &of_advance),
                    sums: group("pinhole film", of_sums, &summed),
                    records,
                    film,
                }
            };
            let tiles = tiles.map(new_tile).collect();
            // A host reads nothing back.
            let back = |label, bytes| match by {
                RecordedBy::Headless => ReadableBuffer::new(device, label, bytes),
                RecordedBy::Host { .. } => ReadableBuffer::new(device, label, 4),
            };
            Self {
                sizes,
                lit,
                tiles,
                spent_back: back("pinhole spent read-back", 4),
                film_back: back("pinhole sums read-back", sizes.film_bytes()),
                variations_back: back("pinhole variations read-back", variations.size()),
                parameters,
                parameter_stride,
                frame_stride,
                queue: lists,
                groups_needed,
                paths,
                variations,
            }
        })
        .await
    }

    /// Queues the parameters of a recording's dispatches, at most [`MAX_DISPATCHES`]. `place` is the index of the
    /// recording among the recordings under way.
    pub(crate) fn queue_parameters(&self, queue: &Queue, place: usize, parameters: &[DispatchParameters]) {
        let bytes = strided(parameters, self.parameter_stride);
        queue.write_buffer(&self.parameters, u64::from(self.parameter_offset(place, 0)), &bytes);
    }

    /// Offset in bytes of the parameters of a dispatch, given the index of its recording and its own index there.
    pub(super) fn parameter_offset(&self, place: usize, number: usize) -> u32 {
        // There are a few recordings with at most MAX_DISPATCHES each, so this fits into u32.
        ((place * MAX_DISPATCHES + number) * self.parameter_stride) as u32
    }

    /// Queues other records for the tiles, in order, and returns whether any record differs from the previous one.
    pub(crate) fn set_frames(&mut self, queue: &Queue, frames: impl Iterator<Item = Frames>) -> bool {
        let mut differs = false;
        for (tile, frames) in self.tiles.iter_mut().zip(frames) {
            if bytemuck::bytes_of(&tile.frames) != bytemuck::bytes_of(&frames) {
                queue.write_buffer(&tile.records, 0, &strided(&frames, self.frame_stride));
                tile.frames = frames;
                differs = true;
            }
        }
        differs
    }

    /// The buffer that begins with the status word, which becomes nonzero if the search of a ray is abandoned.
    pub(crate) fn spent(&self) -> &Buffer {
        &self.queue
    }

    /// Records a command that empties the lists.
    pub(crate) fn record_clear_lists(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.queue, 4, Some(QUEUE_HEAD - 4));
    }

    /// Records a command that clears the sums of a tile.
    pub(crate) fn record_clear_film(&self, encoder: &mut CommandEncoder, tile: usize) {
        encoder.clear_buffer(&self.tiles[tile].film, 0, None);
    }

    /// Records the copy of the status word.
    pub(crate) fn record_copy_spent(&self, encoder: &mut CommandEncoder) {
        self.spent_back.record_copy(encoder, &self.queue);
    }

    /// Returns an error if the searches of some rays were abandoned. The copy of the status word must be mapped.
    pub(crate) fn read_spent(&self) -> Result<(), GpuError> {
        match self.spent_back.read(|words: &[u32]| words[0])? {
            0 => Ok(()),
            _ => Err(GpuError::Steps),
        }
    }

    /// Records the copy of a tile's sums.
    pub(crate) fn record_copy_film(&self, encoder: &mut CommandEncoder, tile: usize) {
        self.film_back.record_copy(encoder, &self.tiles[tile].film);
    }

    /// Records the copy of the sums of variances and luminances of a tile.
    pub(crate) fn record_copy_variations(&self, encoder: &mut CommandEncoder) {
        self.variations_back.record_copy(encoder, &self.variations);
    }
}

/// Bytes of records that are placed `stride` bytes apart.
fn strided<Record: bytemuck::Pod>(records: &[Record], stride: usize) -> Vec<u8> {
    let mut bytes = vec![0_u8; records.len() * stride];
    for (target, record) in bytes.chunks_mut(stride).zip(records) {
        target[..size_of::<Record>()].copy_from_slice(bytemuck::bytes_of(record));
    }
    bytes
}

/// The record of a lighting, its tables, emitters and sky.
#[derive(Debug)]
pub(crate) struct LightingBuffers {
    record: Buffer,
    tables: Buffer,
    emitters: TextureView,
    /// Bind group of lights and materials.
    pub(crate) group: BindGroup,
    /// Bind group of the image of the sky.
    pub(crate) sky: Option<BindGroup>,
}

impl LightingBuffers {
    /// Queues other light. Buffers are created only if tables have another size. The emitters and the image of the sky
    /// are uploaded if `is_new` says that they may have changed.
    pub(crate) async fn set(
        &mut self,
        make: Make<'_>,
        layouts: &LitLayouts,
        lighting: &LightingData,
        is_new: bool,
    ) -> Result<(), GpuError> {
        if is_new || self.tables.size() != lighting.table_bytes() {
            let kept = (!is_new).then_some(&*self);
            *self = Self::new(make, layouts, lighting, kept).await?;
        } else {
            let queue = make.queue;
            queue.write_buffer(&self.record, 0, bytemuck::bytes_of(&lighting.parameters));
            queue.write_buffer(&self.tables, 0, bytemuck::cast_slice(&lighting.tables));
        }
        Ok(())
    }

    /// Creates the buffers. `kept` contains emitters and the sky.
    pub(crate) async fn new(
        make: Make<'_>,
        layouts: &LitLayouts,
        lighting: &LightingData,
        kept: Option<&Self>,
    ) -> Result<Self, GpuError> {
        let Make { device, queue } = make;
        check(device, lighting)?;
        scoped(device, || {
            let record = bytemuck::bytes_of(&lighting.parameters);
            let record = make.filled("pinhole lighting", record, BufferUsages::UNIFORM);
            let tables = bytemuck::cast_slice(&lighting.tables);
            let tables = make.filled("pinhole tables", tables, BufferUsages::STORAGE);
            let (emitters, sky) = match kept {
                Some(kept) => (kept.emitters.clone(), kept.sky.clone()),
                None => (
                    emitter_table::upload(device, queue, &lighting.emitters),
                    lighting.sky.as_deref().map(|image| sky_group(make, layouts, image)),
                ),
            };
            let texture = (2, wgpu::BindingResource::TextureView(&emitters));
            let entries = [whole(0, &record), whole(1, &tables), texture];
            let group = bind_group(device, "pinhole lighting", &layouts.lighting, &entries);
            Self { record, tables, emitters, group, sky }
        })
        .await
    }
}

fn sky_group(make: Make<'_>, layouts: &LitLayouts, environment: &Environment) -> BindGroup {
    let texels: Vec<[f32; 4]> = environment.texels().iter().map(|[r, g, b]| [*r, *g, *b, 0.0]).collect();
    let shares: Vec<f32> = environment.rows().iter().chain(environment.columns()).copied().collect();
    let storage = BufferUsages::STORAGE;
    let texels = make.filled("pinhole sky", bytemuck::cast_slice(&texels), storage);
    let shares = make.filled("pinhole sky shares", bytemuck::cast_slice(&shares), storage);
    let bound = [&texels, &shares].map(Buffer::as_entire_binding);
    numbered_group(make.device, "pinhole sky", &layouts.sky, bound)
}

/// Returns an error if the device has no room for the tables of a lighting.
fn check(device: &Device, lighting: &LightingData) -> Result<(), GpuError> {
    check_storage_size(device, "the tables of lights and materials", lighting.table_bytes())?;
    let (limit_name, limit) = emitter_table::limit(&device.limits());
    let needed = emitter_table::planned(lighting.emitters.len()).map_or(0, |table| table.bytes);
    if needed > limit {
        let what = emitter_table::WHAT;
        return Err(GpuError::Limit { what, needed, limit_name, limit });
    }
    if let Some(environment) = &lighting.sky {
        let bytes = 16 * environment.texels().len() as u64;
        check_storage_size(device, "the image of the sky", bytes)?;
    }
    Ok(())
}
