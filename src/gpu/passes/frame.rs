//! The data of primary rays that change from picture to picture: targets, view and settings.

use std::collections::HashMap;

use wgpu::{BindGroup, BindingResource, Buffer, BufferUsages, Device, Queue};

use crate::camera::{CameraKind, View};
use crate::gpu::checks::scoped;
use crate::gpu::error::{GpuError, check_storage_size, check_whole};
use crate::gpu::passes::bands::{BandBuffers, rows_per_band};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::targets::{Targets, checked_targets, describe_size};
use crate::gpu::passes::tiles::{self, Groups, Tile};
use crate::gpu::passes::visible_bricks::VisibleBricks;
use crate::gpu::resources::{buffer, numbered_group, part};
use crate::gpu::scene::scene_buffers::{SceneBuffers, SceneId};
use crate::gpu::shader::formats::ColorTarget;
use crate::gpu::shader::records::{self, FrameParameters};
use crate::recording::RequestedCamera;
use crate::render::{PrimarySettings, RenderSettings};

/// A view that is rendered to a set of targets. A recorded frame must be submitted before its view is set again.
#[derive(Debug)]
pub struct Frame {
    color: ColorTarget,
    data_layers: bool,
    /// The rays of the pixels of a band, if they are kept.
    rays: Option<Buffer>,
    /// One record for each slot of each band, at multiples of `stride` bytes: first slot 0 of all bands, then slot 1.
    records: Buffer,
    hits: Buffer,
    stride: usize,
    rows_per_band: u32,
    /// Bind group 0 of every kernel, one for each record. All bands share one buffer of hits.
    groups: Vec<BindGroup>,
    /// Number of bands that the targets are divided into.
    bands: usize,
    target_group: BindGroup,
    size: [u32; 2],
    view: Option<SetView>,
    /// Status word, which becomes nonzero when a kernel reaches its iteration limit.
    status: Buffer,
    iteration_limit: u32,
    bytes: u64,
}

/// The properties of the view that recording needs.
#[derive(Debug)]
pub(crate) struct SetView {
    pub(crate) camera: CameraKind,
    pub(crate) scene: SceneId,
    /// The sizes of the bands, in the order in which they are rendered.
    pub(crate) bands: Vec<[u32; 2]>,
    records: HashMap<Slot, FrameParameters>,
    parts: Vec<BandBrick>,
}

/// Index of a record of a frame. Slot 0 of a band is the record of the region in which the scene may be visible. The
/// first brick is traced there, and all bricks are shaded there. Later bricks of the band have the other slots, as long
/// as there are any, and then slot 0 again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Slot {
    pub(crate) band: usize,
    number: usize,
}

/// Number of bricks that have a separate record in each band of a frame. Together they hold up to 260
/// million spheres, in bindings of 128 MiB.
const SLOTS: usize = 32;

/// The tracing of one brick for one band.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BandBrick {
    pub(crate) band: usize,
    pub(crate) brick: usize,
    /// The record of the workgroups.
    pub(crate) slot: Slot,
    /// The workgroups, counted from the first of the record.
    pub(crate) groups: Groups,
    pub(crate) is_first_of_band: bool,
    pub(crate) is_last_of_band: bool,
    pub(crate) is_last: bool,
}

impl Slot {
    /// The record of the region in which the scene may be visible in a band.
    pub(crate) fn of_scene(band: usize) -> Self {
        Self { band, number: 0 }
    }
}

