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
    store_hit(index, nearest_hit(entry, hit_before(index)));
    report_spent();
}
