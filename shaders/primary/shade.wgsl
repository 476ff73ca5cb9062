// From hits to pixels. One dispatch per brick, each for the pixels whose nearest sphere it holds; the first
// also for misses. Twin: src/cpu/shade.rs.
// dispatched: for each band and each brick: 8x8 pixels a workgroup.
// provides: shade
// needs: Hit, NO_HIT, NO_ID, WORKGROUP_SIDE, brick, frame, hit_index, load_hit, make_entry, shape_normal, shapes,
//   sphere_color, start_fences, surface_color, write_color, write_layers

@compute @workgroup_size(WORKGROUP_SIDE, WORKGROUP_SIDE)
fn shade(@builtin(global_invocation_id) invocation: vec3u) {
    start_fences();
    if (any(invocation.xy >= frame.tile_size)) {
        return;
    }
    var hit = load_hit(hit_index(invocation.xy));
    let group = invocation.xy / WORKGROUP_SIDE - frame.traced_first;
    // What lies before the first has become a large number.
    if (any(group >= frame.traced_size)) {
        hit = Hit(NO_HIT, NO_ID, 0u, 0.0);
    }
    let pixel = frame.target_origin + invocation.xy;
    if (hit.id == NO_ID) {
        if (brick.is_first != 0u) {
            write_color(pixel, frame.background);
            // Of a miss NO_HIT; after `occluded`, which names no spheres, its answer.
            write_layers(pixel, hit.t, vec3f(0.0), NO_ID);
        }
        return;
    }
    let shape_index = hit.shape_index - brick.first_shape;
    // What lies before the brick has become a large number.
    if (shape_index >= brick.shape_count) {
        return;
    }
    let entry = make_entry(invocation.xy);
    let normal = shape_normal(entry.ray, shapes[shape_index]);
    let color = sphere_color(shape_index).rgb;
    write_color(pixel, surface_color(color, normal, entry.ray));
    // The distance that belongs to this `t`: another kernel's ray may enter the box a little elsewhere.
    write_layers(pixel, hit.distance + hit.t, normal, hit.id);
}
