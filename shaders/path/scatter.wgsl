// Shades the hit of each path: adds emitted light, samples a light source and scatters the path. Twin:
// src/cpu/light/path.rs.
// dispatched: for each surface of the paths and each brick.
// provides: Onward, scatter
// needs: DIELECTRIC, DIRECTION, Departure, DirectLight, EMISSIVE, FIRST, HIT_NOTHING, LIST_OF_LIGHT, NO_PATH,
//   OTHER_BRICK, PATH_ALIVE, PATH_FULL, PATH_INSIDE, PATH_ON_GROUND, PATH_SCATTERED, RADIANCE, Ray, Surface,
//   THROUGHPUT, address_of, append, axes_around, bounce, classify_hit, clear_light, density_of_hit_emitter, dispatch,
//   distance_from_camera, emitter_of, exit_distance_of, has, head_light, light_of_miss, lighting, load, load_hit,
//   load_medium, load_start, material_of, needs_shadow_ray, next_list, path_of, pixel_seed, radiance_so_far,
//   sample_light, sample_pair, side_of, start_fences, store, store_departure, store_light, store_medium, store_start,
//   transmittance, unit2, vertex_of, weight_of_hit_light

// The new state of a path. Everything is stored once, at the end, because stores in branches that are not taken also
// cost time on a software device.
struct Onward {
    position: vec3f,
    flags: u32,
    direction: vec3f,
    density: f32,
    through: vec3f,
    medium: vec3f,
    light: DirectLight,
}

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
    let behind = distance_from_camera(first.w);
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
    let at = Surface(vertex, material_of(vertex), axes_around(vertex.normal));
    let medium = load_medium(index);
    let arriving = through * transmittance(medium, vertex.distance);
    let address = address_of(index);
    let seed = pixel_seed(address.pixel, lighting.seed);
    let chance = unit2(sample_pair(seed, address.sample, 3u + 8u * dispatch.surface));
    let scattered = start.flags & PATH_SCATTERED;
    let is_passed = chance.y >= vertex.opacity;
    let is_emitter = at.material.kind == EMISSIVE;
    let out = -ray.direction;

    var light = head_light(at, out, scattered);
    if (is_emitter) {
        let density = density_of_hit_emitter(hit.id, ray.origin);
        light = vertex.color * at.material.parameter * weight_of_hit_light(start.flags, direction.w, density);
    }
    radiance = select(vec4f(radiance.rgb + arriving * light, 1.0), radiance, is_passed);
    let is_first = !is_passed && scattered == 0u && first.w >= 0.0;
    let is_end = dispatch.is_last != 0u || (is_emitter && !is_passed);
    var next = bounce(at, out, chance.x, arriving, seed, address.sample, medium);
    next.light = sample_light(at, out, arriving, seed, address.sample, is_end || is_passed);
    // Glass ends at its far side, even if the path passes through that side.
    let beyond = select(medium, vec3f(0.0), at.material.kind == DIELECTRIC && vertex.is_back);
    let passed = Onward(vertex.position, PATH_FULL | PATH_ALIVE | scattered | side_of(at, true), ray.direction, 0.0,
        arriving, beyond, next.light);
    if (is_passed) {
        next = passed;
    }
    store(index, RADIANCE, radiance);
    // A negative length means that the first surface has been recorded.
    store(index, FIRST, select(first, vec4f(min(vertex.color, vec3f(1.0)), -1.0), is_first));
    let flags = select(next.flags, next.flags & ~PATH_ALIVE, is_end);
    store_start(index, next.position, flags);
    store(index, DIRECTION, vec4f(next.direction, next.density));
    let exit_distance = select(0.0, exit_distance_of(vertex, next.direction), has(flags, PATH_INSIDE));
    store_departure(index, Departure(vertex.id, vertex.shape_index, exit_distance, emitter_of(next.light)));
    store(index, THROUGHPUT, vec4f(next.through, 0.0));
    store_medium(index, next.medium);
    store_light(index, next.light);
    if (has(flags, PATH_ALIVE)) {
        append(next_list(), index);
    }
    if (needs_shadow_ray(next.light)) {
        append(LIST_OF_LIGHT, index);
    }
}
