//! Measuring how long tracing takes.

use std::time::Duration;

use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePassTimestampWrites, Device, QuerySet};

use crate::camera::View;
use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::readback::{ReadBack, ReadableBuffer, TileTextures};
use crate::gpu::passes::bands::tile_size;
use crate::gpu::passes::frame::{BandBrick, Frame};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::tiles::{Groups, tiles};
use crate::gpu::profile::NotedPass;
use crate::gpu::resources::buffer;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::render::PrimarySettings;

/// The time that tracing took, summed over all submissions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TraceTime {
    /// Time from submission to the end of the wait, by the host's clock.
    pub wall: Duration,
    /// Time from the start to the end of the compute passes, by the device's clock; `None` if the device has none.
    pub device: Option<Duration>,
    /// Time of the longest submission, by the host's clock.
    pub longest: Duration,
    /// Number of submissions.
    pub submissions: u32,
    /// Number of traced pixels, in whole workgroups, counted once for every brick. Only pixels in which the scene's box
    /// may be visible are traced.
    pub pixels: u64,
}

impl TraceTime {
    fn add(&mut self, wall: Duration, device: Option<Duration>) {
        self.wall += wall;
        self.device = device.map(|device| self.device.unwrap_or_default() + device);
        self.longest = self.longest.max(wall);
        self.submissions += 1;
    }
}

/// When a pass began and ended by the device's clock. It needs the feature `TIMESTAMP_QUERY`.
struct Stamps {
    queries: QuerySet,
    resolved: Buffer,
    readable: ReadableBuffer,
    nanoseconds_per_tick: f64,
}

impl Stamps {
    fn new(device: &Device, nanoseconds_per_tick: f64) -> Self {
        let label = "pinhole pass times";
        Self {
            queries: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some(label),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: buffer(device, label, 16, BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            readable: ReadableBuffer::new(device, label, 16),
            nanoseconds_per_tick,
        }
    }

    fn writes(&self) -> ComputePassTimestampWrites<'_> {
        ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    fn record_copy(&self, encoder: &mut CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, 0);
        self.readable.record_copy(encoder, &self.resolved);
    }

    /// The time of the pass. The copy of its time stamps must be mapped.
    fn elapsed(&self) -> Result<Duration, GpuError> {
        let ticks = self.readable.read(|ticks: &[u64]| ticks[1].saturating_sub(ticks[0]))?;
        Ok(Duration::from_nanos((ticks as f64 * self.nanoseconds_per_tick) as u64))
    }
}

impl Headless {
    /// Traces a ray through the centre of every pixel and discards the hits, to measure the time that this takes.
    ///
    /// # Errors
    /// Returns the errors of [`Headless::render`].
    pub async fn measure(&self, scene: &SceneBuffers, view: &View<'_>) -> Result<TraceTime, GpuError> {
        let options = self.options_for(scene, view.camera);
        self.with_renderer(options, async |renderer: &Renderer| {
            let (device, queue) = (&self.device, &self.queue);
            let tile_size = tile_size(&device.limits(), self.shape(), &view.film, renderer.keeps_rays);
            let textures = scoped(device, || TileTextures::new(device, tile_size, ReadBack::Color)).await?;
            let mut frame = Frame::new(renderer, device, &textures.targets()).await?;
            let has_clock = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
            let period = f64::from(queue.get_timestamp_period());
            let stamps = scoped(device, || has_clock.then(|| Stamps::new(device, period))).await?;
            // wgpu clears a buffer when it is first used. This must not be measured.
            let mut encoder = self.encoder();
            frame.record_clear(&mut encoder);
            self.run(encoder, &[]).await?;
            let mut time = TraceTime::default();
            for tile in tiles(&view.film, tile_size) {
                frame.set_tile(queue, scene, view, tile, &PrimarySettings::default());
                for part in frame.parts().collect::<Vec<_>>() {
                    let mut left = vec![part.groups];
                    while let Some(groups) = Groups::take(&mut left, scene.submission_size().groups()) {
                        frame.set_first_group(queue, part.slot, groups.first);
                        let mut encoder = self.encoder();
                        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                            label: None,
                            timestamp_writes: stamps.as_ref().map(Stamps::writes),
                        });
                        let slice = BandBrick { groups, ..part };
                        renderer.record_trace(&mut pass, scene, &frame, slice)?;
                        drop(pass);
                        stamps.iter().for_each(|stamps| stamps.record_copy(&mut encoder));
                        let mapped: Vec<_> = stamps.iter().map(|stamps| &stamps.readable.buffer).collect();
                        let unnoted = NotedPass::default();
                        let elapsed = self.submit_slice(encoder, unnoted, groups, scene, &mapped).await?;
                        time.pixels += groups.pixels();
                        time.add(elapsed, stamps.as_ref().map(Stamps::elapsed).transpose()?);
                    }
                }
            }
            let mut encoder = self.encoder();
            textures.status.record_copy(&mut encoder, frame.status());
            self.run(encoder, &[&textures.status.buffer]).await?;
            textures.check_steps()?;
            Ok(time)
        })
        .await
    }
}
