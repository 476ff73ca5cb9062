//! Measuring how long tracing takes.

use std::time::Duration;

use crate::camera::View;
use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::primary::begin_pass;
use crate::gpu::headless::renderers::RendererKey;
use crate::gpu::headless::tile_textures::TileTextures;
use crate::gpu::headless::timer::TraceTime;
use crate::gpu::passes::bands::tile_size;
use crate::gpu::passes::frame::{BandBrick, Frame};
use crate::gpu::passes::pass_times::{PassTimes, Stamps};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::tiles::{Groups, tiles};
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::render::PrimarySettings;

impl Headless {
    /// Measures like [`Headless::measure`], without blocking the thread.
    ///
    /// # Errors
    /// The same as for [`Headless::render_async`].
    pub async fn measure_async(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
    ) -> Result<TraceTime, GpuError> {
        let key = RendererKey::new(scene, view.camera);
        self.with_renderer(key, async |renderer: &Renderer| {
            self.measure_with(renderer, scene, view).await
        })
        .await
    }

    async fn measure_with(
        &self,
        renderer: &Renderer,
        scene: &SceneBuffers,
        view: &View<'_>,
    ) -> Result<TraceTime, GpuError> {
        let tile_size =
            tile_size(&self.device().limits(), self.shape(), &view.film, renderer.keeps_rays);
        let textures =
            scoped(self.device(), || TileTextures::new(self.device(), tile_size, false)).await?;
        let mut frame = Frame::new_async(renderer, self.device(), &textures.targets()).await?;
        let has_clock = self.device().features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let stamps = scoped(self.device(), || has_clock.then(|| Stamps::new(self.device())));
        let mut stamps = stamps.await?;
        let nanoseconds_per_tick = Stamps::nanoseconds_per_tick(self.queue());
        // wgpu clears a buffer when it is first used; this must not be measured.
        let mut encoder = self.encoder();
        frame.record_clear(&mut encoder);
        self.run(encoder, &[]).await?;
        let mut time = TraceTime::default();
        for tile in tiles(&view.film, tile_size) {
            frame.set_tile(self.queue(), scene, view, tile, &PrimarySettings::default());
            for part in frame.parts().collect::<Vec<_>>() {
                let mut left = vec![part.groups];
                while let Some(groups) = Groups::take(&mut left, scene.submission_size().groups()) {
                    frame.set_first_group(self.queue(), part.slot, groups.first);
                    let (mut encoder, mut times) = (self.encoder(), PassTimes::new(stamps.take()));
                    let mut pass = begin_pass(&mut encoder, &mut times, "trace");
                    let slice = BandBrick { groups, ..part };
                    renderer.record_trace(&mut pass, scene, &frame, slice)?;
                    drop(pass);
                    times.record_copy(&mut encoder);
                    let mapped = times.buffer();
                    let unnoted = PassTimes::default();
                    let elapsed = self
                        .submit_slice(encoder, unnoted, groups, scene, mapped.as_slice())
                        .await?;
                    let device = times.ticks()?.first().map(|[start, end]| {
                        let ticks = end.saturating_sub(*start) as f64;
                        Duration::from_nanos((ticks * nanoseconds_per_tick) as u64)
                    });
                    stamps = times.into_stamps();
                    time.pixels += groups.pixels();
                    time.add(elapsed, device);
                }
            }
        }
        let mut encoder = self.encoder();
        textures.status().record_copy(&mut encoder, frame.status());
        self.run(encoder, &[textures.status().buffer()]).await?;
        textures.check_steps()?;
        Ok(time)
    }
}
