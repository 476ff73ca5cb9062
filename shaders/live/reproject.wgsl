// Averages the visible shares of light over frames: those of each surface are looked up where it was in the frame before.
// Twin: src/cpu/light/live.rs.
// dispatched: once for each frame of a live picture, after `live`.
// provides: reproject
// needs: LiveView, Visibility, is_in_view, location_before, pack_visibility, pixel_of, point_seen, visibility_of

// The cameras of this frame and of the one before.
@group(0) @binding(0) var<uniform> view: LiveView;
// The surfaces of this frame, as in trace.wgsl.
@group(0) @binding(1) var<storage, read> surfaces: array<vec4u>;
// Shares, counts, depth and id of every pixel of the frame before.
@group(0) @binding(2) var<storage, read> before: array<vec4u>;
// Those of this frame.
@group(0) @binding(3) var<storage, read_write> after: array<vec4u>;

// The value of `has_before` for a frame with the same view.
const SAME_VIEW: u32 = 2u;
// The depth of a miss.
const NOTHING: f32 = 1e30;

// What the frame before knew of the surface at a distance along the ray of a pixel; counts are 0 if nothing.
fn known_before(pixel: vec2u, depth: f32, id: u32) -> Visibility {
    let point = point_seen(view, pixel, depth) + view.shift;
    let is_same = view.has_before == SAME_VIEW;
    let found = location_before(view, point);
    let there = vec3f(found.xy, select(found.z, depth, is_same));
    let at = select(pixel_of(view, there.xy), vec2i(pixel), is_same);
    var known = Visibility(vec2f(1.0), vec2u(0u));
    if (view.has_before != 0u && there.z > 0.0 && is_in_view(view, at)) {
        let old = before[u32(at.y) * view.size.x + u32(at.x)];
        let pixel_size = view.footprint * select(there.z, 1.0, view.is_parallel != 0u);
        // Half a pixel beside the point, a slanted surface has another depth.
        let is_near = abs(bitcast<f32>(old.z) - there.z) <= 8.0 * pixel_size + 1e-5 * there.z;
        if (old.w == id && is_near) {
            known = visibility_of(old.xy);
        }
    }
    return known;
}

@compute @workgroup_size(8, 8)
fn reproject(@builtin(global_invocation_id) invocation: vec3u) {
    let pixel = invocation.xy;
    if (any(pixel >= view.size)) {
        return;
    }
    let index = pixel.y * view.size.x + pixel.x;
    let place = surfaces[4u * index + 3u].xy;
    let depth = bitcast<f32>(place.x);
    // Where there is nothing, no neighbour is asked.
    var found = Visibility(unpack2x16unorm(surfaces[4u * index + 1u].w), vec2u(255u));
    if (depth < NOTHING) {
        let known = known_before(pixel, depth, place.y);
        found.counts = min(known.counts + 1u, vec2u(view.most_lamps, view.most_open));
        found.shares = mix(known.shares, found.shares, 1.0 / vec2f(found.counts));
    }
    after[index] = vec4u(pack_visibility(found), place);
}
