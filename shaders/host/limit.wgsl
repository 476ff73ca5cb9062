// Ends rays behind the host's depth: writes misses from which `trace` starts as from hits in earlier bricks. They lie
// farther than any hit that `hide` keeps.
// dispatched: for each band before `trace` if a host gives its depth, with 8x8 pixels for each traced workgroup.
// provides: limit
// needs: Hit, NO_HIT, NO_ID, WORKGROUP_SIDE, center_of, farthest_shown, frame, hit_index, host_depth_at, host_view,
//   make_entry, start_fences, store_hit

@compute @workgroup_size(WORKGROUP_SIDE, WORKGROUP_SIDE)
fn limit(@builtin(global_invocation_id) invocation: vec3u) {
    start_fences();
    let pixel = WORKGROUP_SIDE * frame.traced_first + invocation.xy;
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let in_film = frame.tile_origin + pixel;
    let farthest = farthest_shown(host_view, center_of(host_view, vec2f(in_film)), host_depth_at(in_film));
    let entry = make_entry(pixel);
    // Box tests may be wrong by 2^-18 of the diagonal (src/accel/slab.rs), and the difference by the numbers' rounding.
    let margin = 0x1p-16 * (entry.distance + length(frame.scene_max - frame.scene_min));
    let t = select(farthest - entry.distance + margin, NO_HIT, farthest >= NO_HIT);
    store_hit(hit_index(pixel), Hit(min(t, NO_HIT), NO_ID, 0u, 0.0));
}
