//! Records of lit pictures that kernels read. Twins: the structs of the same names in
//! `shaders/scene/lighting_records.wgsl`.

use bytemuck::{Pod, Zeroable};

/// The parameters of a dispatch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(in crate::gpu) struct DispatchParameters {
    pub(in crate::gpu) sample: u32,
    pub(in crate::gpu) surface: u32,
    pub(in crate::gpu) is_last: u32,
    pub(in crate::gpu) light: u32,
    pub(in crate::gpu) count: u32,
    pub(in crate::gpu) list: u32,
    pub(in crate::gpu) is_new: u32,
    pub(in crate::gpu) paths: u32,
    pub(in crate::gpu) first: [u32; 2],
    pub(in crate::gpu) visible_first: [u32; 2],
    pub(in crate::gpu) visible_size: [u32; 2],
}

/// Index of the list of paths whose sampled light must be tested, or of surfaces that studios illuminate:
/// `LIST_OF_LIGHT` in `shaders/path/queue.wgsl`.
pub(in crate::gpu) const LIST_OF_LIGHT: u32 = 2;

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
pub(in crate::gpu) struct LightingParameters {
    pub(in crate::gpu) background: [f32; 3],
    pub(in crate::gpu) flags: u32,
    pub(in crate::gpu) ambient: [f32; 3],
    pub(in crate::gpu) light_count: u32,
    pub(in crate::gpu) zenith: [f32; 3],
    pub(in crate::gpu) roulette_from: u32,
    pub(in crate::gpu) horizon: [f32; 3],
    pub(in crate::gpu) source_count: u32,
    pub(in crate::gpu) nadir: [f32; 3],
    pub(in crate::gpu) light_sampling: u32,
    pub(in crate::gpu) cue_color: [f32; 3],
    pub(in crate::gpu) cue_near: f32,
    pub(in crate::gpu) ground_normal: [f32; 3],
    pub(in crate::gpu) cue_scale: f32,
    pub(in crate::gpu) ground_point: [f32; 3],
    pub(in crate::gpu) occlusion_radius: f32,
    pub(in crate::gpu) ground_color: [f32; 3],
    pub(in crate::gpu) occlusion_samples: u32,
    pub(in crate::gpu) seed: u32,
    pub(in crate::gpu) emitter_count: u32,
    pub(in crate::gpu) material_first: u32,
    pub(in crate::gpu) lamp_sources: u32,
    pub(in crate::gpu) environment_size: [u32; 2],
    pub(in crate::gpu) environment_rotation: [f32; 2],
    pub(in crate::gpu) environment_strength: f32,
    pub(in crate::gpu) _pad: [u32; 3],
    pub(in crate::gpu) filter_table: [[f32; 4]; 65],
}

/// Number of slots in the state of every path and every studio: those up to the hit in `shaders/path/state.wgsl`. A
/// slot is a `vec4f`.
pub(in crate::gpu) const COMMON_SLOTS: u64 = 7;

/// Number of slots including those of a path's sampled light.
pub(in crate::gpu) const LIGHT_SLOTS: u64 = 9;

/// Number of slots including the absorption of a medium.
pub(in crate::gpu) const MEDIUM_SLOTS: u64 = 10;

/// Number of slots of a studio.
pub(in crate::gpu) const STUDIO_SLOTS: u64 = 10;

/// Number of `vec4f` in the sums of a pixel, see `shaders/path/film_sums.wgsl`.
pub(in crate::gpu) const FILM_SLOTS: u64 = 3;

/// Number of pixels that an invocation of `shaders/path/noise.wgsl` sums.
pub(super) const PIXELS_PER_VARIATION: u64 = 64;
