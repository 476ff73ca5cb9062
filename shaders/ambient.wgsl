// In a studio: whether something is near in one direction of ambient light. One dispatch per brick. Twin:
// src/cpu/light/studio.rs.

@compute @workgroup_size(64)
fn ambient(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let start = load_start(index);
    let address = address_of(index);
    let seed = pixel_seed(address.pixel, look.seed);
    let sample = address.sample * look.occlusion_samples + stage.light;
    let u = sample_pair(seed, sample, 2u + 4096u * stage.surface + 4095u);
    let direction = to_world(axes_around(load(index, NORMAL).xyz), cosine_direction(u));
    look_for(index, start, direction, look.occlusion_radius, stage.light);
}
