// Whether anything is between a path's surface and the light that it looks for. One dispatch per brick.

@compute @workgroup_size(64)
fn occlude(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let shadow = load(index, SHADOW);
    let leaves = load_departure(index);
    leave(leaves);
    let entry = enter_scene(CameraRay(Ray(load_start(index).position, shadow.xyz), 0.0, true));
    let rest = shadow.w - entry.distance;
    if (rest > 0.0 && entry.is_inside) {
        if (find_any(entry.ray, entry.inverse, rest)) {
            // Nor need any other brick be searched.
            paths[slot(index, SHADOW)].w = 0u;
            paths[slot(index, PENDING)].w = 0u;
        }
    }
    report_spent();
}
