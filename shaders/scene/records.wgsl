// Records that the host writes. Twins: the structs of the same names in src/gpu/shader/records.rs;
// a test compares names, offsets and sizes.
// provides: Brick, FrameParameters

struct Camera {
    // In the scene's frame: the camera, moved by `advance` times `forward`, up to the scene's box. All that
    // kernels compute is then as exact as the scene is large, however far away the camera is.
    origin: vec3f,
    advance: f32,
    // What the three vectors and the three numbers mean is up to the camera in use.
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
    // How many iterations of loops an invocation may take.
    iteration_limit: u32,
    scene_max: vec3f,
    // +1 if y = +1 is the top row, -1 if it is the bottom row.
    y_sign: f32,
    film_size: vec2u,
    // The part of the film that this dispatch renders, in pixels.
    tile_origin: vec2u,
    tile_size: vec2u,
    // Where that part lies in the target textures.
    target_origin: vec2u,
    // The workgroups of the tile that may meet the scene's box: the first, and how many. The rest are misses.
    traced_first: vec2u,
    traced_size: vec2u,
    // The first workgroup of the slice of those that is traced now.
    first_group: vec2u,
    // Row i of them is row i * row_step modulo their number.
    row_step: u32,
    // Zero; see fence.wgsl.
    zero: u32,
}

// A part of the scene that fits into bindings.
struct Brick {
    // Of a grid: its corner, and its cells.
    min: vec3f,
    cell_size: f32,
    cell_counts: vec3u,
    // How many elements `shapes` has.
    shape_count: u32,
    // How many places there are in the bricks before this one.
    first_shape: u32,
    is_first: u32,
    // The index of the last element of `looks`.
    last_appearance: u32,
    // Where the parts of a colour stand in `palette`: at a word of colour, moved right by so many bits times 0, 1, 2
    // and 3, of which these bits count.
    color_shift: u32,
    color_mask: u32,
    // Where words of material start in `looks`, and which of their bits count.
    material_first: u32,
    material_mask: u32,
}
