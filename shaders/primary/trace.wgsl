// Finds the nearest sphere of every pixel's ray. There is one dispatch for each brick, which replaces the hits of
// earlier bricks by nearer ones. Twin: src/accel/bricks.rs.
// dispatched: for each band or slice of a band and each brick of the scene, with 8x8 pixels for each workgroup.
// provides: trace
// needs: entry_of, frame, hit_before, hit_index, nearest_hit, no_exclusion, pixel_in_tile, report_spent, start_fences,
//   store_hit

@compute @workgroup_size(64)
fn trace(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixel = pixel_in_tile(group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let entry = entry_of(pixel);
    let index = hit_index(pixel);
    store_hit(index, nearest_hit(entry, no_exclusion(), hit_before(index)));
    report_spent();
}
