// Writing the colour texture in one of three formats.

//// rgba8unorm
// Writing colour as sRGB with eight bits. Storage textures have no sRGB formats, so the shader encodes the colour.
// provides: write_with_alpha

// The caller's colour texture.
@group(2) @binding(0) var color_target: texture_storage_2d<rgba8unorm, write>;

// The transfer function of sRGB, IEC 61966-2-1.
fn encode_srgb(linear: vec3f) -> vec3f {
    let light = clamp(linear, vec3f(0.0), vec3f(1.0));
    // Below the threshold the power is not used. The maximum keeps its base away from zero.
    let power = 1.055 * pow(max(light, vec3f(0.0031308)), vec3f(1.0 / 2.4)) - 0.055;
    return select(power, light * 12.92, light <= vec3f(0.0031308));
}

fn write_with_alpha(pixel: vec2u, linear: vec3f, alpha: f32) {
    textureStore(color_target, pixel, vec4f(encode_srgb(linear), alpha));
}

fn write_color(pixel: vec2u, linear: vec3f) {
    write_with_alpha(pixel, linear, 1.0);
}

//// rgba16float
// Writing colour as linear light in 16-bit floats.
// provides: write_with_alpha

// The caller's colour texture.
@group(2) @binding(0) var color_target: texture_storage_2d<rgba16float, write>;

fn write_with_alpha(pixel: vec2u, linear: vec3f, alpha: f32) {
    textureStore(color_target, pixel, vec4f(linear, alpha));
}

fn write_color(pixel: vec2u, linear: vec3f) {
    write_with_alpha(pixel, linear, 1.0);
}

//// rgba32float
// Writing colour as linear light in 32-bit floats.
// provides: write_with_alpha

// The caller's colour texture.
@group(2) @binding(0) var color_target: texture_storage_2d<rgba32float, write>;

fn write_with_alpha(pixel: vec2u, linear: vec3f, alpha: f32) {
    textureStore(color_target, pixel, vec4f(linear, alpha));
}

fn write_color(pixel: vec2u, linear: vec3f) {
    write_with_alpha(pixel, linear, 1.0);
}
