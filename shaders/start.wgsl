// The ray of a sample of every pixel. Twin: src/cpu/lit/mod.rs.

@compute @workgroup_size(64)
fn start(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = hit_index(pixel);
    let in_film = frame.tile_origin + pixel;
    let address = pixel_seed(in_film, look.seed);
    let offset = filter_offset(sample_pair(address, stage.sample, 0u));
    let lens = unit2(sample_pair(address, stage.sample, 1u));
    let made = camera_ray(sample_location(in_film, offset), lens);
    let alive = select(0u, PATH_ALIVE, made.is_seen);
    let is_shown = !made.is_seen && !is_look(LOOK_TRANSPARENT);
    store(index, ORIGIN, made.ray.origin, bitcast<f32>(alive | PATH_FULL));
    store(index, DIRECTION, made.ray.direction, 0.0);
    store(index, LEFT, vec3f(0.0), 0.0);
    store(index, THROUGHPUT, vec3f(1.0), bitcast<f32>(0u));
    store(index, RADIANCE, select(vec3f(0.0), look.background, is_shown), 0.0);
    store(index, SHADOW, vec3f(0.0, 0.0, 1.0), 0.0);
    store(index, PENDING, vec3f(0.0), 0.0);
    store(index, NORMAL, vec3f(0.0), 0.0);
    store(index, SURFACE, vec3f(0.0), bitcast<f32>(0u));
    store(index, TARGET, vec3f(0.0), 0.0);
    store(index, FIRST, vec3f(0.0), made.distance);
}
