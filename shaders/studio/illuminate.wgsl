// Adds the contributions of some lights to the visible surface of every path, in a studio. Twin:
// src/cpu/light/studio.rs.
// dispatched: after the shadows of up to 32 lights.
// provides: illuminate
// needs: ALBEDO, DIRECTION, LAMP_HEAD, LOBE, Lamp, NORMAL, NO_PATH, RADIANCE, THROUGHPUT, address_of, caught,
//   central_light, dispatch, lamp_kind, light_to_catch, lighting, load, load_start, path_of, paths, pixel_seed,
//   reflected, sample_lamp, sample_pair, slot, start_fences, store, table

@compute @workgroup_size(64)
fn illuminate(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let start = load_start(index);
    let normal = load(index, NORMAL).xyz;
    let hidden = paths[slot(index, NORMAL)].w;
    let out = -load(index, DIRECTION).xyz;
    let lobe = load(index, LOBE).xyz;
    let albedo = load(index, ALBEDO);
    let weight = load(index, THROUGHPUT).y;
    let is_caught = albedo.w > 0.0;
    let total = light_to_catch(is_caught, start.position);
    let address = address_of(index);
    let seed = pixel_seed(address.pixel, lighting.seed);
    var sum = vec4f(0.0);
    for (var light = dispatch.light; light < dispatch.light + dispatch.count; light++) {
        let u = sample_pair(seed, address.sample, 2u + 4096u * dispatch.surface + light);
        var lamp = sample_lamp(light, start.position, u);
        if (lamp_kind(light) == LAMP_HEAD) {
            lamp = Lamp(out, 0.0, table(3u * light + 1u).rgb, 0.0);
        }
        let is_hidden = (hidden & (1u << (light & 31u))) != 0u;
        let seen = reflected(lobe, normal, out, lamp.direction, albedo.rgb, weight);
        let shade = caught(central_light(light, start.position) / total, albedo.w);
        let open = select(vec4f(lamp.strength * seen, 0.0), vec4f(0.0), is_caught);
        sum += select(open, select(vec4f(0.0), shade, is_caught), is_hidden);
    }
    store(index, RADIANCE, load(index, RADIANCE) + sum);
    paths[slot(index, NORMAL)].w = 0u;
}
