// Records that the host writes. Twins: the structs of the same names in src/gpu/records.rs;
// a test compares names, offsets and sizes.

struct Camera {
    // In the scene's frame. What the three vectors mean is up to the camera_*.wgsl part in use.
    origin: vec3f,
    right: vec3f,
    up: vec3f,
    forward: vec3f,
}

struct Frame {
    camera: Camera,
    background: vec3f,
    shading: u32,
    film_size: vec2u,
    // The part of the film that this dispatch renders, in pixels.
    tile_origin: vec2u,
    tile_size: vec2u,
    // Where that part lies in the target textures.
    target_origin: vec2u,
    // +1 if y = +1 is the top row, -1 if it is the bottom row.
    y_sign: f32,
    sphere_count: u32,
}

// A run of consecutive spheres, short enough for one dispatch.
struct Slice {
    first: u32,
    count: u32,
}
