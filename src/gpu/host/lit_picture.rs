//! Lit pictures that accumulate samples in the encoders of a host.

use std::sync::Arc;

use wgpu::{Buffer, CommandEncoder, ComputePassDescriptor, ComputePipeline, Device, Queue};

use crate::camera::View;
use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::host::lit_cursor::{Budget, Cursor, RAYS_PER_GROUP};
use crate::gpu::host::lit_renderer::{LitRenderer, lit_key};
use crate::gpu::host::tickets::{AT_ONCE as RECORDINGS, Tickets};
use crate::gpu::passes::frame::{BandBrick, Frame};
use crate::gpu::passes::lit::{
    LightingData, LitFrame, LitKey, LitPasses, LitScene, LitSizes, RecordedBy, Recorder, Round, SampleStrategy,
};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::targets::Targets;
use crate::gpu::passes::tiles::{Groups, tiles};
use crate::gpu::resources::Make;
use crate::gpu::scene::scene_buffers::{SceneBuffers, SceneLook};
use crate::render::{PrimarySettings, RenderSettings};

/// A picture of a studio or of light paths that a host shows while it accumulates some samples in each frame, until the
/// camera, the light or the scene changes.
///
/// The textures first get the picture by primary rays, with depth, normals and ids. Then the colour becomes the mean of
/// the samples so far, premultiplied by alpha. If the settings are transparent, alpha is 0 where nothing is hit.
#[derive(Debug)]
pub struct LitPicture {
    passes: Arc<LitPasses>,
    resolve: Arc<ComputePipeline>,
    key: LitKey,
    lighting: LightingData,
    frame: LitFrame,
    /// The picture by primary rays, and the rest of it that is left to record.
    data: Frame,
    data_cursor: DataCursor,
    primary: PrimarySettings,
    look: SceneLook,
    total: u32,
    cursor: Cursor,
    is_cleared: bool,
    tickets: Tickets,
    strategy: SampleStrategy,
    is_indirect: bool,
}

/// Progress of recording the picture by primary rays.
#[derive(Debug, Default)]
struct DataCursor {
    /// Number of bricks of bands that are complete.
    parts: usize,
    /// The remaining workgroups of the next brick of a band, if some have been recorded.
    left: Vec<Groups>,
}

impl LitPicture {
    /// Creates the buffers of a picture in the targets. These must have the formats of the renderer's options, the size
    /// of the film, and the usage `STORAGE_BINDING`. Pipelines are built if [`LitRenderer::build`] has not built them.
    ///
    /// # Errors
    /// [`GpuError::NotLit`] for the integrator `primary`; the errors of [`RenderSettings::check`];
    /// [`GpuError::NoOccluders`]; [`GpuError::Target`] if a target is not as described; an error if the device has no
    /// memory left.
    pub async fn new(
        renderer: &LitRenderer,
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        targets: &Targets<'_>,
    ) -> Result<Self, GpuError> {
        let (scenes, lighting, key) = lit_key(device, scene, view, settings)?;
        let mut data = Frame::new(renderer.renderer(), device, targets).await?;
        let primary = primary_of(settings);
        data.set_primary(queue, scene, view, &primary)?;
        let passes = renderer.passes(device, key).await?;
        let resolve = renderer.resolve(device).await?;
        let frame = new_frame(Make { device, queue }, &passes, &lighting, scenes).await?;
        let tickets = scoped(device, || Tickets::new(device)).await?;
        Ok(Self {
            passes,
            resolve,
            key,
            lighting,
            frame,
            data,
            data_cursor: DataCursor::default(),
            primary,
            look: scene.look(),
            total: settings.sampling.samples,
            cursor: Cursor::default(),
            is_cleared: false,
            tickets,
            strategy: SampleStrategy::OnePass,
            is_indirect: renderer.renderer().is_indirect,
        })
    }

