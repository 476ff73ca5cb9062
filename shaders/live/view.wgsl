// The cameras of a live picture and of the frame before, for finding points of one in the other. Twin:
// src/cpu/light/live.rs.
// provides: LiveView, is_in_view, location_before, pixel_of, point_seen

struct LiveView {
    // Vectors of the camera, as in camera/pinhole.wgsl.
    right: vec3f,
    // 1 if rays are parallel.
    is_parallel: u32,
    up: vec3f,
    // Height of a pixel at the distance 1, or everywhere if rays are parallel.
    footprint: f32,
    forward: vec3f,
    // +1 if y = +1 is the top row, -1 if it is the bottom row.
    y_sign: f32,
    // From the origin of the camera before to that of this one.
    shift: vec3f,
    // 0 if no frame before shows the same scene and light, 1 if one does, and 2 if its view is the same too.
    has_before: u32,
    // The place of a point on the film before: its products with these vectors, the first two divided by the third
    // unless rays are parallel.
    across: vec3f,
    // Maximum numbers of frames over which the shares of lamps and of ambient light are averaged.
    most_lamps: u32,
    down: vec3f,
    most_open: u32,
    along: vec3f,
    zero: u32,
    // Width and height of the picture in pixels.
    size: vec2u,
    pad: vec2u,
}

// A point from the origin of the camera, at a distance along the ray of a pixel.
fn point_seen(view: LiveView, pixel: vec2u, depth: f32) -> vec3f {
    let location = (vec2f(2u * pixel + 1u) / vec2f(view.size) - 1.0) * vec2f(1.0, -view.y_sign);
    let aside = location.x * view.right + location.y * view.up;
    let toward = aside + view.forward;
    return select(depth * normalize(toward), aside + depth * view.forward, view.is_parallel != 0u);
}

// The place on the film of the frame before of a point from the origin of its camera, and the distance there.
fn location_before(view: LiveView, point: vec3f) -> vec3f {
    let along = dot(point, view.along);
    let is_parallel = view.is_parallel != 0u;
    let scale = 1.0 / select(max(along, 1e-20), 1.0, is_parallel);
    let distance = select(length(point) * sign(along), along, is_parallel);
    return vec3f(scale * dot(point, view.across), scale * dot(point, view.down), distance);
}

// The pixel at a place on the film, in pixels, and whether it is in the picture.
fn pixel_of(view: LiveView, location: vec2f) -> vec2i {
    let place = (location * vec2f(1.0, -view.y_sign) + 1.0) * 0.5 * vec2f(view.size);
    return vec2i(floor(clamp(place, vec2f(-1.0), vec2f(view.size) + 1.0)));
}

fn is_in_view(view: LiveView, pixel: vec2i) -> bool {
    return all(pixel >= vec2i(0)) && all(pixel < vec2i(view.size));
}
