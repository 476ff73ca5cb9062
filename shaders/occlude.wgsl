// Whether anything is between a surface and a light. One dispatch per brick.

@compute @workgroup_size(64)
fn occlude(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = hit_index(pixel);
    let shadow = load(index, SHADOW);
    let pending = load(index, PENDING);
    let origin = load(index, ORIGIN).xyz;
    left = load(index, LEFT);
    aim(index);
    let entry = enter_scene(CameraRay(Ray(origin, shadow.xyz), 0.0, true));
    let rest = shadow.w - entry.distance;
    if (pending.w > 0.0 && rest > 0.0 && entry.is_inside) {
        if (find_any(entry.ray, entry.inverse, rest)) {
            paths[slot(index, PENDING)] = vec4f(pending.xyz, 0.0);
        }
    }
    report_spent();
}
