//! Rendering lit pictures on the library's own device, in batches of samples.

use std::ops::Range;

use crate::camera::View;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::lit_flow::Flow;
use crate::gpu::headless::progress::{Decision, Picture, Progress, Watch};
use crate::gpu::passes::frame::iteration_limit;
use crate::gpu::passes::lit::sums;
use crate::gpu::passes::lit::{
    AT_ONCE, LightingData, LitFrame, LitKey, LitPasses, LitScene, LitSizes, RecordedBy, Round,
};
use crate::gpu::passes::tiles::tiles;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::image::outline;
use crate::image::{Image, Layer, LayerSet};
use crate::render::{PrimarySettings, RenderSettings, Totals, batch};

impl Headless {
    /// Renders a lit picture of a scene that is already on this device.
    pub(in crate::gpu) async fn render_lit(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, GpuError> {
        settings.check_with(scene.appearance())?;
        let scenes = LitScene { all: scene, occluders: scene.occluders(settings)? };
        let wanted = settings.layers_for(layers);
        let mut image = self.data_layers(scene, view, settings, wanted, watch).await?;
        let lighting = LightingData::new(settings, scene.summary(), view.camera);
        let key = scenes.key(view, &lighting, &self.device().limits());
        let steps = LitKey { one_pass: None, ..key };
        let key = if self.is_one_pass() { key } else { steps };
        let gathered = self.gather(key, scenes, view, settings, &lighting, &mut image, watch).await;
        let (samples, totals) = match gathered {
            // Several rays in one invocation need more steps than one ray.
            Err(GpuError::Steps) if key != steps => {
                self.gather(steps, scenes, view, settings, &lighting, &mut image, watch).await?
            }
            done => done?,
        };
        let image = self.finish_async(image, settings, layers).await?;
        let noise = totals.noise(samples);
        Ok(Picture { image, samples, noise, hits: Some(totals.opacity) })
    }

    /// Completes a picture like [`Headless::finish`], without blocking the thread.
    ///
    /// # Errors
    /// The same as for [`Headless::finish`].
    pub async fn finish_async(
        &self,
        mut image: Image,
        settings: &RenderSettings,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        if settings.is_denoised {
            let _phase = self.phase("denoise");
            image = self.denoise_async(&image).await?;
        }
        if let Some(lines) = settings.studio_parameters().and_then(|studio| studio.outline) {
            let _phase = self.phase("outline");
            outline::draw(&mut image, &lines);
        }
        image.keep(layers);
        Ok(image)
    }

    /// Takes all samples with the passes of a key, and writes their means to the image. Returns the number of samples
    /// that every pixel has.
    #[expect(clippy::too_many_arguments, reason = "they are those of one picture")]
    async fn gather(
        &self,
        key: LitKey,
        scenes: LitScene<'_>,
        view: &View<'_>,
        settings: &RenderSettings,
        lighting: &LightingData,
        image: &mut Image,
        watch: &mut Watch<'_>,
    ) -> Result<(u32, Totals), GpuError> {
        self.with_lit_passes(key, async |passes: &LitPasses| {
            let work =
                Work { headless: self, passes, scenes, view, settings, lighting, at_once: AT_ONCE };
            match work.gather(image, watch).await {
                // Several directions of ambient light in one invocation need more steps than one direction.
                Err(GpuError::Steps)
                    if key.one_pass.is_none() && lighting.parameters.occlusion_samples > 1 =>
                {
                    Work { at_once: 1, ..work }.gather(image, watch).await
                }
                done => done,
            }
        })
        .await
    }

    /// Renders the layers that are not averaged over samples, but belong to the ray through the centre of each pixel.
    async fn data_layers(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Image, GpuError> {
        if !layers.iter().any(Layer::is_of_one_ray) {
            return Ok(Image::new(view.film.width(), view.film.height(), layers)?);
        }
        // There is no sample yet, so the render cannot finish early.
        let total = settings.sampling.samples;
        let none = Progress { samples: 0, total, part: 0.0, noise: None };
        let watch = &mut |_: &Progress| match watch(&none) {
            Decision::Stop => Decision::Stop,
            _ => Decision::GoOn,
        };
        self.render_primary(scene, view, &PrimarySettings::default(), layers, watch).await
    }
}

/// The inputs of a lit picture.
struct Work<'a> {
    headless: &'a Headless,
    passes: &'a LitPasses,
    scenes: LitScene<'a>,
    view: &'a View<'a>,
    settings: &'a RenderSettings,
    lighting: &'a LightingData,
    /// Maximum number of directions of ambient light that one dispatch searches.
    at_once: u32,
}

impl Work<'_> {
    /// Takes samples until all are complete or the caller finishes the render, and writes their means to the image.
    /// Returns the number of samples that every pixel has.
    async fn gather(
        &self,
        image: &mut Image,
        watch: &mut Watch<'_>,
    ) -> Result<(u32, Totals), GpuError> {
        let Self { headless, passes, scenes, view, settings, lighting, .. } = *self;
        let (device, queue) = (headless.device(), headless.queue());
        let total = settings.sampling.samples;
        let sizes =
            LitSizes::new(&device.limits(), headless.shape(), &view.film, lighting.mode, total);
        let (region, limit) = (scenes.visible_region(view, settings), iteration_limit(device));
        let tiles = tiles(&view.film, sizes.tile);
        let records = tiles.map(|tile| (tile, scenes.frames(view, region, tile, limit)));
        let frame =
            LitFrame::new((device, queue), passes, sizes, lighting, RecordedBy::Headless, records)
                .await?;
        let mut flow = Flow::new(headless, &frame, passes, scenes.all);
        let mut progress = Progress { samples: 0, total, part: 0.0, noise: None };
        let mut wants_noise = false;
        while progress.samples < total {
            let first = progress.samples;
            let end = first + batch(first, total);
            let mut decision = Decision::GoOn;
            let go_on = &mut |part| {
                progress.part = part;
                decision = watch(&progress);
                matches!(decision, Decision::GoOn | Decision::MeasureNoise)
            };
            match self.batch(&frame, &mut flow, first..end, go_on).await {
                Err(GpuError::Stopped) if decision == Decision::Finish && first > 0 => {
                    flow.abandon().await?;
                    check_spent(&frame, &mut flow).await?;
                    break;
                }
                done => done?,
            }
            progress.samples = end;
            if wants_noise || decision == Decision::MeasureNoise {
                let [variance, light] = flow.variations(passes).await?;
                let pixels = view.film.pixel_count();
                progress.noise = Totals { opacity: 0.0, variance, light, pixels }.noise(end);
            }
            progress.part = f64::from(end) / f64::from(total);
            match watch(&progress) {
                Decision::GoOn => {}
                Decision::MeasureNoise => wants_noise = true,
                Decision::Finish => break,
                Decision::Stop => return Err(GpuError::Stopped),
            }
        }
        let mut totals = Totals::default();
        for (number, tile) in frame.tiles.iter().enumerate() {
            let samples = flow.samples[number];
            frame.record_copy_film(flow.encoder(), number);
            flow.finish(&[frame.film_back.buffer()]).await?;
            let _phase = headless.phase("read back");
            frame.film_back.read(|found| {
                totals.add(&sums::write(image, tile.tile, found, samples));
            })?;
        }
        // Some tiles have more samples than others if the render was finished within a batch.
        let every = flow.samples.iter().copied().min().unwrap_or(progress.samples);
        Ok((every, totals))
    }

