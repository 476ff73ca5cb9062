// The nearest sphere of every pixel's ray. One dispatch per brick; each keeps what is nearer than what
// the bricks before it found. Twin: src/accel/brick.rs.

@compute @workgroup_size(64)
fn trace(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let entry = entry_of(pixel);
    let index = hit_index(pixel);
    store_hit(index, nearest_hit(entry, hit_before(index)));
    report_spent();
}
