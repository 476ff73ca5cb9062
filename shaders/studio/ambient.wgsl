// Finds whether ambient light from some random directions is occluded, in a studio. There is one dispatch for each
// brick. Twin: src/cpu/light/studio.rs.
// dispatched: for up to 32 directions of ambient light and each brick of occluders.
// provides: ambient
// needs: NORMAL, NO_PATH, address_of, axes_around, cosine_direction, dispatch, excluded_by, hide, is_hidden, lighting,
//   load, load_departure, load_start, path_of, pixel_seed, report_spent, sample_pair, start_fences, to_world

@compute @workgroup_size(64)
fn ambient(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let start = load_start(index);
    let departure = load_departure(index);
    let excluded = excluded_by(departure);
    let address = address_of(index);
    let seed = pixel_seed(address.pixel, lighting.seed);
    let normal = load(index, NORMAL).xyz;
    let axes = axes_around(normal);
    var hidden = 0u;
    // If this number depended on a uniform only, Mesa's lavapipe would compile the kernel again for every dispatch.
    let count = dispatch.count + (index >> 31u);
    for (var i = 0u; i < count; i++) {
        let light = dispatch.light + i;
        let sample = address.sample * lighting.occlusion_samples + light;
        let u = sample_pair(seed, sample, 2u + 4096u * dispatch.surface + 4095u);
        let direction = to_world(axes, cosine_direction(u));
        let is_near = is_hidden(start, excluded, bitcast<f32>(departure.word) * normal, direction, lighting.occlusion_radius);
        hidden |= select(0u, 1u << (light & 31u), is_near);
    }
    hide(index, hidden);
    report_spent();
}
