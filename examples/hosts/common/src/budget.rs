//! Limits the rays that a lit picture may trace in a frame, so that the window stays responsive.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use pinhole::gpu::{GpuError, LitPicture, LitProgress, LitRenderer, SceneBuffers, wgpu};

/// The number of rays of a frame. It follows the device: it doubles if a frame takes less than half of the wanted time,
/// and halves if a frame takes more than twice this time.
#[derive(Debug)]
pub struct Budget {
    rays: u64,
    wanted: Duration,
    /// Rays and nanoseconds of the last frame that the device has finished; 0 after they were read.
    done: Arc<[AtomicU64; 2]>,
}

impl Budget {
    /// A budget for frames that take `wanted`.
    pub fn new(wanted: Duration) -> Self {
        Self { rays: 500_000, wanted, done: Arc::default() }
    }

    /// Records the next part of a lit picture. Returns `None` if it must be tried again in the next frame.
    pub fn record(
        &mut self,
        picture: &mut LitPicture,
        renderer: &LitRenderer,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneBuffers,
    ) -> Result<Option<LitProgress>, GpuError> {
        match picture.record(renderer, queue, encoder, scene, self.rays()) {
            Ok(progress) => {
                self.watch(encoder, progress.rays);
                Ok(Some(progress))
            }
            // The smallest part of the picture needs this number.
            Err(GpuError::Budget { needed, .. }) => {
                self.rays = self.rays.max(needed);
                Ok(None)
            }
            // The next `set` chooses passes with fewer iterations.
            Err(GpuError::Steps) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// The number of rays that the next frame may trace.
    fn rays(&mut self) -> u64 {
        let [rays, nanoseconds] = self.done.each_ref().map(|value| value.swap(0, Ordering::AcqRel));
        if rays > 0 {
            let took = Duration::from_nanos(nanoseconds);
            if took < self.wanted / 2 && rays > self.rays / 2 {
                self.rays = self.rays.saturating_mul(2);
            } else if took > self.wanted * 2 {
                self.rays = (self.rays / 2).max(100_000);
            }
        }
        self.rays
    }

    /// Measures the time that the device takes for rays that were recorded into this encoder, from now until
    /// they are traced.
    fn watch(&self, encoder: &wgpu::CommandEncoder, rays: u64) {
        if rays > 0 {
            let (begin, done) = (Instant::now(), Arc::clone(&self.done));
            encoder.on_submitted_work_done(move || {
                let nanoseconds = u64::try_from(begin.elapsed().as_nanos()).unwrap_or(u64::MAX);
                done[1].store(nanoseconds, Ordering::Release);
                done[0].store(rays, Ordering::Release);
            });
        }
    }
}
