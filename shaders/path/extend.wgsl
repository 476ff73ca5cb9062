// Finds the nearest sphere that the ray of each path hits. There is one dispatch for each brick, which replaces the
// hits of earlier bricks by nearer ones.
// dispatched: for each surface of the paths and each brick.
// provides: extend
// needs: CameraRay, DIRECTION, NO_PATH, PATH_ALIVE, PATH_INSIDE, Ray, enter_scene, excluded_by, has, hit_before, load,
//   load_departure, load_start, nearest_hit, path_of, report_spent, start_fences, store_hit

@compute @workgroup_size(64)
fn extend(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let start = load_start(index);
    let departure = load_departure(index);
    let is_alive = has(start.flags, PATH_ALIVE);
    var entry = enter_scene(CameraRay(Ray(start.position, load(index, DIRECTION).xyz), 0.0, true));
    entry.is_inside = entry.is_inside && is_alive;
    let before = hit_before(index, departure, is_alive && has(start.flags, PATH_INSIDE));
    store_hit(index, nearest_hit(entry, excluded_by(departure), before));
    report_spent();
}
