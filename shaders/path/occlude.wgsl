// Finds whether the sampled light of each path is occluded. There is one dispatch for each brick.
// dispatched: for each surface at which paths sample lights, and each brick.
// provides: occlude
// needs: CameraRay, NO_PATH, PENDING, Ray, SHADOW, Search, enter_scene, excluded_by, find_any, load, load_departure,
//   load_start, path_of, paths, report_spent, slot, start_fences

@compute @workgroup_size(64)
fn occlude(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let shadow = load(index, SHADOW);
    let excluded = excluded_by(load_departure(index));
    let entry = enter_scene(CameraRay(Ray(load_start(index).position, shadow.xyz), 0.0, true));
    let rest = shadow.w - entry.distance;
    if (rest > 0.0 && entry.is_inside) {
        if (find_any(Search(entry.ray, entry.inverse, excluded), rest)) {
            // The light is occluded, and no other brick needs to be searched.
            paths[slot(index, SHADOW)].w = 0u;
            paths[slot(index, PENDING)].w = 0u;
        }
    }
    report_spent();
}
