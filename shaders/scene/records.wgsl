// Records that the host writes for frames and bricks. Twins: the structs of the same names in
// src/gpu/shader/records.rs. A test compares names, offsets and sizes.
// provides: Brick, FrameParameters

struct Camera {
    // Position of the camera in the scene's frame, moved by `advance` times `forward` up to the scene's box. The
    // accuracy of the kernels then depends on the size of the scene only, however far away the camera is.
    origin: vec3f,
    advance: f32,
    // The meaning of the three vectors and the three numbers depends on the kind of camera.
    right: vec3f,
    first: f32,
    up: vec3f,
    second: f32,
    forward: vec3f,
    third: f32,
}

struct FrameParameters {
    camera: Camera,
    background: vec3f,
    shading: u32,
    // The box of all spheres, a little larger.
    scene_min: vec3f,
    // Maximum number of loop iterations of an invocation.
    iteration_limit: u32,
    scene_max: vec3f,
    // +1 if y = +1 is the top row, -1 if it is the bottom row.
    y_sign: f32,
    film_size: vec2u,
    // The part of the film that this dispatch renders, in pixels.
    tile_origin: vec2u,
    tile_size: vec2u,
    // Position of that part in the target textures.
    target_origin: vec2u,
    // The first of the tile's workgroups whose rays may hit the scene's box, and their number. All others are misses.
    traced_first: vec2u,
    traced_size: vec2u,
    // The first workgroup of the slice that is traced now.
    first_group: vec2u,
    // Row i of a dispatch is row i * row_step, modulo the number of rows.
    row_step: u32,
    // The same number as `iteration_limit`; see frame.wgsl.
    iteration_limit_again: u32,
}

// A part of the scene that fits into bindings.
struct Brick {
    // Corner of the grid, size of its cells and their numbers, if the structure is a grid.
    min: vec3f,
    cell_size: f32,
    cell_counts: vec3u,
    // Number of elements of `shapes`.
    shape_count: u32,
    // Number of shapes in the bricks before this one.
    first_shape: u32,
    is_first: u32,
    // Index of the last element of `appearances`.
    last_appearance: u32,
    // Component k of a colour is in the element of `palette` whose index is the colour word, shifted right by
    // k * color_shift bits and masked by color_mask.
    color_shift: u32,
    color_mask: u32,
    // Index of the first material word in `appearances`, and the mask of its valid bits.
    material_first: u32,
    material_mask: u32,
    // Index of the first reference in `ids`, if references of a grid are there.
    first_reference: u32,
    // The box of most spheres of a tree, and their margin, which suits rays that start in that box.
    crowd_min: vec3f,
    crowd_margin: f32,
    crowd_max: vec3f,
    unused: u32,
}
