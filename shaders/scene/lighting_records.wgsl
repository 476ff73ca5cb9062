// Records of lit pictures. Twins: the structs of the same names in src/gpu/passes/lit/records.rs; a test compares names,
// offsets and sizes.
// provides: DispatchParameters, LIGHTING_CATCHER, LIGHTING_GROUND, LIGHTING_SKY_SEEN, LIGHTING_TRANSPARENT,
//   LIGHT_CHANCE, LIGHT_DIRECT, LIGHT_MULTIPLE, LightingParameters

// What one dispatch does.
struct DispatchParameters {
    // Which of the samples of every pixel.
    sample: u32,
    // Which of the surfaces that a ray meets, from 0.
    surface: u32,
    // Whether it is the last.
    is_last: u32,
    // The light, or the direction of ambient light, that is looked for; or the first of some.
    light: u32,
    // How many of them; how many samples are in flight; or how many workgroups a slice of a list has.
    count: u32,
    // The list of paths that is worked on.
    list: u32,
    // Whether lists that are filled next are to be emptied.
    is_new: u32,
    // How many paths there is room for.
    paths: u32,
    // The first workgroup.
    first: vec2u,
}

struct LightingParameters {
    background: vec3f,
    // Sums of the LIGHTING_ constants.
    flags: u32,
    ambient: vec3f,
    light_count: u32,
    // Of a sky: straight up, level, straight down; radiance.
    zenith: vec3f,
    roulette_from: u32,
    horizon: vec3f,
    // How many sources of direct light there are to choose from.
    source_count: u32,
    nadir: vec3f,
    // LIGHT_CHANCE, LIGHT_DIRECT or LIGHT_MULTIPLE.
    light_sampling: u32,
    cue_color: vec3f,
    cue_near: f32,
    ground_normal: vec3f,
    // One over the depth in which colour fades; 0 if it does not.
    cue_scale: f32,
    // In the scene's frame.
    ground_point: vec3f,
    occlusion_radius: f32,
    ground_color: vec3f,
    occlusion_samples: u32,
    seed: u32,
    // Where emitters and materials start in `tables`.
    emitter_first: u32,
    emitter_count: u32,
    material_first: u32,
    environment_size: vec2u,
    // Cosine and sine.
    environment_rotation: vec2f,
    environment_strength: f32,
    // How many of the sources are lights that are no spheres of the scene.
    lamp_sources: u32,
    // What inside a pixel samples are taken by; see filter.wgsl.
    filter_table: array<vec4f, 65>,
}

const LIGHTING_TRANSPARENT: u32 = 1u;
const LIGHTING_SKY_SEEN: u32 = 2u;
const LIGHTING_SHADOWS: u32 = 4u;
const LIGHTING_GROUND: u32 = 8u;
const LIGHTING_CATCHER: u32 = 16u;

const LIGHT_CHANCE: u32 = 0u;
const LIGHT_DIRECT: u32 = 1u;
const LIGHT_MULTIPLE: u32 = 2u;
