// Starts the paths of all samples in flight with rays of the camera. Twin: src/cpu/light/sample.rs.
// dispatched: once for all pixels of a tile and all samples in flight.
// provides: start
// needs: DIRECTION, Departure, FIRST, Hit, LIGHTING_TRANSPARENT, NO_EMITTER, NO_HIT, NO_ID, NO_PATH, PATH_ALIVE,
//   PATH_FULL, RADIANCE, THROUGHPUT, address_of, camera_ray, clear_light, filter_offset, lighting, lighting_has,
//   path_of, pixel_seed, sample_location, sample_pair, start_fences, store, store_departure, store_hit, store_medium,
//   store_start, unit2

@compute @workgroup_size(64)
fn start(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let address = address_of(index);
    let seed = pixel_seed(address.pixel, lighting.seed);
    let offset = filter_offset(sample_pair(seed, address.sample, 0u));
    let lens = unit2(sample_pair(seed, address.sample, 1u));
    let made = camera_ray(sample_location(address.pixel, offset), lens);
    let is_shown = !made.is_seen && !lighting_has(LIGHTING_TRANSPARENT);
    store_hit(index, Hit(NO_HIT, NO_ID, 0u, 0.0));
    store_start(index, made.ray.origin, select(0u, PATH_ALIVE, made.is_seen) | PATH_FULL);
    store(index, DIRECTION, vec4f(made.ray.direction, 0.0));
    store_departure(index, Departure(NO_ID, 0u, 0.0, NO_EMITTER));
    store(index, THROUGHPUT, vec4f(1.0));
    store(index, RADIANCE, vec4f(select(vec3f(0.0), lighting.background, is_shown), 0.0));
    store(index, FIRST, vec4f(0.0, 0.0, 0.0, made.distance));
    clear_light(index);
    store_medium(index, vec3f(0.0));
}
