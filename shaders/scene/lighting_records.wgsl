// Records that the host writes for lit pictures. Twins: the structs of the same names in src/gpu/passes/lit/records.rs.
// A test compares names, offsets and sizes.
// provides: DispatchParameters, LIGHTING_CATCHER, LIGHTING_GROUND, LIGHTING_SHADOWS, LIGHTING_SKY_SEEN,
//   LIGHTING_TRANSPARENT, LIGHT_CHANCE, LIGHT_DIRECT, LIGHT_MULTIPLE, LightingParameters

// The parameters of a dispatch.
struct DispatchParameters {
    // Index of the first sample of every pixel.
    sample: u32,
    // Index of the surface along the path, from 0.
    surface: u32,
    // Whether the surface is the last.
    is_last: u32,
    // Index of the light or of the direction of ambient light that is tested, or the first of several.
    light: u32,
    // Number of lights or directions; or of samples in flight; or of workgroups in a slice of a list.
    count: u32,
    // Index of the list of paths that is processed.
    list: u32,
    // Whether the lists that are filled next must be emptied.
    is_new: u32,
    // Number of paths that the buffers have room for.
    paths: u32,
    // Index of the first workgroup.
    first: vec2u,
    // The first of the tile's workgroups whose rays may hit the scene's box, and their number.
    visible_first: vec2u,
    visible_size: vec2u,
}

struct LightingParameters {
    background: vec3f,
    // Sum of the LIGHTING_ constants that apply.
    flags: u32,
    ambient: vec3f,
    light_count: u32,
    // Radiance of the sky straight up, at the horizon (`horizon`) and straight down (`nadir`).
    zenith: vec3f,
    roulette_from: u32,
    horizon: vec3f,
    // Number of light sources that can be sampled.
    source_count: u32,
    nadir: vec3f,
    // Method of light sampling: LIGHT_CHANCE, LIGHT_DIRECT or LIGHT_MULTIPLE.
    light_sampling: u32,
    cue_color: vec3f,
    cue_near: f32,
    ground_normal: vec3f,
    // Reciprocal of the depth over which colour fades; 0 if it does not fade.
    cue_scale: f32,
    // A point of the ground in the scene's frame.
    ground_point: vec3f,
    occlusion_radius: f32,
    ground_color: vec3f,
    occlusion_samples: u32,
    seed: u32,
    // Number of emissive spheres among which light sampling chooses.
    emitter_count: u32,
    // Index of the first material in `tables`.
    material_first: u32,
    // Number of light sources that are lights of the settings and not spheres of the scene.
    lamp_sources: u32,
    environment_size: vec2u,
    // Cosine and sine of the rotation of the sky's image.
    environment_rotation: vec2f,
    environment_strength: f32,
    // Distribution of samples in a pixel, see filter.wgsl.
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
