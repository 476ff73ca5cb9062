// Shades the hit of each path: adds emitted light, samples a light source and scatters the path. Twin:
// src/cpu/light/path.rs.
// dispatched: for each surface of the paths and each brick.
// provides: scatter
// needs: Arrived, DIRECTION, Departure, FIRST, HIT_NOTHING, LIST_OF_LIGHT, NO_PATH, OTHER_BRICK, PATH_ALIVE,
//   PATH_ON_GROUND, RADIANCE, Ray, THROUGHPUT, address_of, append, classify_hit, clear_light, dispatch,
//   distance_from_camera, emitter_of, has, leave, light_of_miss, lighting, load, load_hit, load_medium, load_start,
//   needs_shadow_ray, next_list, path_of, pixel_seed, radiance_so_far, start_fences, store, store_departure,
//   store_light, store_medium, store_start, vertex_of

@compute @workgroup_size(64)
fn scatter(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let start = load_start(index);
    if (!has(start.flags, PATH_ALIVE)) {
        return;
    }
    let direction = load(index, DIRECTION);
    let ray = Ray(start.position, direction.xyz);
    let hit = load_hit(index);
    let first = load(index, FIRST);
    let behind = distance_from_camera(first.w, dispatch.surface);
    let kind = classify_hit(ray, hit, has(start.flags, PATH_ON_GROUND), behind);
    if (kind == OTHER_BRICK) {
        return;
    }
    var radiance = radiance_so_far(index);
    let through = load(index, THROUGHPUT).rgb;
    if (kind == HIT_NOTHING) {
        radiance += vec4f(through * light_of_miss(ray.direction, start.flags, direction.w), 0.0);
        store(index, RADIANCE, radiance);
        store_start(index, vec3f(0.0), 0u);
        clear_light(index);
        return;
    }
    let vertex = vertex_of(index, ray, hit, kind, start.flags, behind);
    let address = address_of(index);
    let seed = pixel_seed(address.pixel, lighting.seed);
    let arrived = Arrived(ray, direction.w, start.flags, through, load_medium(index), radiance, first, seed,
        address.sample, dispatch.surface, dispatch.is_last != 0u);
    // Everything is stored once, at the end, because stores in branches that are not taken also cost time on a software
    // device.
    let next = leave(arrived, vertex);
    store(index, RADIANCE, next.radiance);
    store(index, FIRST, next.first);
    store_start(index, next.position, next.flags);
    store(index, DIRECTION, vec4f(next.direction, next.density));
    store_departure(index, Departure(vertex.id, vertex.shape_index, next.exit_distance, emitter_of(next.light)));
    store(index, THROUGHPUT, vec4f(next.through, 0.0));
    store_medium(index, next.medium);
    store_light(index, next.light);
    if (has(next.flags, PATH_ALIVE)) {
        append(next_list(), index);
    }
    if (needs_shadow_ray(next.light)) {
        append(LIST_OF_LIGHT, index);
    }
}
