// Finds the nearest sphere of every pixel's ray, in the lists of tiles. There is one dispatch for each brick, which
// replaces the hits of earlier bricks by nearer ones. Twin: src/accel/tile_lists.rs.
// dispatched: for each slice of a picture and each brick, with 8x8 pixels for each workgroup.
// provides: trace_tile
// needs: Nearest, Search, WORKGROUP_SIDE, entry_of, find_in_tile, frame, hit_before, hit_index, hit_of, no_exclusion,
//   pixel_in_tile, report_spent, start_fences, store_hit

@compute @workgroup_size(64)
fn trace_tile(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixel = pixel_in_tile(group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let entry = entry_of(pixel);
    let index = hit_index(pixel);
    let before = hit_before(index);
    var nearest = Nearest(before.t, before.id, 0u);
    if (entry.is_inside) {
        let search = Search(entry.ray, entry.inverse, no_exclusion());
        find_in_tile(search, entry.distance, pixel / WORKGROUP_SIDE, &nearest);
    }
    store_hit(index, hit_of(nearest, entry, before));
    report_spent();
}
