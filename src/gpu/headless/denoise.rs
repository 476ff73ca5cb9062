//! Denoising a picture on a device, in strips that fit into a binding.

use bytemuck::{Pod, Zeroable};
use wgpu::{Buffer, BufferUsages};

use crate::gpu::checks::Checks;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::primary::begin_pass;
use crate::gpu::headless::readback::ReadableBuffer;
use crate::gpu::profile::NotedPass;
use crate::gpu::resources::{buffer, numbered_group};
use crate::gpu::scene::scene_buffers::binding_limit;
use crate::gpu::shader::layouts::{layout, storage, uniform};
use crate::gpu::shader::{Kernel, pipeline};
use crate::image::Image;
use crate::image::denoise::{Guides, PASSES, REACH};

/// Uniform record of one pass of the denoiser.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Denoise {
    pub(crate) size: [u32; 2],
    pub(crate) step: u32,
    pub(crate) zero: u32,
}

/// Maximum number of pixels of a strip, which is filtered at once.
const MAX_STRIP_PIXELS: u64 = 1 << 21;

pub(crate) fn denoise_kernel() -> Kernel {
    Kernel::new("denoise", &[])
}

impl Headless {
    /// Returns a picture with less noise: light is averaged over pixels of similar shape and colour, in five passes.
    ///
    /// # Errors
    /// If the picture lacks one of the layers in [`crate::image::denoise::GUIDES`], or if the device fails.
    pub async fn denoise(&self, image: &Image) -> Result<Image, GpuError> {
        let guides = Guides::of(image)?;
        let (width, height) = (image.width() as usize, image.height() as usize);
        let max_pixels = MAX_STRIP_PIXELS.min(binding_limit(&self.device().limits()) / 16);
        let reach = REACH as usize;
        let rows = (max_pixels as usize / width).saturating_sub(2 * reach).max(1);
        let mut lights = Vec::new();
        lights.reserve_exact(guides.lights.len());
        for start in (0..height).step_by(rows) {
            let end = (start + rows).min(height);
            let (first, last) = (start.saturating_sub(reach), (end + reach).min(height));
            let strip = self.denoised_strip(&guides, width, first..last).await?;
            lights.extend_from_slice(&strip[(start - first) * width..(end - first) * width]);
        }
        let mut denoised = image.clone();
        denoised.color_mut().copy_from_slice(&guides.colors(lights.into_iter()));
        Ok(denoised)
    }

    /// The light of some rows, filtered with the pixels of these rows only.
    async fn denoised_strip(
        &self,
        guides: &Guides,
        width: usize,
        rows: std::ops::Range<usize>,
    ) -> Result<Vec<[f32; 4]>, GpuError> {
        let (device, queue) = (self.device(), self.queue());
        let pixels = rows.start * width..rows.end * width;
        let bytes = 16 * pixels.len() as u64;
        // These are the width and a part of the height of a film, so they fit into u32.
        let size = [width as u32, rows.len() as u32];
        let kernel = denoise_kernel().edited(&self.edits)?;
        let phase = self.phase("create pipelines");
        let checks = Checks::default();
        let (filter, passes, result, back) = checks.create(device, || {
            let [read, written] = [true, false].map(storage::<[f32; 4]>);
            let kinds = [uniform::<Denoise>(), read, read, read, written];
            let layout = layout(device, "pinhole denoise", &kinds);
            let filter = pipeline(device, &kernel, &[&layout], &checks);
            let created = |size, usage| buffer(device, "pinhole denoise", size, usage | BufferUsages::COPY_SRC);
            let [front, back, shapes, albedos] = [(); 4].map(|()| created(bytes, BufferUsages::STORAGE));
            for (target, contents) in [(&front, &guides.lights), (&shapes, &guides.shapes), (&albedos, &guides.albedos)]
            {
                queue.write_buffer(target, 0, bytemuck::cast_slice(&contents[pixels.clone()]));
            }
            let passes: Vec<_> = (0..PASSES)
                .map(|pass| {
                    let record = created(size_of::<Denoise>() as u64, BufferUsages::UNIFORM);
                    let step = 1 << pass;
                    let contents = Denoise { size, step, zero: 0 };
                    queue.write_buffer(&record, 0, bytemuck::bytes_of(&contents));
                    let (from, to) = if pass & 1 == 0 { (&front, &back) } else { (&back, &front) };
                    let buffers = [&record, from, &shapes, &albedos, to];
                    let buffers = buffers.map(Buffer::as_entire_binding);
                    numbered_group(device, "pinhole denoise", &layout, buffers)
                })
                .collect();
            let result = if PASSES & 1 == 0 { front.clone() } else { back.clone() };
            let read = ReadableBuffer::new(device, "pinhole denoise read-back", bytes);
            (filter, passes, result, read)
        });
        checks.passed().await?;
        drop(phase);
        let (mut encoder, mut noted) = (self.encoder(), NotedPass::default());
        for group in &passes {
            let mut pass = begin_pass(&mut encoder, &mut noted, "denoise");
            pass.set_pipeline(&filter);
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups(size[0].div_ceil(8), size[1].div_ceil(8), 1);
        }
        back.record_copy(&mut encoder, &result);
        self.run_timed(encoder, noted, &[&back.buffer]).await?;
        back.read(|lights: &[[f32; 4]]| lights.to_vec())
    }
}
