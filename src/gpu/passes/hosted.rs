//! Recording lit pictures into the encoder of another application.
//!
//! The passes are the same as those that [`Headless`](crate::gpu::Headless) submits and reads back, but here the
//! application submits them, for example a few samples with each frame of its own.

use std::ops::Range;

use wgpu::{Buffer, CommandEncoder, Device, Queue};

use crate::camera::View;
use crate::gpu::error::GpuError;
use crate::gpu::passes::frame::iteration_limit;
use crate::gpu::passes::lit::{
    AT_ONCE, LightingData, LitFrame, LitPasses, LitScene, LitSizes, MAX_DISPATCHES, Recorder, Round,
};
use crate::gpu::passes::tiles::tiles;
use crate::gpu::scene::scene_buffers::SceneBuffers;
#[cfg(not(target_arch = "wasm32"))]
use crate::gpu::waiting::block_on;
use crate::render::RenderSettings;

/// A lit picture that accumulates samples, on a device that the caller owns.
#[derive(Debug)]
pub struct HostedPicture {
    passes: LitPasses,
    frame: LitFrame,
    lighting: LightingData,
    is_indirect: bool,
}

/// The accumulated sums of a part of a picture.
#[derive(Clone, Copy, Debug)]
pub struct HostedSums<'a> {
    /// First column and row of the part, in pixels.
    pub origin: [u32; 2],
    /// Width and height of the part, in pixels.
    pub size: [u32; 2],
    /// Buffer with three `vec4f` for each pixel, row by row: the sums of colour and opacity, the rounding errors of the
    /// sums of colour, and the sums of the first surfaces' albedos. Its usages are `STORAGE` and `COPY_SRC`.
    pub buffer: &'a Buffer,
}

impl HostedPicture {
    /// Creates the passes and the buffers. `is_indirect` says whether the adapter supports indirect dispatches
    /// (`DownlevelFlags::INDIRECT_EXECUTION`); the picture does not depend on it.
    ///
    /// # Errors
    /// The errors of [`RenderSettings::check`]; [`GpuError::NoOccluders`]; an error if the device has no memory left.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn new(
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        is_indirect: bool,
    ) -> Result<Self, GpuError> {
        block_on(Self::new_async(device, queue, scene, view, settings, is_indirect))
    }

    /// Creates the passes and the buffers like [`HostedPicture::new`], without blocking the thread while a browser
    /// answers.
    ///
    /// # Errors
    /// The same as for [`HostedPicture::new`].
    pub async fn new_async(
        device: &Device,
        queue: &Queue,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        is_indirect: bool,
    ) -> Result<Self, GpuError> {
        settings.check_with(scene.appearance())?;
        let scenes = LitScene { all: scene, occluders: scene.occluders(settings)? };
        let lighting = LightingData::new(settings, scene.summary(), view.camera);
        let key = scenes.key(view, &lighting, &device.limits());
        let passes = LitPasses::new(device, key, &[]).await?;
        let samples = settings.sampling.samples;
        let sizes = LitSizes::new(&device.limits(), &view.film, lighting.mode, samples);
        let (region, limit) = (scenes.visible_region(view, settings), iteration_limit(device));
        let records = tiles(&view.film, sizes.tile)
            .map(|tile| (tile, scenes.frames(view, region, tile, limit)));
        let frame = LitFrame::new(device, queue, &passes, sizes, &lighting, records).await?;
        Ok(Self { passes, frame, lighting, is_indirect })
    }

    /// Records some samples of every pixel. The parameters of the passes are queued on `queue` for its next submission,
    /// which must be that of this encoder.
    ///
    /// # Errors
    /// [`GpuError::Limit`] if the samples need more dispatches than one submission may have; record fewer samples then.
    pub fn record(
        &self,
        queue: &Queue,
        encoder: &mut CommandEncoder,
        scene: &SceneBuffers,
        settings: &RenderSettings,
        samples: Range<u32>,
    ) -> Result<(), GpuError> {
        let Self { passes, frame, lighting, is_indirect } = self;
        let occluders = scene.occluders(settings)?;
        let room = frame.sizes.room();
        let round = Round { passes, lighting, scene, occluders, room, at_once: AT_ONCE };
        let mut recorder = Recorder::new(frame, passes.advance(), *is_indirect);
        for tile in 0..frame.tiles.len() {
            recorder.tile = tile;
            let mut start = samples.start;
            while start < samples.end {
                let end = samples.end.min(start + frame.sizes.in_flight);
                let steps = round.steps(start..end)?;
                let needed = recorder.dispatches() + steps.len();
                if needed > MAX_DISPATCHES {
                    return Err(GpuError::Limit {
                        what: "one recording of lit samples",
                        needed: needed as u64,
                        limit_name: "dispatches of one submission",
                        limit: MAX_DISPATCHES as u64,
                    });
                }
                frame.record_clear_lists(encoder);
                for step in &steps {
                    recorder.record(encoder, step, None);
                }
                start = end;
            }
        }
        frame.queue_parameters(queue, &recorder.take_parameters());
        Ok(())
    }

    /// Returns the sums of every part of the picture.
    pub fn sums(&self) -> impl Iterator<Item = HostedSums<'_>> {
        self.frame.tiles.iter().map(|tile| HostedSums {
            origin: tile.tile.origin,
            size: tile.tile.size,
            buffer: tile.film(),
        })
    }
}
