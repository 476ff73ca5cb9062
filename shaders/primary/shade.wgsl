// Shades the hits and writes the pixels. The dispatch of a brick shades the pixels whose nearest sphere is in the
// brick, and that of the first brick also the misses. Twin: src/cpu/primary.rs.
// dispatched: for each band and each brick, with 8x8 pixels for each workgroup.
// provides: shade
// needs: Hit, NO_HIT, NO_ID, SHADING_TRANSPARENT, WORKGROUP_SIDE, brick, frame, hit_index, load_hit, shade_entry,
//   shape_normal, shapes, sphere_color, start_fences, surface_color, write_layers, write_with_alpha

@compute @workgroup_size(WORKGROUP_SIDE, WORKGROUP_SIDE)
fn shade(@builtin(global_invocation_id) invocation: vec3u) {
    start_fences();
    if (any(invocation.xy >= frame.tile_size)) {
        return;
    }
    var hit = load_hit(hit_index(invocation.xy));
    let group = invocation.xy / WORKGROUP_SIDE - frame.traced_first;
    // The subtraction wraps around, so workgroups before the first traced one have a large index.
    if (any(group >= frame.traced_size)) {
        hit = Hit(NO_HIT, NO_ID, 0u, 0.0);
    }
    let is_hit = hit.id != NO_ID;
    let shape_index = hit.shape_index - brick.first_shape;
    // The subtraction wraps around, so shapes of earlier bricks have a large index.
    let is_here = is_hit && shape_index < brick.shape_count;
    if (!is_here && (is_hit || brick.is_first == 0u)) {
        return;
    }
    var color = frame.background;
    var normal = vec3f(0.0);
    // The depth is NO_HIT for a miss.
    var depth = hit.t;
    if (is_here) {
        let entry = shade_entry(invocation.xy);
        normal = shape_normal(entry.ray, shapes[shape_index]);
        color = surface_color(sphere_color(shape_index).rgb, normal, entry.ray);
        // `hit.distance` belongs to this `t`. The ray of another kernel may enter the box at a slightly different
        // distance.
        depth = hit.distance + hit.t;
    }
    // Each texture is written at one place, because software devices take the time of all branches.
    let pixel = frame.target_origin + invocation.xy;
    let is_clear = !is_here && (frame.shading & SHADING_TRANSPARENT) != 0u;
    write_with_alpha(pixel, color, select(1.0, 0.0, is_clear));
    write_layers(pixel, depth, normal, hit.id);
}
