//! Records of lit pictures that kernels read, and the sizes of their buffers. Twins: the structs of the same names in
//! `shaders/scene/lighting_records.wgsl`.

use bytemuck::{Pod, Zeroable};
use wgpu::Limits;

use crate::camera::film::Film;
use crate::gpu::device_shape::DeviceShape;
use crate::gpu::passes::lit::kernels::{Materials, Mode, Sources};
use crate::gpu::passes::tiles::WORKGROUP_SIDE;

/// The parameters of a dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct DispatchParameters {
    pub(crate) sample: u32,
    pub(crate) surface: u32,
    pub(crate) is_last: u32,
    pub(crate) light: u32,
    pub(crate) count: u32,
    pub(crate) list: u32,
    pub(crate) is_new: u32,
    pub(crate) paths: u32,
    pub(crate) first: [u32; 2],
    pub(crate) visible_first: [u32; 2],
    pub(crate) visible_size: [u32; 2],
}

/// Index of the list of paths whose sampled light must be tested, or of surfaces that studios illuminate:
/// `LIST_OF_LIGHT` in `shaders/path/queue.wgsl`.
pub(crate) const LIST_OF_LIGHT: u32 = 2;

/// Number of lights that are tested before their contributions are added. Each has a bit in a word.
pub(super) const BITS: usize = 32;

/// Number of lists of paths.
pub(super) const LISTS: u64 = 3;

/// Number of bytes before the lists in `shaders/path/queue.wgsl`, which hold the status word and the lengths of the
/// lists.
pub(super) const QUEUE_HEAD: u64 = 4 * (1 + LISTS);

/// Size in bytes of the arguments that `shaders/path/advance.wgsl` writes for two indirect dispatches: of a whole list,
/// and of a slice of it.
pub(super) const GROUPS_NEEDED: u64 = 2 * GROUPS_OF_ONE;

/// Size in bytes of the arguments of one indirect dispatch.
pub(super) const GROUPS_OF_ONE: u64 = 12;

/// The parameters of a lighting.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct LightingParameters {
    pub(crate) background: [f32; 3],
    pub(crate) flags: u32,
    pub(crate) ambient: [f32; 3],
    pub(crate) light_count: u32,
    pub(crate) zenith: [f32; 3],
    pub(crate) roulette_from: u32,
    pub(crate) horizon: [f32; 3],
    pub(crate) source_count: u32,
    pub(crate) nadir: [f32; 3],
    pub(crate) light_sampling: u32,
    pub(crate) cue_color: [f32; 3],
    pub(crate) cue_near: f32,
    pub(crate) ground_normal: [f32; 3],
    pub(crate) cue_scale: f32,
    pub(crate) ground_point: [f32; 3],
    pub(crate) occlusion_radius: f32,
    pub(crate) ground_color: [f32; 3],
    pub(crate) occlusion_samples: u32,
    pub(crate) seed: u32,
    pub(crate) emitter_count: u32,
    pub(crate) material_first: u32,
    pub(crate) lamp_sources: u32,
    pub(crate) environment_size: [u32; 2],
    pub(crate) environment_rotation: [f32; 2],
    pub(crate) environment_strength: f32,
    pub(crate) _pad: [u32; 3],
    pub(crate) filter_table: [[f32; 4]; 65],
}

/// Number of slots in the state of every path and every studio, up to the slot of the hit in
/// `shaders/path/state.wgsl`. A slot is a `vec4f`.
pub(crate) const COMMON_SLOTS: u64 = 7;

/// Number of slots including those for the sampled light of a path.
pub(crate) const LIGHT_SLOTS: u64 = 9;

/// Number of slots including the absorption of a medium.
pub(crate) const MEDIUM_SLOTS: u64 = 10;

/// Number of slots of a studio.
pub(crate) const STUDIO_SLOTS: u64 = 10;

/// Number of `vec4f` in the sums of a pixel, see `shaders/path/film_sums.wgsl`.
pub(crate) const FILM_SLOTS: u64 = 3;

/// Number of pixels that an invocation of `shaders/path/noise.wgsl` sums.
pub(super) const PIXELS_PER_VARIATION: u64 = 64;

/// Number of samples of a pixel that are traced together, if not fewer are left. Each sample then takes less time,
/// because the sums are read and written once for all of them. In return, tiles become smaller.
const TOGETHER: u32 = 4;

/// Maximum number of workgroups in a row, which every WebGPU device allows. Without indirect dispatches, a dispatch
/// over a list has one workgroup for every workgroup of a tile and each sample in flight.
const MAX_GROUPS: u64 = 65_535;

/// Sizes of the buffers that all tiles share, and of the buffers of each tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct LitSizes {
    /// Maximum width and height of a tile in pixels.
    pub(crate) tile: [u32; 2],
    /// Number of samples of every pixel of a tile that are traced together.
    pub(crate) in_flight: u32,
    /// Number of `vec4f` in the state of a path.
    slots: u64,
}

impl LitSizes {
    /// The sizes for a film with at most `samples` samples of every pixel.
    pub(crate) fn new(limits: &Limits, shape: DeviceShape, film: &Film, mode: Mode, samples: u32) -> Self {
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
        // Not more than `samples`, so it fits into u32.
        Self { tile, in_flight: in_flight as u32, slots }
    }

    /// The sizes for a single rectangle and one sample at a time.
    pub(crate) fn of_one_sample(tile: [u32; 2], mode: Mode) -> Self {
        Self { tile, in_flight: 1, slots: slots(mode) }
    }

    /// Number of paths that the buffers have room for.
    pub(crate) fn room(&self) -> u32 {
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
    pub(crate) fn path_bytes(&self) -> u64 {
        16 * self.slots * self.paths()
    }

    /// Size in bytes of the lists of paths.
    pub(crate) fn queue_bytes(&self) -> u64 {
        QUEUE_HEAD + 4 * LISTS * self.paths()
    }

    /// Size in bytes of the sums of a tile's pixels, which are read back tile by tile.
    pub(crate) fn film_bytes(&self) -> u64 {
        16 * FILM_SLOTS * self.pixels()
    }

    /// Size in bytes of the sums of variances and luminances of a tile.
    pub(crate) fn variation_bytes(&self) -> u64 {
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