impl Frame {
    /// Creates a frame that renders to the given targets.
    ///
    /// A picture whose hits (16 bytes for each pixel) do not fit into one binding is rendered in bands.
    ///
    /// # Errors
    /// If a target does not have the format, size or usage that the renderer needs, or if the device has no memory
    /// left.
    pub async fn new(renderer: &Renderer, device: &Device, targets: &Targets<'_>) -> Result<Self, GpuError> {
        let views = checked_targets(renderer, targets)?;
        let texture = targets.color.texture();
        let size = [texture.width(), texture.height()];
        let limits = device.limits();
        let keeps_rays = renderer.keeps_rays;
        let rows_per_band = rows_per_band(&limits, size, keeps_rays);
        let band = BandBuffers::new(&limits, size, keeps_rays);
        check_storage_size(device, "the buffer of hits", band.hits)?;
        check_storage_size(device, "the buffer of rays", band.rays.unwrap_or(0))?;
        let record_size = size_of::<FrameParameters>();
        let alignment = limits.min_uniform_buffer_offset_alignment as usize;
        let stride = record_size.next_multiple_of(alignment);
        let bands = size[1].div_ceil(rows_per_band) as usize;
        let slots = bands * if renderer.several_bricks { SLOTS } else { 1 };
        let (records, hits, rays, status, groups, target_group) = scoped(device, || {
            let uniform = BufferUsages::UNIFORM;
            let records = buffer(device, "pinhole frame", (slots * stride) as u64, uniform);
            let read_back = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
            let storage = |label, bytes| buffer(device, label, bytes, read_back);
            let status = storage("pinhole status", size_of::<records::Status>() as u64);
            let hits = storage("pinhole hits", band.hits);
            let rays = band.rays.map(|bytes| storage("pinhole rays", bytes));
            let group = |slot| {
                let buffers = [&hits, &status].into_iter().chain(&rays);
                let resources = std::iter::once(part(&records, slot * stride, record_size))
                    .chain(buffers.map(Buffer::as_entire_binding));
                numbered_group(device, "pinhole frame", &renderer.layouts.frame, resources)
            };
            let groups = (0..slots).map(group).collect();
            let views = views.into_iter().map(BindingResource::TextureView);
            let target_group = numbered_group(device, "pinhole targets", &renderer.layouts.targets, views);
            (records, hits, rays, status, groups, target_group)
        })
        .await?;
        let Renderer { color, data_layers, .. } = *renderer;
        Ok(Self {
            color,
            data_layers,
            rays,
            records,
            hits,
            stride,
            rows_per_band,
            groups,
            bands,
            target_group,
            size,
            view: None,
            status,
            iteration_limit: iteration_limit(device),
            bytes: band.bytes() + (slots * stride) as u64,
        })
    }

    /// Sets the view that the next recording shows. The film must have the size of the targets.
    ///
    /// The new values are queued on `queue` and take effect with its next submission.
    ///
    /// # Errors
    /// If the sizes of film and targets differ; [`GpuError::NotPrimary`] if the integrator is not `primary`, because
    /// frames support no other yet; the errors of [`RenderSettings::check`].
    pub fn set_view(
        &mut self,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<(), GpuError> {
        let primary = scene.primary_settings(settings)?;
        self.set_primary(queue, scene, view, &primary)
    }

    /// Sets a view like [`Frame::set_view`], with settings that have been checked.
    pub(crate) fn set_primary(
        &mut self,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        primary: &PrimarySettings,
    ) -> Result<(), GpuError> {
        self.check_film(view)?;
        let tile = Tile { origin: [0, 0], size: self.size, in_target: [0, 0] };
        self.set_tile(queue, scene, view, tile, primary);
        Ok(())
    }

    /// Returns an error if the film has another size than the targets.
    pub(crate) fn check_film(&self, view: &View<'_>) -> Result<(), GpuError> {
        check_whole(&view.film)?;
        let film_size = [view.film.width(), view.film.height()];
        if film_size != self.size {
            return Err(GpuError::Target {
                layer: "color",
                found: describe_size(self.size),
                expected: format!("as large as the film, {}", describe_size(film_size)),
            });
        }
        Ok(())
    }

    /// Sets a view like [`Frame::set_view`], for a tile that is not larger than the targets.
    pub(crate) fn set_tile(
        &mut self,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        tile: Tile,
        primary: &PrimarySettings,
    ) {
        let visible = VisibleBricks::of(view, &scene.space, &scene.brick_bounds());
        self.set_bricks(queue, scene, &visible, view, tile, primary);
    }

    /// Sets a view like [`Frame::set_tile`], with bricks that need not all be on the device yet.
    pub(crate) fn set_bricks(
        &mut self,
        queue: &Queue,
        scene: &SceneBuffers,
        visible: &VisibleBricks,
        view: &View<'_>,
        tile: Tile,
        primary: &PrimarySettings,
    ) {
        let space = &scene.space;
        let camera = RequestedCamera::of(view.camera);
        let bands: Vec<Tile> = tiles::bands(tile, self.rows_per_band).collect();
        let device_shape = scene.shape;
        let slots = self.groups.len() / self.bands;
        let (mut records, mut parts) = (HashMap::new(), Vec::new());
        for (band, tile) in bands.iter().enumerate() {
            let of_band = visible.parts_of(*tile);
            let scene = of_band.first().map_or(Groups::NONE, |(_, groups)| *groups);
            for (position, (brick, groups)) in of_band.iter().enumerate() {
                let has_own = position < slots;
                let slot = Slot { band, number: if has_own { position } else { 0 } };
                let traced = if has_own { *groups } else { scene };
                records.entry(slot).or_insert_with(|| {
                    let limit = self.iteration_limit;
                    FrameParameters::new(&camera, space, &view.film, *tile, traced, primary, limit)
                        .in_order_of(device_shape)
                });
                let is_last_of_band = position + 1 == of_band.len();
                parts.push(BandBrick {
                    band,
                    brick: *brick,
                    slot,
                    groups: Groups { first: [0, 0], size: traced.size },
                    is_first_of_band: position == 0,
                    is_last_of_band,
                    is_last: is_last_of_band && band + 1 == bands.len(),
                });
            }
        }
        let used = records.keys().map(|slot| self.place(*slot) + 1).max().unwrap_or(0);
        let mut bytes = vec![0_u8; used * self.stride];
        for (slot, record) in &records {
            let start = self.place(*slot) * self.stride;
            bytes[start..start + size_of::<FrameParameters>()].copy_from_slice(bytemuck::bytes_of(record));
        }
        queue.write_buffer(&self.records, 0, &bytes);
        let bands = bands.into_iter().map(|band| band.size).collect();
        let (camera, scene) = (camera.kind, scene.id);
        self.view = Some(SetView { camera, scene, bands, records, parts });
    }

    /// Index of a record in the buffer of records.
    fn place(&self, Slot { band, number }: Slot) -> usize {
        number * self.bands + band
    }

    /// Queues the index of the first workgroup of the slice of a part that is traced next.
    pub(crate) fn set_first_group(&mut self, queue: &Queue, slot: Slot, first: [u32; 2]) {
        let start = (self.place(slot) * self.stride) as u64;
        let Some(record) = self.view.as_mut().and_then(|view| view.records.get_mut(&slot)) else {
            return;
        };
        if record.first_group != first {
            record.first_group = first;
            queue.write_buffer(&self.records, start, bytemuck::bytes_of(record));
        }
    }

    /// The bricks and bands to be traced for the view, in order.
    pub(crate) fn parts(&self) -> impl Iterator<Item = BandBrick> + '_ {
        self.view.iter().flat_map(|view| view.parts.iter().copied())
    }

