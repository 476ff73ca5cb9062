//! Buffers of one tile of a lit picture.

use wgpu::{BindGroup, Buffer, BufferUsages, Device, Queue};

use super::look::Lit;
use super::records::{FILM_SLOTS, Look, PATH_SLOTS, Stage};
use super::renderer::LitRenderer;
use crate::environment::Environment;
use crate::film::Film;
use crate::gpu::error::{GpuError, check_storage_size, scoped};
use crate::gpu::readback::ReadableBuffer;
use crate::gpu::records::{Frame, Hit, Status};
use crate::gpu::scene_buffers::part;
use crate::gpu::tiles::WORKGROUP_SIDE;
use crate::lighting::SkyLight;
use crate::render::{Integrator, RenderSettings};

/// How many dispatches one submission has at most.
pub(super) const MOST_STAGES: usize = 1024;

/// Records of a tile.
pub(super) const FRAMES: usize = 3;

/// The most pixels of a tile: their state then takes 88 MiB.
const MOST_PIXELS: u64 = 1 << 19;

/// What a dispatch is bound to beside the scene.
#[derive(Debug)]
pub(super) struct TileBuffers {
    /// Records: of all of a tile; for searching the scene, and for searching what casts shadows, where there is any.
    frames: Buffer,
    frame_stride: usize,
    stages: Buffer,
    pub(super) stage_stride: usize,
    status: Buffer,
    film: Buffer,
    pub(super) paths: Buffer,
    pub(super) hits: Buffer,
    pub(super) status_back: ReadableBuffer,
    pub(super) film_back: ReadableBuffer,
    pub(super) search: [BindGroup; 2],
    /// Of all of a tile, and of where the scene may be seen.
    pub(super) shade: [BindGroup; 2],
    pub(super) deposit: BindGroup,
    pub(super) look: BindGroup,
    pub(super) sky: Option<BindGroup>,
}

/// The size of the tiles of a lit picture.
pub(super) fn lit_tile_size(limits: &wgpu::Limits, film: &Film) -> [u32; 2] {
    let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let most = (binding / (16 * PATH_SLOTS)).clamp(64, MOST_PIXELS);
    let width = u64::from(film.width()).min((most / 8).max(8));
    let rows = (most / width).max(1);
    let side = u64::from(WORKGROUP_SIDE);
    let rows = if rows > side { rows / side * side } else { rows };
    // No more than the film, so they fit.
    [width as u32, rows.min(film.height().into()) as u32]
}

/// The image that paths are lit by.
pub(super) fn sky_image(lighting: &RenderSettings) -> Option<&Environment> {
    match (&lighting.sky.light, &lighting.integrator) {
        (SkyLight::Image { environment, .. }, Integrator::Path(_)) => Some(environment),
        _ => None,
    }
}

