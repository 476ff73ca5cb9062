// In a studio: one light on the surface that every pixel sees. Twin: src/cpu/lit/studio.rs.

@compute @workgroup_size(64)
fn illuminate(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    let index = hit_index(pixel);
    let origin = load(index, ORIGIN);
    if (any(pixel >= frame.tile_size) || !has(bitcast<u32>(origin.w), PATH_LIT)) {
        return;
    }
    let radiance = settled(index);
    store(index, RADIANCE, radiance.rgb, radiance.a);
    let normal = load(index, NORMAL).xyz;
    let out = -load(index, DIRECTION).xyz;
    let lobe = load(index, LOBE);
    let address = pixel_seed(frame.tile_origin + pixel, look.seed);
    let u = sample_pair(address, stage.sample, 2u + 4096u * stage.surface + stage.light);
    var lamp = sample_lamp(stage.light, origin.xyz, u);
    let is_head = lamp_kind(stage.light) == LAMP_HEAD;
    if (is_head) {
        lamp = Lamp(out, 0.0, tables[3u * stage.light + 1u].rgb, 0.0);
    }
    let cosine = max(dot(normal, lamp.direction), 0.0);
    let is_shadowed = is_look(LOOK_SHADOWS) && !is_head && cosine > 0.0;
    let distance = select(0.0, lamp.distance, is_shadowed);
    if (lobe.w > 0.0) {
        let total = light_to_catch(true, origin.xyz);
        let shade = caught(central_light(stage.light, origin.xyz, normal), total, lobe.w);
        look_for(index, lamp.direction, distance, shade.rgb, select(0.0, shade.a, is_shadowed));
        return;
    }
    let color = load(index, SURFACE).rgb;
    // SURFACE holds colour times weight; the lobe is white, by the weight alone.
    var light = (1.0 - lobe.x) * color * cosine;
    if (lobe.x > 0.0) {
        let half = normalize(out + lamp.direction);
        let o = vec3f(0.0, 0.0, max(dot(normal, out), 1e-6));
        let h = dot(half, normal);
        let across = vec3f(sqrt(max(1.0 - h * h, 0.0)), 0.0, h);
        let mirrors = mirrors_brdf(lobe.y, o, vec3f(0.0, 0.0, max(cosine, 1e-6)), across);
        let kept = energy(u32(lobe.z), o.z);
        let weight = load(index, THROUGHPUT).y;
        light += vec3f(select(0.0, weight * lobe.x * PI * mirrors / kept, cosine > 0.0));
    }
    look_for(index, lamp.direction, distance, lamp.strength * light, 0.0);
}
