// Adds the contributions of some lights to the visible surface of every path, in a studio. Twin:
// src/cpu/light/studio.rs.
// dispatched: after the shadows of up to 32 lights.
// provides: illuminate
// needs: ALBEDO, DIRECTION, LAMP_HEAD, LOBE, Lamp, NORMAL, NO_PATH, PI, RADIANCE, THROUGHPUT, address_of, caught,
//   central_light, dispatch, energy, lamp_kind, light_to_catch, lighting, load, load_start, mirrors_brdf, path_of,
//   paths, pixel_seed, sample_lamp, sample_pair, slot, start_fences, store, table

// The light that a specular lobe reflects, for a surface of weight 1.
fn lobe_light(lobe: vec3f, normal: vec3f, out: vec3f, toward: vec3f) -> f32 {
    let half = normalize(out + toward);
    let o = vec3f(0.0, 0.0, max(dot(normal, out), 1e-6));
    let i = vec3f(0.0, 0.0, max(dot(normal, toward), 1e-6));
    let h = dot(half, normal);
    let across = cross(half, normal);
    let mirrors = mirrors_brdf(lobe.y, o, i, vec3f(sqrt(dot(across, across)), 0.0, h));
    return lobe.x * PI * mirrors / energy(bitcast<u32>(lobe.z), o.z);
}

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
        let cosine = max(dot(normal, lamp.direction), 0.0);
        var seen = (1.0 - lobe.x) * cosine * albedo.rgb;
        if (lobe.x > 0.0) {
            let shine = weight * lobe_light(lobe, normal, out, lamp.direction);
            seen += vec3f(select(0.0, shine, cosine > 0.0));
        }
        let shade = caught(central_light(light, start.position) / total, albedo.w);
        let open = select(vec4f(lamp.strength * seen, 0.0), vec4f(0.0), is_caught);
        sum += select(open, select(vec4f(0.0), shade, is_caught), is_hidden);
    }
    store(index, RADIANCE, load(index, RADIANCE) + sum);
    paths[slot(index, NORMAL)].w = 0u;
}
