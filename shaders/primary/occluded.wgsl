// Finds for every pixel whether its ray hits anything. The search ends at the first hit that it finds, which need not
// be the nearest. The recorded hit has the distance 0 and no id.
// dispatched: like `trace`, for measurements of shadow rays.
// provides: occluded
// needs: Hit, NO_HIT, NO_ID, Search, entry_of, find_any, frame, hit_before, hit_index, no_exclusion, pixel_in_tile,
//   report_spent, start_fences, store_hit

@compute @workgroup_size(64)
fn occluded(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixel = pixel_in_tile(group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let entry = entry_of(pixel);
    let index = hit_index(pixel);
    let is_known = hit_before(index).t < NO_HIT;
    var t = select(NO_HIT, 0.0, is_known);
    if (entry.is_inside && !is_known && find_any(Search(entry.ray, entry.inverse, no_exclusion()), NO_HIT)) {
        t = 0.0;
    }
    store_hit(index, Hit(t, NO_ID, 0u, 0.0));
    report_spent();
}
