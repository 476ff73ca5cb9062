// What the rays of paths meet: the nearest sphere. One dispatch per brick; each keeps what is nearer than what the
// bricks before it found.

@compute @workgroup_size(64)
fn extend(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let entry = entry_of_path(index);
    var hit = hit_before(index);
    var nearest = Nearest(hit.t, hit.id, 0u);
    if (entry.is_inside) {
        find_nearest(entry.ray, entry.inverse, &nearest);
    }
    if (nearest.id != hit.id) {
        hit = Hit(nearest.t, nearest.id, brick.first_place + nearest.place, entry.distance);
    }
    store_hit(index, hit);
    report_spent();
}
