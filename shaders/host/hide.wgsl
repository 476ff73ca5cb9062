// Turns the hits that a host's depth hides into misses.
// dispatched: for each band between `trace` and `shade` if a host gives its depth, with 8x8 pixels for each workgroup.
// provides: hide
// needs: Hit, HostView, NO_HIT, NO_ID, WORKGROUP_SIDE, clip_depth, fence, frame, hit_index, is_behind, load_hit,
//   start_fences, store_hit

// The host's camera.
@group(1) @binding(0) var<uniform> host_view: HostView;
// Depth texture of the host.
@group(1) @binding(1) var host_depth: texture_depth_2d;

@compute @workgroup_size(WORKGROUP_SIDE, WORKGROUP_SIDE)
fn hide(@builtin(global_invocation_id) invocation: vec3u) {
    start_fences();
    if (any(invocation.xy >= frame.tile_size)) {
        return;
    }
    let index = hit_index(invocation.xy);
    let hit = load_hit(index);
    // Pixels that are not traced have no hit yet; what they contain is never read.
    if (hit.id == NO_ID) {
        return;
    }
    let pixel = frame.tile_origin + invocation.xy;
    // The distance that `shade` writes.
    let depth = clip_depth(host_view, pixel, fence(hit.distance + hit.t));
    let there = textureLoad(host_depth, pixel + host_view.first_pixel, 0);
    if (is_behind(host_view, clamp(depth, 0.0, 1.0), there) || is_behind(host_view, depth, host_view.far)) {
        store_hit(index, Hit(NO_HIT, NO_ID, 0u, 0.0));
    }
}
