//! Records of lit pictures that cross to WGSL. Twins: the structs of the same names in
//! `shaders/scene/lighting_records.wgsl`.

use bytemuck::{Pod, Zeroable};

/// What one dispatch does.
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
}

/// `LIST_OF_LIGHT` in `shaders/path/queue.wgsl`: the paths that look for light, or surfaces that are to be lit.
pub(in crate::gpu) const LIST_OF_LIGHT: u32 = 2;

/// How many lists of paths there are.
pub(super) const LISTS: u64 = 3;

/// Bytes before the lists in `shaders/path/queue.wgsl`: whether an invocation gave up, and how long each list is.
pub(super) const QUEUE_HEAD: u64 = 4 * (1 + LISTS);

/// Bytes of the numbers of workgroups that `shaders/path/advance.wgsl` writes: of a list, and of a slice of it.
pub(super) const GROUPS_NEEDED: u64 = 2 * GROUPS_OF_ONE;

/// Bytes of one of these.
pub(super) const GROUPS_OF_ONE: u64 = 12;

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
    pub(in crate::gpu) emitter_first: u32,
    pub(in crate::gpu) emitter_count: u32,
    pub(in crate::gpu) material_first: u32,
    pub(in crate::gpu) environment_size: [u32; 2],
    pub(in crate::gpu) environment_rotation: [f32; 2],
    pub(in crate::gpu) environment_strength: f32,
    pub(in crate::gpu) lamp_sources: u32,
    pub(in crate::gpu) _pad: [u32; 2],
    pub(in crate::gpu) filter_table: [[f32; 4]; 65],
}

/// `vec4f`s of a path's state that every path and every studio has: slots up to the hit in `shaders/path/state.wgsl`.
pub(in crate::gpu) const COMMON_SLOTS: u64 = 7;

/// With what a path that looks for light keeps.
pub(in crate::gpu) const LIGHT_SLOTS: u64 = 9;

/// With what absorbs light on the way.
pub(in crate::gpu) const MEDIUM_SLOTS: u64 = 10;

/// With what a studio keeps.
pub(in crate::gpu) const STUDIO_SLOTS: u64 = 10;

/// `vec4f`s of a pixel's sums: `shaders/path/film_sums.wgsl`.
pub(in crate::gpu) const FILM_SLOTS: u64 = 3;

/// How many pixels one number of `shaders/path/noise.wgsl` sums up.
pub(super) const PIXELS_PER_VARIATION: u64 = 64;
