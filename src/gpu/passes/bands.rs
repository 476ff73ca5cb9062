//! Dividing pictures of primary rays into bands of rows, and the sizes of the buffers that a band needs.
//! Both plans and frames use these sizes.

use wgpu::Limits;

use crate::accel::PlannedBuffer;
use crate::camera::film::Film;
use crate::gpu::device_shape::DeviceShape;
use crate::gpu::passes::tiles;
use crate::gpu::scene::scene_buffers::binding_limit;
use crate::gpu::shader::records;

const HIT_BYTES: u64 = size_of::<records::Hit>() as u64;
const RAY_BYTES: u64 = size_of::<records::RecordedRays>() as u64;

/// Sizes in bytes of the buffers for a band of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BandBuffers {
    pub(crate) hits: u64,
    /// Size of the buffer of rays; `None` if rays are not kept.
    pub(crate) rays: Option<u64>,
}

impl BandBuffers {
    /// The sizes for a band of targets with `size` pixels.
    pub(crate) fn new(limits: &Limits, size: [u32; 2], keeps_rays: bool) -> Self {
        let pixels = u64::from(size[0]) * u64::from(rows_per_band(limits, size, keeps_rays));
        Self { hits: pixels * HIT_BYTES, rays: keeps_rays.then_some(pixels * RAY_BYTES) }
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.hits + self.rays.unwrap_or(0)
    }

    /// The buffers that kernels write.
    pub(crate) fn planned(&self) -> Vec<PlannedBuffer> {
        let rays = self.rays.map(|bytes| PlannedBuffer::one("rays", bytes));
        [PlannedBuffer::one("hits", self.hits)].into_iter().chain(rays).collect()
    }

    /// The buffers through which the host reads hits and rays, if rays are kept.
    pub(crate) fn planned_read_back(&self) -> Vec<PlannedBuffer> {
        let both = self.rays.map(|rays| [("hits read-back", self.hits), ("rays read-back", rays)]);
        both.into_iter().flatten().map(|(name, bytes)| PlannedBuffer::one(name, bytes)).collect()
    }
}

/// Number of rows that are traced before they are shaded. Their hits, and their rays if they are kept, each fit into
/// one binding.
pub(crate) fn rows_per_band(limits: &Limits, [width, height]: [u32; 2], keeps_rays: bool) -> u32 {
    let largest = if keeps_rays { RAY_BYTES } else { HIT_BYTES };
    let pixels_per_band = (binding_limit(limits) / largest).min(tiles::MAX_BAND_PIXELS);
    // Not more than MAX_BAND_PIXELS, so it fits into u32.
    ((pixels_per_band / u64::from(width)).max(1) as u32).min(height)
}

/// Size of the tiles of a headless render. A tile is not larger than a band, because a frame keeps the hits and rays of its
/// last band only.
pub(crate) fn tile_size(limits: &Limits, shape: DeviceShape, film: &Film, keeps_rays: bool) -> [u32; 2] {
    let side_limit = limits.max_texture_dimension_2d;
    let [width, height] = tiles::tile_size(film, shape.max_tile_pixels, side_limit);
    [width, rows_per_band(limits, [width, height], keeps_rays)]
}
