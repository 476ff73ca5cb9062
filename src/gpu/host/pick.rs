//! Picking: the sphere at a pixel, read back without waiting.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use wgpu::{Buffer, BufferUsages, CommandEncoder, Device};

use crate::camera::View;
use crate::geometry::ray::Ray;
use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::passes::targets::Targets;
use crate::gpu::resources::buffer;
use crate::image::NO_ID;
use crate::recording::NO_HIT;

/// A ring of small buffers into which the id and depth of a pixel are copied. The result arrives some frames later.
#[derive(Debug)]
pub struct Picker {
    slots: Vec<Slot>,
    /// The slot of the next request, and the slot of the oldest request whose result was not taken.
    next: usize,
    oldest: usize,
}

/// The content of a pixel of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedPixel {
    /// Column and row of the pixel.
    pub pixel: [u32; 2],
    /// The sphere whose surface is nearest at the centre of the pixel; `None` for a miss.
    pub hit: Option<PickedHit>,
}

/// A sphere at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedHit {
    /// Index of the sphere in input order.
    pub id: u32,
    /// Distance along the ray, in scene units, in the precision of the depth layer.
    pub distance: f32,
    /// The point on the sphere in world space.
    pub place: DVec3,
}

/// Why a pixel cannot be picked, or a pick failed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PickError {
    /// The pixel is not in the picture.
    #[error("there is no pixel {pixel:?} in a picture of {}x{}", size[0], size[1])]
    Outside {
        /// Column and row that were asked for.
        pixel: [u32; 2],
        /// Size of the picture.
        size: [u32; 2],
    },
    /// The film of the view has another size than the targets.
    #[error("the film is {}x{} pixels large, and the targets {}x{}", film[0], film[1], size[0], size[1])]
    OtherFilm {
        /// Size of the film.
        film: [u32; 2],
        /// Size of the targets.
        size: [u32; 2],
    },
    /// The frame has no data layers.
    #[error("the targets have no data layers; build the renderer with `data_layers`")]
    NoDataLayers,
    /// A texture cannot be copied from.
    #[error("the texture of the layer {layer} lacks the usage COPY_SRC")]
    Usage {
        /// The layer.
        layer: &'static str,
    },
    /// All buffers wait for results.
    #[error("all {capacity} buffers wait for results; take them, or make a larger ring")]
    Full {
        /// Number of buffers.
        capacity: usize,
    },
    /// The encoder was dropped without a submission, or the device was lost.
    #[error("the pick of pixel {pixel:?} has no result: its commands were not executed")]
    Lost {
        /// The pixel.
        pixel: [u32; 2],
    },
}

#[derive(Debug)]
struct Slot {
    buffer: Buffer,
    /// Set when the commands were executed, by a callback that shares it until it is called or dropped.
    executed: Arc<OnceLock<()>>,
    /// The pixel and its ray, until the result is taken.
    asked: Option<([u32; 2], Option<Ray>)>,
}

impl Picker {
    /// Creates a ring of `capacity` buffers, at least one, for as many picks at a time. One pick per frame needs three.
    ///
    /// # Errors
    /// If the device has no memory left.
    pub async fn new(device: &Device, capacity: usize) -> Result<Self, GpuError> {
        let slots = scoped(device, || {
            let slot = |_| Slot {
                buffer: buffer(device, "pinhole pick", 8, BufferUsages::MAP_READ),
                executed: Arc::default(),
                asked: None,
            };
            (0..capacity.max(1)).map(slot).collect()
        })
        .await?;
        Ok(Self { slots, next: 0, oldest: 0 })
    }

    /// Records copies of the id and depth at a pixel, given as column and row, into the encoder, after the frame was
    /// recorded there or submitted before. `view` must be that of the frame.
    ///
    /// # Errors
    /// The errors of [`PickError`] except [`PickError::Lost`]; nothing is recorded then.
    pub fn record(
        &mut self,
        encoder: &mut CommandEncoder,
        targets: &Targets<'_>,
        view: &View<'_>,
        pixel: [u32; 2],
    ) -> Result<(), PickError> {
        let data = targets.data.ok_or(PickError::NoDataLayers)?;
        let size = [data.id.texture().width(), data.id.texture().height()];
        let film = [view.film.width(), view.film.height()];
        if film != size {
            return Err(PickError::OtherFilm { film, size });
        }
        if pixel[0] >= size[0] || pixel[1] >= size[1] {
            return Err(PickError::Outside { pixel, size });
        }
        let layers = [("id", data.id.texture()), ("depth", data.depth.texture())];
        for (layer, texture) in layers {
            if !texture.usage().contains(wgpu::TextureUsages::COPY_SRC) {
                return Err(PickError::Usage { layer });
            }
        }
        let capacity = self.slots.len();
        let slot = &mut self.slots[self.next];
        if slot.asked.is_some() {
            return Err(PickError::Full { capacity });
        }
        for ((_, texture), offset) in layers.into_iter().zip([0, 4]) {
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo {
                    origin: wgpu::Origin3d { x: pixel[0], y: pixel[1], z: 0 },
                    ..texture.as_image_copy()
                },
                wgpu::TexelCopyBufferInfo {
                    buffer: &slot.buffer,
                    layout: wgpu::TexelCopyBufferLayout { offset, ..Default::default() },
                },
                wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
            );
        }
        let executed = Arc::clone(&slot.executed);
        encoder.map_buffer_on_submit(&slot.buffer, wgpu::MapMode::Read, .., move |mapped| {
            if mapped.is_ok() {
                let _ = executed.set(());
            }
        });
        slot.asked = Some((pixel, view.ray_through_center(pixel)));
        self.next = (self.next + 1) % capacity;
        Ok(())
    }

    /// Takes the oldest result, if it has arrived. This never waits. Results arrive when the program submits to its
    /// device or polls it, after the device has executed the copies.
    ///
    /// # Errors
    /// [`PickError::Lost`], once for each pick whose commands were not executed.
    pub fn take(&mut self) -> Result<Option<PickedPixel>, PickError> {
        let capacity = self.slots.len();
        let slot = &mut self.slots[self.oldest];
        let Some((pixel, ray)) = slot.asked else { return Ok(None) };
        let Some(executed) = Arc::get_mut(&mut slot.executed) else { return Ok(None) };
        slot.asked = None;
        self.oldest = (self.oldest + 1) % capacity;
        executed.take().ok_or(PickError::Lost { pixel })?;
        let words = slot.buffer.get_mapped_range(..).map(|bytes| {
            let word = |at: usize| u32::from_ne_bytes([0, 1, 2, 3].map(|i| bytes[at + i]));
            [word(0), word(4)]
        });
        slot.buffer.unmap();
        let [id, depth] = words.map_err(|_| PickError::Lost { pixel })?;
        let distance = f32::from_bits(depth);
        let hit = ray.filter(|_| id != NO_ID && distance < NO_HIT).map(|ray| PickedHit {
            id,
            distance,
            place: ray.at(f64::from(distance)),
        });
        Ok(Some(PickedPixel { pixel, hit }))
    }
}
