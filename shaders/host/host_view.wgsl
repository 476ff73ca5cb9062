// The record of a host's camera. Twin: `HostView` in src/gpu/host/host_view.rs.
// provides: HostView

struct HostView {
    // Vectors of the camera, as in camera/pinhole.wgsl, but those along the sides of the film for half a pixel. The
    // second one points to the next row.
    column: vec3f,
    // 1 if rays are parallel, otherwise 0.
    is_parallel: f32,
    row: vec3f,
    slope: f32,
    forward: vec3f,
    // Depth of the far end of the range: 1, or 0 if depth is reversed.
    far: f32,
    // How depth starts at a place on the film, for half a column, half a row, and the middle.
    film_depth: vec3f,
    zero: f32,
    // Size of the picture in pixels, and its first pixel in the host's targets.
    size: vec2f,
    first_pixel: vec2f,
}
