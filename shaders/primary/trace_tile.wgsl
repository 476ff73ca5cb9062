// Finds the nearest sphere of every pixel's ray, in the lists of tiles. There is one dispatch for each brick, which
// replaces the hits of earlier bricks by nearer ones. Twin: src/accel/tile_lists.rs.
// dispatched: for each slice of a picture and each brick, with 8x8 pixels for each workgroup and 2x2 for each lane.
// provides: trace_tile
// needs: Entry, Nearest, WORKGROUP_SIDE, brick, entry_of, farthest, find_in_tile, frame, hit_before, hit_index, hit_of,
//   pixel_in_tile, report_spent, start_fences, store_hit

// The hit of a pixel in earlier bricks. Nothing is nearer where there is no pixel or its ray misses the scene's box.
fn found_before(pixel: vec2u, entry: Entry) -> Nearest {
    if (!entry.is_inside || any(pixel >= frame.tile_size)) {
        return Nearest(-1.0, 0u, 0u);
    }
    let before = hit_before(hit_index(pixel));
    return Nearest(before.t, before.id, 0u);
}

fn store(pixel: vec2u, entry: Entry, nearest: Nearest) {
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = hit_index(pixel);
    let before = hit_before(index);
    if (entry.is_inside) {
        store_hit(index, hit_of(nearest, entry, before));
    } else {
        store_hit(index, before);
    }
}

@compute @workgroup_size(16)
fn trace_tile(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let a = pixel_in_tile(group.xy, 4u * lane);
    let b = a + vec2u(1u, 0u);
    let c = a + vec2u(0u, 1u);
    let d = a + vec2u(1u, 1u);
    let entries = array(entry_of(a), entry_of(b), entry_of(c), entry_of(d));
    let before = array(
        found_before(a, entries[0]), found_before(b, entries[1]),
        found_before(c, entries[2]), found_before(d, entries[3]));
    let in_picture = a / WORKGROUP_SIDE;
    let tile = in_picture.y * brick.cell_counts.x + in_picture.x;
    let nearest = find_in_tile(tile, entries, before);
    store(a, entries[0], nearest[0]);
    store(b, entries[1], nearest[1]);
    store(c, entries[2], nearest[2]);
    store(d, entries[3], nearest[3]);
    let reach = max(
        max(entries[0].distance + nearest[0].t, entries[1].distance + nearest[1].t),
        max(entries[2].distance + nearest[2].t, entries[3].distance + nearest[3].t));
    // Numbers that are not negative are in the order of their bits.
    atomicMax(&farthest[tile], bitcast<u32>(max(reach, 0.0)));
    report_spent();
}
