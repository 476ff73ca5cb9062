// Turns the hits that a host's depth hides into misses, and the misses of `limit` into those that `shade` expects.
// dispatched: for each band between `trace` and `shade` if a host gives its depth, with 8x8 pixels for each traced
//   workgroup.
// provides: hide
// needs: Hit, NO_HIT, NO_ID, WORKGROUP_SIDE, center_of, clip_depth, fence, frame, hit_index, host_depth_at, host_view,
//   is_behind, load_hit, start_fences, store_hit

@compute @workgroup_size(WORKGROUP_SIDE, WORKGROUP_SIDE)
fn hide(@builtin(global_invocation_id) invocation: vec3u) {
    start_fences();
    let pixel = WORKGROUP_SIDE * frame.traced_first + invocation.xy;
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = hit_index(pixel);
    let hit = load_hit(index);
    let in_film = frame.tile_origin + pixel;
    // The distance that `shade` writes.
    let depth = clip_depth(host_view, center_of(host_view, vec2f(in_film)), fence(hit.distance + hit.t));
    let is_hidden = is_behind(host_view, clamp(depth, 0.0, 1.0), host_depth_at(in_film));
    if (hit.id == NO_ID || is_hidden || is_behind(host_view, depth, host_view.far)) {
        store_hit(index, Hit(NO_HIT, NO_ID, 0u, 0.0));
    }
}