    /// Takes some samples of every pixel. `go_on` is called with the completed fraction of all work, and decides
    /// whether to continue.
    async fn batch<'a>(
        &'a self,
        frame: &'a LitFrame,
        flow: &mut Flow<'a>,
        samples: Range<u32>,
        go_on: &mut dyn FnMut(f64) -> bool,
    ) -> Result<(), GpuError> {
        let Self { passes, scenes, lighting, at_once, .. } = *self;
        let room = frame.sizes.room();
        let round = Round {
            passes,
            lighting,
            scene: scenes.all,
            occluders: scenes.occluders,
            room,
            at_once,
        };
        let (total, tiles) = (f64::from(self.settings.sampling.samples), frame.tiles.len());
        let count = f64::from(samples.end - samples.start);
        for tile in 0..tiles {
            let mut start = samples.start;
            while start < samples.end {
                let end = samples.end.min(start + frame.sizes.in_flight);
                let in_tile = f64::from(start - samples.start) / count;
                let done = count * (tile as f64 + in_tile) / tiles as f64;
                let part = (f64::from(samples.start) + done) / total;
                let mut after = || match go_on(part) {
                    true => Ok(()),
                    false => Err(GpuError::Stopped),
                };
                flow.round(tile, &round.steps(start..end)?, &mut after).await?;
                start = end;
            }
        }
        check_spent(frame, flow).await
    }
}

/// Waits for all submitted work, and returns an error if the searches of some rays were abandoned.
async fn check_spent(frame: &LitFrame, flow: &mut Flow<'_>) -> Result<(), GpuError> {
    frame.record_copy_spent(flow.encoder());
    flow.finish(&[frame.spent_back.buffer()]).await?;
    frame.read_spent()
}
