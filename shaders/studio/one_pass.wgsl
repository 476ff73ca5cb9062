// Takes some samples of every pixel of a studio, each from the camera to its light, in one dispatch. It is for scenes of
// one brick in which all spheres are opaque, so that a ray has one surface; no state is kept between dispatches.
// Twin: src/cpu/light/studio.rs.
// dispatched: for some samples of all pixels of a tile.
// provides: one_pass
// needs: CameraRay, Departure, Hit, NO_EMITTER, NO_HIT, NO_ID, Sample, WORKGROUP_SIDE, background, camera_ray,
//   dispatch, enter_scene, excluded_by, filter_offset, frame, ground_vertex, is_ground, lighting, load_sums,
//   nearest_hit, pixel_in_tile, pixel_seed, report_spent, sample_location, sample_pair, shape_vertex, start_fences,
//   store_sums, surface_sample, unit2, with_sample

// There is no early return: with one, Mesa 22.3 fails to compile the kernel.
fn take_sample(pixel: vec2u, seed: u32, number: u32) -> Sample {
    let offset = filter_offset(sample_pair(seed, number, 0u));
    let lens = unit2(sample_pair(seed, number, 1u));
    let made = camera_ray(sample_location(pixel, offset), lens);
    let shown = background();
    var sample = Sample(vec4f(shown, 0.0), vec3f(0.0));
    let entry = enter_scene(CameraRay(made.ray, 0.0, made.is_seen));
    let nothing = Departure(NO_ID, 0u, 0.0, NO_EMITTER);
    let hit = nearest_hit(entry, excluded_by(nothing), Hit(NO_HIT, NO_ID, 0u, 0.0));
    let on_ground = is_ground(made, hit);
    if (on_ground || hit.id != NO_ID) {
        var vertex = ground_vertex(made.ray, made.distance);
        if (!on_ground) {
            vertex = shape_vertex(made.ray, hit, false);
        }
        sample = surface_sample(made, vertex, shown, seed, number);
    }
    return sample;
}

@compute @workgroup_size(64)
fn one_pass(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixel = pixel_in_tile(dispatch.first + group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = pixel.y * frame.tile_size.x + pixel.x;
    let in_film = frame.tile_origin + pixel;
    let seed = pixel_seed(in_film, lighting.seed);
    var sums = load_sums(index);
    // If this number depended on a uniform only, Mesa's lavapipe would compile the kernel again for every dispatch.
    let count = dispatch.count + (index >> 31u);
    // All rays of a workgroup outside the visible region show the background.
    let place = pixel / WORKGROUP_SIDE - dispatch.visible_first;
    let traced = select(0u, count, all(place < dispatch.visible_size));
    for (var i = 0u; i < traced; i++) {
        let sample = take_sample(in_film, seed, dispatch.sample + i + (index >> 31u));
        sums = with_sample(sums, sample.radiance, sample.albedo);
    }
    let shown = background();
    for (var i = traced; i < count; i++) {
        sums = with_sample(sums, vec4f(shown, 0.0), vec3f(0.0));
    }
    store_sums(index, sums);
    report_spent();
}
