// The nearest sphere of every pixel's ray. One dispatch per brick; each keeps what is nearer than what
// the bricks before it found. Twin: src/accel/brick.rs.
// dispatched: for each band of the picture and each brick of the scene, or for a slice of it: 8x8 pixels a workgroup.
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
