// Writing the textures of depth, normal and id, if they are requested.

//// none
// Variant for renderers without data layers, which writes nothing.
// provides: write_layers

fn write_layers(pixel: vec2u, depth: f32, normal: vec3f, id: u32) {}

//// all
// Writing the data layers: depth, which is NO_HIT for a miss, normal and id.
// provides: write_layers

// The caller's depth texture.
@group(2) @binding(1) var depth_target: texture_storage_2d<r32float, write>;
// The caller's normal texture.
@group(2) @binding(2) var normal_target: texture_storage_2d<rgba32float, write>;
// The caller's id texture.
@group(2) @binding(3) var id_target: texture_storage_2d<r32uint, write>;

fn write_layers(pixel: vec2u, depth: f32, normal: vec3f, id: u32) {
    textureStore(depth_target, pixel, vec4f(depth, 0.0, 0.0, 0.0));
    textureStore(normal_target, pixel, vec4f(normal, 0.0));
    textureStore(id_target, pixel, vec4u(id, 0u, 0u, 0u));
}
