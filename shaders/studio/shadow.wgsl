// Finds whether a light is hidden from the visible surface of every path, in a studio. There is one dispatch for each
// brick. Twin: src/cpu/light/studio.rs.
// dispatched: for each light and each brick of occluders.
// provides: shadow
// needs: NORMAL, NO_PATH, address_of, dispatch, excluded_by, hide, is_hidden, lighting, load, load_departure,
//   load_start, path_of, pixel_seed, report_spent, sample_lamp, sample_pair, start_fences

@compute @workgroup_size(64)
fn shadow(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
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
    let u = sample_pair(seed, address.sample, 2u + 4096u * dispatch.surface + dispatch.light);
    let lamp = sample_lamp(dispatch.light, start.position, u);
    // A light behind the surface needs no search and casts no shadow.
    let normal = load(index, NORMAL).xyz;
    let is_before = dot(normal, lamp.direction) > 0.0;
    let is_shadow = is_hidden(start, excluded, bitcast<f32>(departure.word) * normal, lamp.direction, select(0.0, lamp.distance, is_before));
    hide(index, select(0u, 1u << (dispatch.light & 31u), is_shadow));
    report_spent();
}
