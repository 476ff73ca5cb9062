// Takes some samples of every pixel, each with a whole path from the camera to its end, in one dispatch. It is for scenes
// of one brick and for software devices, on which reading and writing the state of paths takes a third of the time; on
// GPUs, so large a kernel leaves room for few invocations. Twin: src/cpu/light/path.rs.
// dispatched: for some samples of all pixels of a tile.
// provides: whole_paths
// needs: Arrived, CameraRay, Departure, HIT_NOTHING, HIT_SHAPE, NO_EMITTER, PATH_ALIVE, PATH_INSIDE, PATH_ON_GROUND,
//   Path, Ray, begin_path, classify_hit, dispatch, distance_from_camera, emitter_of, enter_scene, excluded_by,
//   first_hit, frame, ground_vertex, has, leave, light_of_miss, lighting, load_sums, nearest_hit, pixel_in_tile,
//   pixel_seed, report_spent, seen_light, shape_vertex, spend, start_fences, store_sums, with_sample

// The path after its next surface, whose last number the dispatch has. An early return would crash Mesa 22.3.
fn extended(path: Path, seed: u32, sample: u32) -> Path {
    let ray = path.ray;
    let goes_inside = has(path.flags, PATH_INSIDE);
    let before = first_hit(path.departure, goes_inside);
    let hit = nearest_hit(enter_scene(CameraRay(ray, 0.0, true)), excluded_by(path.departure), before);
    let behind = distance_from_camera(path.first.w, path.surface);
    let kind = classify_hit(ray, hit, has(path.flags, PATH_ON_GROUND), behind);
    var vertex = ground_vertex(ray, behind);
    if (kind == HIT_SHAPE) {
        vertex = shape_vertex(ray, hit, goes_inside && hit.id == path.departure.id);
    }
    let sky = path.through * light_of_miss(ray.direction, path.flags, path.density);
    let next = leave(Arrived(ray, path.density, path.flags, path.through, path.medium, path.radiance, path.first,
        seed, sample, path.surface, path.surface == dispatch.surface), vertex);
    let departure = Departure(vertex.id, vertex.shape_index, next.exit_distance, emitter_of(next.light));
    let light = seen_light(next.light, next.position, departure);
    let is_miss = kind == HIT_NOTHING;
    return Path(
        Ray(next.position, next.direction),
        select(next.flags, 0u, is_miss),
        next.density,
        next.through,
        next.medium,
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
        // With the loops over lights, and two searches for emitters. Twin: `loops_of_path` in passes/lit/lighting.rs.
        if (sample == end || !spend(65u + 2u * lighting.light_count)) {
            break;
        }
        if (has(path.flags, PATH_ALIVE)) {
            path = extended(path, seed, sample);
        }
    }
    store_sums(index, sums);
    report_spent();
}
