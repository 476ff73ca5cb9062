// Takes some samples of every pixel, each with a whole path from the camera to its end, in one dispatch. It is for scenes
// of one brick and for software devices, on which reading and writing the state of paths takes a third of the time; on
// GPUs, so large a kernel leaves room for few invocations. Twin: src/cpu/light/path.rs.
// dispatched: for some samples of all pixels of a tile.
// provides: whole_paths
// needs: Arrived, CameraRay, Departure, HIT_NOTHING, HIT_SPHERE, LIGHTING_TRANSPARENT, NO_EMITTER, NO_ID, PATH_ALIVE,
//   PATH_FULL, PATH_INSIDE, PATH_ON_GROUND, Ray, camera_ray, classify_hit, dispatch, distance_from_camera, emitter_of,
//   enter_scene, excluded_by, filter_offset, frame, ground_vertex, has, hit_before, leave, light_of_miss, lighting,
//   lighting_has, load_sums, nearest_hit, pixel_in_tile, pixel_seed, report_spent, sample_location, sample_pair,
//   seen_light, spend, sphere_vertex, start_fences, store_sums, unit2, with_sample

// A path whose next ray is to be traced, or that has ended.
struct Path {
    ray: Ray,
    // Sum of PATH_ flags.
    flags: u32,
    // Density with which the last surface scattered the ray.
    density: f32,
    through: vec3f,
    // Radiance of the sample so far, and its opacity.
    radiance: vec4f,
    // Albedo of the first surface, and the length of the ray so far; negative once the first surface is recorded.
    first: vec4f,
    departure: Departure,
    // Number of surfaces so far.
    surface: u32,
}

fn begin_path(pixel: vec2u, seed: u32, sample: u32) -> Path {
    let offset = filter_offset(sample_pair(seed, sample, 0u));
    let lens = unit2(sample_pair(seed, sample, 1u));
    let made = camera_ray(sample_location(pixel, offset), lens);
    let is_shown = !made.is_seen && !lighting_has(LIGHTING_TRANSPARENT);
    let flags = select(0u, PATH_ALIVE, made.is_seen) | PATH_FULL;
    let radiance = vec4f(select(vec3f(0.0), lighting.background, is_shown), 0.0);
    let first = vec4f(0.0, 0.0, 0.0, made.distance);
    return Path(made.ray, flags, 0.0, vec3f(1.0), radiance, first, Departure(NO_ID, 0u, 0.0, NO_EMITTER), 0u);
}

// The path after its next surface, or after it has left the scene. The dispatch has the number of the last surface. There
// is no early return: with one, Mesa 22.3 fails to compile the kernel.
fn extended(path: Path, seed: u32, sample: u32) -> Path {
    let ray = path.ray;
    let goes_inside = has(path.flags, PATH_INSIDE);
    let before = hit_before(0u, path.departure, goes_inside);
    let hit = nearest_hit(enter_scene(CameraRay(ray, 0.0, true)), excluded_by(path.departure), before);
    let behind = distance_from_camera(path.first.w, path.surface);
    let kind = classify_hit(ray, hit, has(path.flags, PATH_ON_GROUND), behind);
    var vertex = ground_vertex(ray, behind);
    if (kind == HIT_SPHERE) {
        vertex = sphere_vertex(ray, hit, goes_inside && hit.id == path.departure.id);
    }
    let sky = path.through * light_of_miss(ray.direction, path.flags, path.density);
    let next = leave(Arrived(ray, path.density, path.flags, path.through, vec3f(0.0), path.radiance, path.first,
        seed, sample, path.surface, path.surface == dispatch.surface), vertex);
    let to_light = Departure(vertex.id, vertex.shape_index, next.exit_distance, emitter_of(next.light));
    let light = seen_light(next.light, next.position, to_light);
    let is_miss = kind == HIT_NOTHING;
    return Path(
        Ray(next.position, next.direction),
        select(next.flags, 0u, is_miss),
        next.density,
        next.through,
        select(next.radiance + vec4f(light, 0.0), path.radiance + vec4f(sky, 0.0), is_miss),
        select(next.first, path.first, is_miss),
        // Only the ray to the light excludes the light.
        Departure(vertex.id, vertex.shape_index, next.exit_distance, NO_EMITTER),
        path.surface + 1u,
    );
}

@compute @workgroup_size(64)
fn whole_paths(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixel = pixel_in_tile(dispatch.first + group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = pixel.y * frame.tile_size.x + pixel.x;
    let in_film = frame.tile_origin + pixel;
    let seed = pixel_seed(in_film, lighting.seed);
    var sums = load_sums(index);
    var sample = dispatch.sample;
    // If this number depended on a uniform only, Mesa's lavapipe would compile the kernel again for every dispatch.
    let end = sample + dispatch.count + (index >> 31u);
    var path = begin_path(in_film, seed, sample);
    // One loop over the surfaces of all samples: with a loop for each sample, paths that a software device traces together
    // would all wait for the longest of them.
    loop {
        if (!has(path.flags, PATH_ALIVE)) {
            sums = with_sample(sums, path.radiance, path.first.rgb);
            sample++;
            path = begin_path(in_film, seed, sample);
        }
        // With the loops over lights, and the search for an emitter.
        if (sample == end || !spend(33u + 2u * lighting.light_count)) {
            break;
        }
        if (has(path.flags, PATH_ALIVE)) {
            path = extended(path, seed, sample);
        }
    }
    store_sums(index, sums);
    report_spent();
}
