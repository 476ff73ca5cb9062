// The depth of a host program for a distance along a pixel's ray. Twin: `clip_depth` in src/camera/host.rs.
// provides: center_of, clip_depth, depth_aside, is_behind, perspective_slope
// needs: HostView

// The centre of a pixel, counted in half pixels from the middle of the film. This is exact.
fn center_of(view: HostView, pixel: vec2f) -> vec2f {
    return 2.0 * pixel + (1.0 - view.size);
}

// Zero unless the near plane is oblique.
fn depth_aside(view: HostView, center: vec2f) -> f32 {
    return center.x * view.film_depth.x + center.y * view.film_depth.y;
}

// The factor of 1/distance, for a perspective camera.
fn perspective_slope(view: HostView, center: vec2f) -> f32 {
    return view.slope * length(center.x * view.column + center.y * view.row + view.forward);
}

// The depth before it is clamped to the range from 0 to 1. It is finite for any distance from 0 on.
fn clip_depth(view: HostView, center: vec2f, distance: f32) -> f32 {
    let scaled = perspective_slope(view, center);
    let least = max(abs(scaled) * 1e-30, 1e-37);
    let change = select(scaled / max(distance, least), view.slope * distance, view.is_parallel != 0.0);
    // The two numbers of opposite sign first, so that later roundings are those of a depth from 0 to 1.
    return (view.film_depth.z + change) + depth_aside(view, center);
}

// Whether a depth is behind another one.
fn is_behind(view: HostView, depth: f32, other: f32) -> bool {
    return select(depth > other, depth < other, view.far == 0.0);
}
