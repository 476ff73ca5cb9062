//! Rendering lit pictures on the library's own device, in batches of samples.

use std::ops::Range;

use crate::camera::View;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::lit_flow::{Flow, LitWork};
use crate::gpu::headless::progress::{Decision, Picture, Progress, Watch};
use crate::gpu::passes::lit::{LitFrame, LitPasses, LitScene, LitSizes, SampleStrategy, sums};
use crate::gpu::passes::tiles::tiles;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::image::{Image, Layer, LayerSet, outline};
use crate::render::{PrimarySettings, RenderSettings, Totals, batch};

impl Headless {
    /// Renders a lit picture of a scene that is already on this device.
    pub(crate) async fn render_lit(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, GpuError> {
        let scenes = LitScene::new(scene, view, settings)?;
        let wanted = settings.layers_for(layers);
        let mut image = self.data_layers(scene, view, settings, wanted, watch).await?;
        let lighting = &scenes.lighting();
        let key = scenes.key(lighting, &self.device.limits());
        let is_one_pass = self.options.one_pass && key.one_pass.is_some();
        let mut strategy = if is_one_pass { SampleStrategy::OnePass } else { SampleStrategy::Steps };
        let (samples, totals) = loop {
            let gather = async |passes: &LitPasses| {
                let work = LitWork { headless: self, passes, scenes, lighting, strategy };
                work.gather(&mut image, watch).await
            };
            let gathered = self.with_lit_passes(strategy.key(key), gather).await;
            match (gathered, strategy.easier(lighting)) {
                (Err(GpuError::Steps), Some(easier)) => strategy = easier,
                (done, _) => break done?,
            }
        };
        let image = self.finish(image, settings, layers).await?;
        let noise = totals.noise(samples);
        Ok(Picture { image, samples, noise, hits: Some(totals.opacity), crowded: 0 })
    }

    /// Completes a picture that was rendered with [`RenderSettings::unfinished`] and has the layers
    /// [`RenderSettings::layers_for`]: removes noise and draws outlines, as `settings` ask for, and keeps `layers`. The
    /// result is that of [`Headless::render`] with `settings` on this device, to the bit.
    ///
    /// # Errors
    /// If noise is to be removed and the picture lacks a layer that guides it, or the device fails.
    pub async fn finish(
        &self,
        mut image: Image,
        settings: &RenderSettings,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        if settings.sampling.denoise {
            let _phase = self.phase("denoise");
            image = self.denoise(&image).await?;
        }
        if let Some(lines) = settings.studio_parameters().and_then(|studio| studio.outline) {
            let _phase = self.phase("outline");
            outline::draw(&mut image, &lines);
        }
        image.keep(layers);
        Ok(image)
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
        let primary = layers.contains(Layer::Normal).then(PrimarySettings::default);
        self.render_primary(scene, view, primary.as_ref(), layers, watch).await
    }
}

impl LitWork<'_> {
    /// Takes samples until all are complete or the caller finishes the render, and writes their means to the image.
    /// Returns the number of samples that every pixel has.
    async fn gather(&self, image: &mut Image, watch: &mut Watch<'_>) -> Result<(u32, Totals), GpuError> {
        let Self { headless, passes, scenes, lighting, .. } = *self;
        let (film, total) = (&scenes.view.film, scenes.settings.sampling.samples);
        let limits = headless.device.limits();
        let sizes = LitSizes::new(&limits, headless.shape(), film, lighting.mode, total);
        let frame = self.frame(sizes, tiles(film, sizes.tile)).await?;
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
                    flow.check_spent().await?;
                    break;
                }
                done => done?,
            }
            progress.samples = end;
            if wants_noise || decision == Decision::MeasureNoise {
                let [variance, light] = flow.variations(passes).await?;
                let pixels = film.pixel_count();
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
            flow.finish(&[&frame.film_back.buffer]).await?;
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
        let round = self.round(frame);
        let total = f64::from(self.scenes.settings.sampling.samples);
        let (tiles, count) = (frame.tiles.len(), f64::from(samples.end - samples.start));
        for tile in 0..tiles {
            for start in samples.clone().step_by(frame.sizes.in_flight as usize) {
                let end = samples.end.min(start + frame.sizes.in_flight);
                let in_tile = f64::from(start - samples.start) / count;
                let done = count * (tile as f64 + in_tile) / tiles as f64;
                let part = (f64::from(samples.start) + done) / total;
                let mut after = || match go_on(part) {
                    true => Ok(()),
                    false => Err(GpuError::Stopped),
                };
                flow.begin(tile);
                for step in round.steps(start..end)? {
                    flow.step(&step, &mut after).await?;
                }
            }
        }
        flow.check_spent().await
    }
}
