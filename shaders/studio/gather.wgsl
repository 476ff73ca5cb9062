// Adds ambient light from some directions in a studio, using a bit for each occluded direction. Twin:
// src/cpu/light/studio.rs.
// dispatched: after up to 32 directions of ambient light.
// provides: gather
// needs: ALBEDO, NORMAL, NO_PATH, RADIANCE, caught, dispatch, light_to_catch, lighting, load, load_start, luminance,
//   path_of, paths, slot, start_fences, store

@compute @workgroup_size(64)
fn gather(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let start = load_start(index);
    let hidden = f32(countOneBits(paths[slot(index, NORMAL)].w));
    let share = 1.0 / f32(lighting.occlusion_samples);
    let albedo = load(index, ALBEDO);
    let is_caught = albedo.w > 0.0;
    let total = light_to_catch(is_caught, start.position);
    let open = vec4f(albedo.rgb * lighting.ambient * (share * (f32(dispatch.count) - hidden)), 0.0);
    let shade = caught(share * hidden * luminance(lighting.ambient) / total, albedo.w);
    store(index, RADIANCE, load(index, RADIANCE) + select(open, shade, is_caught));
    paths[slot(index, NORMAL)].w = 0u;
}
