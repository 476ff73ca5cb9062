// The depth of a host program for a distance along a pixel's ray. Twin: `clip_depth` in src/camera/host.rs.
// provides: HostView, clip_depth, is_behind

struct HostView {
    // Vectors of the camera, as in camera/pinhole.wgsl.
    right: vec3f,
    // 1 if rays are parallel.
    is_parallel: u32,
    up: vec3f,
    slope: f32,
    forward: vec3f,
    // Depth of the far end of the range: 1, or 0 if depth is reversed.
    far: f32,
    // How depth starts at a place on the film, for (x, y, 1).
    film_depth: vec3f,
    zero: u32,
    // Size of the picture in pixels, and its first pixel in the host's targets.
    size: vec2u,
    first_pixel: vec2u,
}

// The depth before it is clamped to the range from 0 to 1. It is finite for any distance from 0 on.
fn clip_depth(view: HostView, pixel: vec2u, distance: f32) -> f32 {
    // As in camera/film.wgsl.
    let doubled = vec2i(pixel) * 2 + 1 - vec2i(view.size);
    let location = vec2f(doubled) / vec2f(view.size) * vec2f(1.0, -1.0);
    // Zero unless the near plane is oblique.
    let aside = location.x * view.film_depth.x + location.y * view.film_depth.y;
    let toward = location.x * view.right + location.y * view.up + view.forward;
    let scaled = view.slope * length(toward);
    let least = max(abs(scaled) * 1e-30, 1e-37);
    let change = select(scaled / max(distance, least), view.slope * distance, view.is_parallel != 0u);
    // The two numbers of opposite sign first, so that later roundings are those of a depth from 0 to 1.
    return (view.film_depth.z + change) + aside;
}

// Whether a depth is behind another one.
fn is_behind(view: HostView, depth: f32, other: f32) -> bool {
    return select(depth > other, depth < other, view.far == 0.0);
}
