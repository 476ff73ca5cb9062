// Colour target: linear light.

@group(2) @binding(0) var color_target: texture_storage_2d<rgba32float, write>;

fn write_color(pixel: vec2u, linear: vec3f) {
    textureStore(color_target, pixel, vec4f(linear, 1.0));
}
