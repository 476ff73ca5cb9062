//! Records of lit pictures that cross to WGSL. Twins: the structs of the same names in
//! `shaders/light_records.wgsl`.

use bytemuck::{Pod, Zeroable};

/// What one dispatch does.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(in crate::gpu) struct Stage {
    pub(in crate::gpu) sample: u32,
    pub(in crate::gpu) surface: u32,
    pub(in crate::gpu) is_last: u32,
    pub(in crate::gpu) light: u32,
    pub(in crate::gpu) count: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(in crate::gpu) struct Look {
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

/// `LOOK_…` in the same file.
pub(in crate::gpu) const TRANSPARENT: u32 = 1;
pub(in crate::gpu) const SKY_SEEN: u32 = 2;
pub(in crate::gpu) const SHADOWS: u32 = 4;
pub(in crate::gpu) const GROUND: u32 = 8;
pub(in crate::gpu) const CATCHER: u32 = 16;

/// `vec4f`s that a path's state takes for each pixel: the last slot of `shaders/path_state.wgsl` and one.
pub(super) const PATH_SLOTS: u64 = 10;

/// `vec4f`s that a pixel's sums take: `shaders/deposit.wgsl`.
pub(super) const FILM_SLOTS: u64 = 2;