    /// Sets the scene, the view and the light that the next recording shows. If nothing changes, the samples so far are
    /// kept. A larger number of samples continues the picture. Returns whether the picture begins again.
    ///
    /// The new values are queued on `queue` and take effect with its next submission. Buffers are created only for
    /// another number of lights or materials, another kind of light or camera, and images of the sky. Pipelines are
    /// built if [`LitRenderer::is_built`] says that some are missing.
    ///
    /// # Errors
    /// The errors of [`LitPicture::new`]; the picture stays as it was.
    pub async fn set(
        &mut self,
        renderer: &LitRenderer,
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<bool, GpuError> {
        self.data.check_renderer(renderer.renderer())?;
        self.data.check_film(view)?;
        let (scenes, lighting, key) = lit_key(device, scene, view, settings)?;
        let (make, key) = (Make { device, queue }, self.strategy.key(key));
        let sizes = sizes_of(device, scenes, &lighting);
        let is_other_look = scene.look() != self.look;
        let mut begins_again = is_other_look || primary_of(settings) != self.primary;
        if key != self.key || sizes != self.frame.sizes {
            let passes = renderer.passes(device, key).await?;
            self.frame = new_frame(make, &passes, &lighting, scenes).await?;
            self.passes = passes;
            begins_again = true;
        } else {
            if is_other_look || !lighting.is_same(&self.lighting) {
                let is_new = is_other_look || !lighting.has_same_images(&self.lighting);
                self.frame.lit.set(make, &self.passes.layouts, &lighting, is_new).await?;
                begins_again = true;
            }
            let records = tiles(&view.film, sizes.tile).map(scenes.records(device));
            begins_again |= self.frame.set_frames(queue, records.map(|(_, frames)| frames));
        }
        (self.key, self.lighting, self.look) = (key, lighting, scene.look());
        begins_again |= settings.sampling.samples < self.cursor.samples;
        self.total = settings.sampling.samples;
        self.primary = primary_of(settings);
        if begins_again {
            self.data.set_primary(queue, scene, view, &self.primary)?;
            self.begin_again();
        }
        Ok(begins_again)
    }

    fn begin_again(&mut self) {
        self.cursor = Cursor::default();
        self.is_cleared = false;
        self.data_cursor = DataCursor::default();
        self.tickets.begin_again();
    }

    /// Records the next part of the picture into the host's encoder: rays for depth, normals and ids if the view is new,
    /// and then samples, at most `max_rays` rays in all. Nothing is submitted, awaited or created.
    ///
    /// The encoder must be submitted to `queue`, after those of earlier recordings and before the one of the next. A
    /// recording that is dropped is noticed, and the picture begins again.
    ///
    /// # Errors
    /// [`GpuError::OtherScene`] if the scene is not the one that was set, or has changed since;
    /// [`GpuError::OtherRenderer`]; [`GpuError::NotReady`] if a pipeline of primary rays is still being built;
    /// [`GpuError::Budget`] if `max_rays` is too small for any work. Nothing is recorded then. [`GpuError::Steps`] if
    /// searches of an earlier recording were abandoned: call [`LitPicture::set`], which chooses passes with fewer
    /// iterations. If the error returns, the structure `list` always stays within the limit.
    pub fn record(
        &mut self,
        renderer: &LitRenderer,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        scene: &SceneBuffers,
        max_rays: u64,
    ) -> Result<LitProgress, GpuError> {
        self.data.check_renderer(renderer.renderer())?;
        if scene.look() != self.look {
            return Err(GpuError::OtherScene);
        }
        let news = self.tickets.news();
        if news.is_spent {
            self.strategy = self.strategy.easier(&self.lighting).unwrap_or(self.strategy);
            self.begin_again();
            return Err(GpuError::Steps);
        }
        if news.is_lost {
            self.begin_again();
        }
        let progress = |picture: &Self, budget: &Budget, state| LitProgress {
            samples: picture.cursor.samples,
            total: picture.total,
            rays: budget.rays,
            state,
            was_lost: news.is_lost,
        };
        let mut budget = Budget::new(max_rays);
        if self.cursor.samples >= self.total {
            return Ok(progress(self, &budget, LitState::Done));
        }
        let Some(place) = self.free_place(max_rays) else {
            return Ok(progress(self, &budget, LitState::Waiting));
        };
        if !self.is_cleared {
            for word in [self.frame.spent(), self.data.status()] {
                encoder.clear_buffer(word, 0, Some(4));
            }
            for tile in 0..self.frame.tiles.len() {
                self.frame.record_clear_film(encoder, tile);
            }
        }
        self.record_data(renderer.renderer(), queue, encoder, scene, &mut budget)?;
        if self.has_data() {
            self.record_samples(queue, encoder, scene, place, &mut budget)?;
        }
        self.is_cleared = true;
        self.tickets.record(encoder, place, [self.frame.spent(), self.data.status()]);
        let is_done = self.cursor.samples >= self.total;
        Ok(progress(self, &budget, if is_done { LitState::Done } else { LitState::Refining }))
    }

    /// Index of a free slot for a recording. A slice of the picture by primary rays has a queued record, so no other
    /// recording may be under way.
    fn free_place(&self, max_rays: u64) -> Option<usize> {
        let DataCursor { parts, left } = &self.data_cursor;
        let is_begun = *parts > 0 || !left.is_empty();
        let groups: u64 = self.data.parts().map(|part| part.groups.count()).sum();
        let is_sliced = !self.has_data() && (is_begun || groups * RAYS_PER_GROUP > max_rays);
        self.tickets.free().filter(|_| !is_sliced || self.tickets.are_all_free())
    }

    /// Whether the picture by primary rays is recorded.
    fn has_data(&self) -> bool {
        self.data_cursor.parts == self.data.parts().count()
    }

    /// Records the picture by primary rays, or one more slice of it.
    fn record_data(
        &mut self,
        renderer: &Renderer,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        scene: &SceneBuffers,
        budget: &mut Budget,
    ) -> Result<(), GpuError> {
        if self.has_data() {
            return Ok(());
        }
        let (data, cursor) = (&mut self.data, &mut self.data_cursor);
        let parts: Vec<BandBrick> = data.parts().collect();
        renderer.check_pipelines(scene, data, |part| part)?;
        let groups = parts.iter().map(|part| part.groups.count()).sum();
        if cursor.parts == 0 && cursor.left.is_empty() && groups <= budget.groups(1) {
            for part in &parts {
                data.set_first_group(queue, part.slot, part.groups.first);
            }
            renderer.record(encoder, scene, data)?;
            budget.take(groups, 1);
            cursor.parts = parts.len();
        }
        while let Some(part) = parts.get(cursor.parts) {
            if budget.groups(1) == 0 {
                return Err(budget.too_small(1));
            }
            if cursor.left.is_empty() {
                cursor.left.push(part.groups);
            }
            let slice = Groups::take(&mut cursor.left, budget.groups(1)).unwrap_or(Groups::NONE);
            data.set_first_group(queue, part.slot, slice.first);
            let descriptor = ComputePassDescriptor { label: Some("pinhole"), timestamp_writes: None };
            let mut pass = encoder.begin_compute_pass(&descriptor);
            renderer.record_trace(&mut pass, scene, data, BandBrick { groups: slice, ..*part })?;
            budget.take(slice.count(), 1);
            if cursor.left.is_empty() {
                if part.is_last_of_band {
                    renderer.record_shade(&mut pass, scene, data, part.band)?;
                }
                cursor.parts += 1;
            }
            if slice.count() > 0 {
                break;
            }
        }
        Ok(())
    }

    /// Records samples, and writes the means of the tiles whose number of samples grows.
    fn record_samples(
        &mut self,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        scene: &SceneBuffers,
        place: usize,
        budget: &mut Budget,
    ) -> Result<(), GpuError> {
        let Self { passes, frame, lighting, resolve, data, cursor, .. } = self;
        let occluders = if lighting.mode.is_studio() { scene.studio_occluders()? } else { scene };
        let room = frame.sizes.room();
        let round = Round { passes, lighting, scene, occluders, room, strategy: self.strategy };
        let mut recorder = Recorder::new(frame, &passes.advance, self.is_indirect, place);
        let show = |encoder: &mut CommandEncoder, recorder: &mut Recorder<'_>, samples: u32| {
            recorder.record_resolve(encoder, resolve, data.target_group(), samples);
        };
        let recorded = cursor.record(encoder, &round, &mut recorder, budget, self.total, show);
        frame.queue_parameters(queue, place, &recorder.take_parameters());
        recorded
    }

