//! The sizes of the buffers of a lit picture, which both the plan and the allocation use.

use wgpu::Limits;

use super::kernels::{Materials, Mode, Sources};
use super::records::{
    COMMON_SLOTS, FILM_SLOTS, LIGHT_SLOTS, LISTS, MEDIUM_SLOTS, PIXELS_PER_VARIATION, QUEUE_HEAD,
    STUDIO_SLOTS,
};
use crate::camera::film::Film;
use crate::gpu::device_shape::DeviceShape;
use crate::gpu::passes::tiles::WORKGROUP_SIDE;

/// Number of samples of a pixel that are traced together, if not fewer are left. Each of them then costs less, because
/// the sums are read and written once for all of them. Tiles become smaller in return.
const TOGETHER: u32 = 4;

/// Maximum number of workgroups in a row, which every WebGPU device allows. Without indirect dispatches, a dispatch over
/// a list has one for every workgroup of a tile and each sample in flight.
const MAX_GROUPS: u64 = 65_535;

/// Sizes of the buffers that all tiles share, and of those of each tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gpu) struct LitSizes {
    /// Maximum width and height of a tile in pixels.
    pub(in crate::gpu) tile: [u32; 2],
    /// Number of samples of every pixel of a tile that are traced together.
    pub(in crate::gpu) in_flight: u32,
    /// Number of `vec4f` in the state of a path.
    slots: u64,
}

impl LitSizes {
    /// The sizes for a film with at most `samples` samples of every pixel.
    pub(in crate::gpu) fn new(
        limits: &Limits,
        shape: DeviceShape,
        film: &Film,
        mode: Mode,
        samples: u32,
    ) -> Self {
        let slots = slots(mode);
        let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let of_path = 16 * slots.max(FILM_SLOTS);
        let max_paths = (binding / of_path).clamp(64, shape.max_paths);
        let max_pixels = (max_paths / u64::from(samples.clamp(1, TOGETHER))).max(64);
        let width = u64::from(film.width()).min((max_pixels / 8).max(8));
        let rows = (max_pixels / width).max(1);
        let side = u64::from(WORKGROUP_SIDE);
        let rows = if rows > side { rows / side * side } else { rows };
        // The tile is not larger than the film, so its sides fit into u32.
        let tile = [width as u32, rows.min(film.height().into()) as u32];
        let pixels = u64::from(tile[0]) * u64::from(tile[1]);
        let groups = tile.map(|side| u64::from(side.div_ceil(WORKGROUP_SIDE)));
        let max_layers = (MAX_GROUPS / (groups[0] * groups[1])).max(1);
        let in_flight = (max_paths / pixels).clamp(1, samples.max(1).into()).min(max_layers);
        // There are not more than `samples`, so it fits into u32.
        Self { tile, in_flight: in_flight as u32, slots }
    }

    /// The sizes for a single rectangle and one sample at a time.
    pub(in crate::gpu) fn of_one_sample(tile: [u32; 2], mode: Mode) -> Self {
        Self { tile, in_flight: 1, slots: slots(mode) }
    }

    /// Number of paths that the buffers have room for.
    pub(in crate::gpu) fn room(&self) -> u32 {
        // There are at most `DeviceShape::max_paths`, or the pixels of a recorded rectangle, so it fits into u32.
        self.paths() as u32
    }

    fn paths(&self) -> u64 {
        self.pixels() * u64::from(self.in_flight)
    }

    fn pixels(&self) -> u64 {
        u64::from(self.tile[0]) * u64::from(self.tile[1])
    }

    /// Size in bytes of the state of all paths.
    pub(in crate::gpu) fn path_bytes(&self) -> u64 {
        16 * self.slots * self.paths()
    }

    /// Size in bytes of the lists of paths.
    pub(in crate::gpu) fn queue_bytes(&self) -> u64 {
        QUEUE_HEAD + 4 * LISTS * self.paths()
    }

    /// Size in bytes of the sums of a tile's pixels, which are read back tile by tile.
    pub(in crate::gpu) fn film_bytes(&self) -> u64 {
        16 * FILM_SLOTS * self.pixels()
    }

    /// Size in bytes of the sums of variances and luminances of a tile.
    pub(in crate::gpu) fn variation_bytes(&self) -> u64 {
        8 * 64 * self.pixels().div_ceil(64 * PIXELS_PER_VARIATION)
    }
}

fn slots(mode: Mode) -> u64 {
    match mode {
        Mode::Path(Materials::Any, ..) => MEDIUM_SLOTS,
        Mode::Path(Materials::Matt, Sources::None, _) => COMMON_SLOTS,
        Mode::Path(Materials::Matt, Sources::Any, _) => LIGHT_SLOTS,
        Mode::Studio => STUDIO_SLOTS,
    }
}
