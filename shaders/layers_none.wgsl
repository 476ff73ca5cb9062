// No data layers.

fn write_layers(pixel: vec2u, depth: f32, normal: vec3f, id: u32) {}
