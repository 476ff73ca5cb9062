// Whether every pixel's ray hits anything at all. Leaves at the first hit, whichever it is. A pixel's hit
// has the distance 0 and no id.

@compute @workgroup_size(64)
fn occluded(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let entry = entry_of(pixel);
    let index = hit_index(pixel);
    let is_known = hit_before(index).t < NO_HIT;
    var t = select(NO_HIT, 0.0, is_known);
    if (entry.is_inside && !is_known && find_any(entry.ray, entry.inverse, NO_HIT)) {
        t = 0.0;
    }
    store_hit(index, Hit(t, NO_ID, 0u, 0.0));
    report_spent();
}
