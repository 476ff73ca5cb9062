// In a studio: whether something is near in one direction of ambient light. One dispatch per brick. Twin:
// src/cpu/light/studio.rs.

@compute @workgroup_size(64)
fn ambient(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = hit_index(pixel);
    let start = load_start(index);
    let address = pixel_seed(frame.tile_origin + pixel, look.seed);
    let sample = stage.sample * look.occlusion_samples + stage.light;
    let u = sample_pair(address, sample, 2u + 4096u * stage.surface + 4095u);
    let direction = to_world(axes_around(load(index, NORMAL).xyz), cosine_direction(u));
    look_for(index, start, direction, look.occlusion_radius, stage.light);
}