    /// Records commands that clear the hits, and the rays if they are kept.
    pub(crate) fn record_clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.hits, 0, None);
        if let Some(rays) = &self.rays {
            encoder.clear_buffer(rays, 0, None);
        }
    }

    /// The buffers with the hits of the last band, and with its rays if they are kept.
    pub(crate) fn traced(&self) -> (&Buffer, Option<&Buffer>) {
        (&self.hits, self.rays.as_ref())
    }

    /// Returns a buffer of one `u32`, which kernels set if the search of a ray was abandoned because it reached the
    /// iteration limit. Some pixels are then wrong. The buffer contains 0 after creation and is never reset: read it
    /// after a submission has finished, and clear it.
    ///
    /// Its usages are `COPY_SRC` and `COPY_DST`. On software devices the limit is 8,000 spheres and cells, because old
    /// software devices leave long loops silently.
    #[must_use]
    pub fn status(&self) -> &Buffer {
        &self.status
    }

    /// Returns the number of bytes of the frame's buffers on the device, without the caller's textures.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Returns an error if the frame was made for a renderer with other targets.
    pub(crate) fn check_renderer(&self, renderer: &Renderer) -> Result<(), GpuError> {
        let made_for = (self.color, self.data_layers, self.rays.is_some());
        if made_for != (renderer.color, renderer.data_layers, renderer.keeps_rays) {
            return Err(GpuError::OtherRenderer);
        }
        Ok(())
    }

    /// The view, if this renderer can record it for this scene.
    pub(crate) fn view(&self, renderer: &Renderer, scene: &SceneBuffers) -> Result<&SetView, GpuError> {
        let view = self.view.as_ref().ok_or(GpuError::NoView)?;
        self.check_renderer(renderer)?;
        if view.scene != scene.id {
            return Err(GpuError::OtherScene);
        }
        Ok(view)
    }

    /// Width and height of the targets.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The workgroups of a record.
    pub(crate) fn traced_groups(&self, slot: Slot) -> Groups {
        let record = self.view.as_ref().and_then(|view| view.records.get(&slot));
        record.map_or(Groups::NONE, |record| Groups { first: record.traced_first, size: record.traced_size })
    }

    /// Bind group 0 of every kernel, with the record of a slot.
    pub(crate) fn group(&self, slot: Slot) -> &BindGroup {
        &self.groups[self.place(slot)]
    }

    /// Bind group 2 of `shade`.
    pub(crate) fn target_group(&self) -> &BindGroup {
        &self.target_group
    }
}

/// Maximum number of loop iterations of an invocation.
///
/// The lavapipe of Mesa 22.3 leaves all loops silently after 65,535 iterations of the invocations that it runs
/// together. It runs eight together by default, so an eighth of that number is safe. The nested loops of the self-test
/// check this. On other devices the limit only bounds the run time of a kernel with a defect.
pub(crate) fn iteration_limit(device: &Device) -> u32 {
    let info = device.adapter_info();
    match info.device_type {
        wgpu::DeviceType::Cpu => 64_000 / info.subgroup_max_size.max(8),
        _ => 1 << 24,
    }
}
