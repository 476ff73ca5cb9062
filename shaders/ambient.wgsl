// In a studio: whether something is near in one direction of ambient light. Twin: src/cpu/lit/studio.rs.

@compute @workgroup_size(64)
fn ambient(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    let index = hit_index(pixel);
    let origin = load(index, ORIGIN);
    if (any(pixel >= frame.tile_size) || !has(bitcast<u32>(origin.w), PATH_LIT)) {
        return;
    }
    let radiance = settled(index);
    store(index, RADIANCE, radiance.rgb, radiance.a);
    let count = look.occlusion_samples;
    let address = pixel_seed(frame.tile_origin + pixel, look.seed);
    let sample = stage.sample * count + stage.light - look.light_count;
    let u = sample_pair(address, sample, 2u + 4096u * stage.surface + 4095u);
    let direction = to_world(axes_around(load(index, NORMAL).xyz), cosine_direction(u));
    let share = 1.0 / f32(count);
    let left_over = load(index, LOBE).w;
    let is_caught = left_over > 0.0;
    let total = light_to_catch(is_caught, origin.xyz);
    let shade = caught(share * luminance(look.ambient), total, left_over);
    let light = load(index, SURFACE).rgb * look.ambient * share;
    let seen = select(vec4f(light, 0.0), shade, is_caught);
    look_for(index, direction, look.occlusion_radius, seen.rgb, seen.a);
}
