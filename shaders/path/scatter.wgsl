// What a path meets, what light it finds there, and where it goes on. Twin: src/cpu/light/path.rs.
// dispatched: for each surface of the paths and each brick.
// provides: Onward, scatter
// needs: DIELECTRIC, DIRECTION, Departure, DirectLight, EMISSIVE, FIRST, LIST_OF_LIGHT, NOBODY, NOTHING_MET, NO_PATH,
//   PATH_ALIVE, PATH_FULL, PATH_INSIDE, PATH_ON_GROUND, PATH_SCATTERED, RADIANCE, Ray, Surface, THROUGHPUT, address_of,
//   append, axes_around, bounce, chance_weight, come_from_camera, dispatch, exit_distance_of, forget_light, has,
//   head_light, is_looking, kept_by, known_density, light_from_afar, lighting, load, load_hit, load_medium, load_start,
//   look_for_light, material_of, next_list, path_of, pixel_seed, radiance_so_far, sample_pair, side_of, sought_by,
//   start_fences, store, store_departure, store_light, store_medium, store_start, unit2, vertex_of, what_is_met

// A path as it goes on. Everything is stored once, at the end: a software device pays for stores in branches that are
// not taken.
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
    let behind = come_from_camera(first.w);
    let met = what_is_met(ray, hit, has(start.flags, PATH_ON_GROUND), behind);
    if (met == NOBODY) {
        return;
    }
    var radiance = radiance_so_far(index);
    let through = load(index, THROUGHPUT).rgb;
    if (met == NOTHING_MET) {
        radiance += vec4f(through * light_from_afar(ray.direction, start.flags, direction.w), 0.0);
        store(index, RADIANCE, radiance);
        store_start(index, vec3f(0.0), 0u);
        forget_light(index);
        return;
    }
    let vertex = vertex_of(index, ray, hit, met, start.flags, behind);
    let at = Surface(vertex, material_of(vertex), axes_around(vertex.normal));
    let medium = load_medium(index);
    let arriving = through * kept_by(medium, vertex.distance);
    let address = address_of(index);
    let seed = pixel_seed(address.pixel, lighting.seed);
    let chance = unit2(sample_pair(seed, address.sample, 3u + 8u * dispatch.surface));
    let scattered = start.flags & PATH_SCATTERED;
    let is_passed = chance.y >= vertex.opacity;
    let is_emitter = at.material.kind == EMISSIVE;
    let out = -ray.direction;

    var light = head_light(at, out, scattered);
    if (is_emitter) {
        let density = known_density(hit.id, ray.origin);
        light = vertex.color * at.material.parameter * chance_weight(start.flags, direction.w, density);
    }
    radiance = select(vec4f(radiance.rgb + arriving * light, 1.0), radiance, is_passed);
    let is_first = !is_passed && scattered == 0u && first.w >= 0.0;
    let is_end = dispatch.is_last != 0u || (is_emitter && !is_passed);
    var next = bounce(at, out, chance.x, arriving, seed, address.sample, medium);
    next.light = look_for_light(at, out, arriving, seed, address.sample, is_end || is_passed);
    // Glass ends at its wall, also where that lets light pass.
    let beyond = select(medium, vec3f(0.0), at.material.kind == DIELECTRIC && vertex.is_back);
    let passed = Onward(vertex.position, PATH_FULL | PATH_ALIVE | scattered | side_of(at, true), ray.direction, 0.0,
        arriving, beyond, next.light);
    if (is_passed) {
        next = passed;
    }
    store(index, RADIANCE, radiance);
    // A length below zero says that there has been a first surface.
    store(index, FIRST, select(first, vec4f(min(vertex.color, vec3f(1.0)), -1.0), is_first));
    let flags = select(next.flags, next.flags & ~PATH_ALIVE, is_end);
    store_start(index, next.position, flags);
    store(index, DIRECTION, vec4f(next.direction, next.density));
    let exit_distance = select(0.0, exit_distance_of(vertex, next.direction), has(flags, PATH_INSIDE));
    store_departure(index, Departure(vertex.id, vertex.shape_index, exit_distance, sought_by(next.light)));
    store(index, THROUGHPUT, vec4f(next.through, 0.0));
    store_medium(index, next.medium);
    store_light(index, next.light);
    if (has(flags, PATH_ALIVE)) {
        append(next_list(), index);
    }
    if (is_looking(next.light)) {
        append(LIST_OF_LIGHT, index);
    }
}