impl TileBuffers {
    pub(super) fn new(
        device: &Device,
        queue: &Queue,
        renderer: &LitRenderer,
        size: [u32; 2],
        lit: &Lit,
        lighting: &RenderSettings,
    ) -> Result<Self, GpuError> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let bytes_of = |vectors: u64| pixels * 16 * vectors;
        let limits = device.limits();
        let alignment = limits.min_uniform_buffer_offset_alignment as usize;
        let frame_stride = size_of::<Frame>().next_multiple_of(alignment);
        let stage_stride = size_of::<Stage>().next_multiple_of(alignment);
        let table_bytes = lit.table_bytes();
        check_storage_size(device, "the paths of a tile", bytes_of(PATH_SLOTS))?;
        check_storage_size(device, "the tables of lights and materials", table_bytes)?;
        let sky_image = sky_image(lighting);
        if let Some(environment) = sky_image {
            let bytes = 16 * environment.texels().len() as u64;
            check_storage_size(device, "the image of the sky", bytes)?;
        }
        scoped(device, || {
            let buffer = |label, size, usage| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(label),
                    size,
                    usage: usage | BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                })
            };
            let storage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
            let uniform = BufferUsages::UNIFORM;
            let frames = buffer("pinhole frames", FRAMES as u64 * frame_stride as u64, uniform);
            let stages = buffer("pinhole stages", (MOST_STAGES * stage_stride) as u64, uniform);
            let hits = buffer("pinhole hits", pixels * size_of::<Hit>() as u64, storage);
            let paths = buffer("pinhole paths", bytes_of(PATH_SLOTS), storage);
            let status = buffer("pinhole status", size_of::<Status>() as u64, storage);
            let film = buffer("pinhole film", bytes_of(FILM_SLOTS), storage);
            let look = buffer("pinhole look", size_of::<Look>() as u64, uniform);
            let tables = buffer("pinhole tables", table_bytes, storage);
            queue.write_buffer(&look, 0, bytemuck::bytes_of(&lit.look));
            queue.write_buffer(&tables, 0, bytemuck::cast_slice(&lit.tables));
            let group = |label, layout, entries: &[(u32, wgpu::BindingResource<'_>)]| {
                let entries: Vec<_> = entries
                    .iter()
                    .map(|(binding, resource)| wgpu::BindGroupEntry {
                        binding: *binding,
                        resource: resource.clone(),
                    })
                    .collect();
                device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some(label),
                    layout,
                    entries: &entries,
                })
            };
            let frame = |index: usize| (0, part(&frames, index * frame_stride, size_of::<Frame>()));
            let stage = || (4, part(&stages, 0, size_of::<Stage>()));
            let layouts = &renderer.layouts;
            let search = [1, 2].map(|index| {
                let entries =
                    [frame(index), whole(1, &hits), whole(2, &status), whole(3, &paths), stage()];
                group("pinhole search", &layouts.search, &entries)
            });
            let deposited = [frame(0), whole(3, &paths), stage(), whole(5, &film)];
            let known = [whole(0, &look), whole(1, &tables)];
            let sky = sky_image.map(|environment| {
                let texels: Vec<[f32; 4]> =
                    environment.texels().iter().map(|[r, g, b]| [*r, *g, *b, 0.0]).collect();
                let shares: Vec<f32> =
                    environment.rows().iter().chain(environment.columns()).copied().collect();
                let texel_buffer = buffer("pinhole sky", size_of_val(&texels[..]) as u64, storage);
                let share_buffer =
                    buffer("pinhole sky shares", size_of_val(&shares[..]) as u64, storage);
                queue.write_buffer(&texel_buffer, 0, bytemuck::cast_slice(&texels));
                queue.write_buffer(&share_buffer, 0, bytemuck::cast_slice(&shares));
                let entries = [whole(0, &texel_buffer), whole(1, &share_buffer)];
                group("pinhole sky", &layouts.sky, &entries)
            });
            Self {
                frame_stride,
                stage_stride,
                status_back: ReadableBuffer::new(device, "pinhole status read-back", status.size()),
                film_back: ReadableBuffer::new(device, "pinhole film read-back", film.size()),
                search,
                shade: [0, 1].map(|index| {
                    let entries = [frame(index), whole(1, &hits), whole(3, &paths), stage()];
                    group("pinhole shade", &layouts.shade, &entries)
                }),
                deposit: group("pinhole deposit", &layouts.film, &deposited),
                look: group("pinhole look", &layouts.look, &known),
                sky,
                frames,
                stages,
                status,
                paths,
                hits,
                film,
            }
        })
    }

    /// Queues what the next submission's dispatches do, and which workgroups they are.
    pub(super) fn queue_records(&self, queue: &Queue, frames: &[Frame; FRAMES], stages: &[Stage]) {
        for (index, frame) in frames.iter().enumerate() {
            let offset = (index * self.frame_stride) as u64;
            queue.write_buffer(&self.frames, offset, bytemuck::bytes_of(frame));
        }
        let mut bytes = vec![0_u8; stages.len() * self.stage_stride];
        for (target, stage) in bytes.chunks_mut(self.stage_stride).zip(stages) {
            target[..size_of::<Stage>()].copy_from_slice(bytemuck::bytes_of(stage));
        }
        queue.write_buffer(&self.stages, 0, &bytes);
    }

    pub(super) fn record_clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.film, 0, None);
        encoder.clear_buffer(&self.status, 0, None);
    }

    pub(super) fn record_clear_alive(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.status, 4, None);
    }

    pub(super) fn record_copy_status(&self, encoder: &mut wgpu::CommandEncoder) {
        self.status_back.record_copy(encoder, &self.status);
    }

    pub(super) fn record_copy_film(&self, encoder: &mut wgpu::CommandEncoder) {
        self.film_back.record_copy(encoder, &self.film);
    }
}

fn whole(binding: u32, buffer: &Buffer) -> (u32, wgpu::BindingResource<'_>) {
    (binding, buffer.as_entire_binding())
}
