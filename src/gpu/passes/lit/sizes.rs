//! How large the buffers of a lit picture are: what the plan sums up, and what is allocated.

use wgpu::Limits;

use super::kernels::{Materials, Mode, Sources};
use super::records::{
    COMMON_SLOTS, FILM_SLOTS, GROUPS_NEEDED, LIGHT_SLOTS, LISTS, MEDIUM_SLOTS,
    PIXELS_PER_VARIATION, QUEUE_HEAD, STUDIO_SLOTS,
};
use crate::camera::film::Film;
use crate::gpu::passes::tiles::WORKGROUP_SIDE;

/// The most paths that are followed at a time. Their state then takes 56 to 80 MiB.
const MOST_PATHS: u64 = 1 << 19;

/// How many samples of a pixel are followed together, if there are so many: each of them then costs less, because their
/// sum is read and written once. Tiles are smaller for it.
const TOGETHER: u32 = 4;

/// Sizes of what all tiles share, and of what each has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gpu) struct LitSizes {
    /// Width and height of a tile in pixels, at most.
    pub(in crate::gpu) tile: [u32; 2],
    /// How many samples of every pixel of a tile are followed together.
    pub(in crate::gpu) in_flight: u32,
    /// `vec4f`s of a path's state.
    slots: u64,
}

impl LitSizes {
    /// For a film, with at most so many samples.
    pub(in crate::gpu) fn new(limits: &Limits, film: &Film, mode: Mode, samples: u32) -> Self {
        let slots = slots(mode);
        let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let of_path = 16 * slots.max(FILM_SLOTS);
        let most = (binding / of_path).clamp(64, MOST_PATHS);
        let most_pixels = (most / u64::from(samples.clamp(1, TOGETHER))).max(64);
        let width = u64::from(film.width()).min((most_pixels / 8).max(8));
        let rows = (most_pixels / width).max(1);
        let side = u64::from(WORKGROUP_SIDE);
        let rows = if rows > side { rows / side * side } else { rows };
        // No more than the film, so they fit.
        let tile = [width as u32, rows.min(film.height().into()) as u32];
        let pixels = u64::from(tile[0]) * u64::from(tile[1]);
        let in_flight = (most / pixels).clamp(1, samples.max(1).into());
        // No more than the samples, so it fits.
        Self { tile, in_flight: in_flight as u32, slots }
    }

    /// The same for one rectangle, and one sample at a time.
    pub(in crate::gpu) fn of_one_sample(tile: [u32; 2], mode: Mode) -> Self {
        Self { tile, in_flight: 1, slots: slots(mode) }
    }

    /// How many paths there is room for, as kernels count them.
    pub(in crate::gpu) fn room(&self) -> u32 {
        // At most MOST_PATHS, or a rectangle that is recorded; so it fits.
        self.paths() as u32
    }

    fn paths(&self) -> u64 {
        self.pixels() * u64::from(self.in_flight)
    }

    fn pixels(&self) -> u64 {
        u64::from(self.tile[0]) * u64::from(self.tile[1])
    }

    /// Bytes of the state of all paths.
    pub(in crate::gpu) fn path_bytes(&self) -> u64 {
        16 * self.slots * self.paths()
    }

    /// Bytes of the lists of paths.
    pub(in crate::gpu) fn queue_bytes(&self) -> u64 {
        QUEUE_HEAD + 4 * LISTS * self.paths()
    }

    /// Bytes of what indirect dispatches read.
    pub(in crate::gpu) fn groups_bytes(&self) -> u64 {
        GROUPS_NEEDED
    }

    /// Bytes of the sums of a tile's pixels. They are read back tile by tile.
    pub(in crate::gpu) fn film_bytes(&self) -> u64 {
        16 * FILM_SLOTS * self.pixels()
    }

    /// Bytes of how much the samples of a tile's pixels vary.
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