    /// The sums of every part of the picture.
    pub fn sums(&self) -> impl Iterator<Item = LitSums<'_>> {
        self.frame.tiles.iter().map(|tile| LitSums {
            origin: tile.tile.origin,
            size: tile.tile.size,
            buffer: &tile.film,
        })
    }
}

/// The settings of the picture by primary rays.
fn primary_of(settings: &RenderSettings) -> PrimarySettings {
    settings.by_primary_rays().primary().unwrap_or_default()
}

fn sizes_of(device: &Device, scenes: LitScene<'_>, lighting: &LightingData) -> LitSizes {
    let LitScene { all, view, settings, .. } = scenes;
    let (shape, samples) = (all.shape.of_host(), settings.sampling.samples);
    LitSizes::new(&device.limits(), shape, &view.film, lighting.mode, samples)
}

async fn new_frame(
    make: Make<'_>,
    passes: &LitPasses,
    lighting: &LightingData,
    scenes: LitScene<'_>,
) -> Result<LitFrame, GpuError> {
    let sizes = sizes_of(make.device, scenes, lighting);
    let records = tiles(&scenes.view.film, sizes.tile).map(scenes.records(make.device));
    let by = RecordedBy::Host { at_once: RECORDINGS };
    LitFrame::new(make, passes, sizes, lighting, by, records).await
}

/// The progress that a recording has made with a lit picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LitProgress {
    /// Number of samples that every pixel has when the recording has been executed. Some pixels may have more. If it is
    /// 0, the colours may be those of primary rays, or of the previous view.
    pub samples: u32,
    /// Number of samples that the picture will have.
    pub total: u32,
    /// Number of rays that the recorded commands trace at most.
    pub rays: u64,
    /// The state of the picture after this recording.
    pub state: LitState,
    /// Whether commands of an earlier recording were not executed, or not in order, so that the samples accumulate from
    /// the first one again.
    pub was_lost: bool,
}

/// The state of a lit picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LitState {
    /// More samples remain.
    Refining,
    /// All samples are recorded, and nothing remains to do until something changes.
    Done,
    /// The device has not finished earlier recordings, so nothing was recorded.
    Waiting,
}

/// The accumulated sums of a part of a picture.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct LitSums<'a> {
    /// First column and row of the part, in pixels.
    pub origin: [u32; 2],
    /// Width and height of the part, in pixels.
    pub size: [u32; 2],
    /// Buffer with three `vec4f` for each pixel, row by row: the sums of colour and opacity; the rounding errors of the
    /// sums of colour and of squared luminance; the sums of the first surfaces' albedos and of squared luminance. Its
    /// usages are `STORAGE` and `COPY_SRC`.
    pub buffer: &'a Buffer,
}
