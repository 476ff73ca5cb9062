// From hits to pixels. Twin: src/cpu/shade.rs.

@group(1) @binding(0) var<storage, read> spheres: array<vec4f>;
// Linear colour of each sphere; the fourth component is unused.
@group(1) @binding(1) var<storage, read> colors: array<vec4f>;

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) invocation: vec3u) {
    if (any(invocation.xy >= frame.tile_size)) {
        return;
    }
    let hit = hits[hit_index(invocation.xy)];
    let pixel = frame.target_origin + invocation.xy;
    // Not only `hit.id == NO_ID`: an index from a buffer is checked before it is used.
    if (hit.id >= frame.sphere_count) {
        write_color(pixel, frame.background);
        write_layers(pixel, NO_HIT, vec3f(0.0), NO_ID);
        return;
    }
    let ray = camera_ray(relative_location(frame.tile_origin + invocation.xy));
    let normal = sphere_normal(ray, intersect_sphere(ray, spheres[hit.id]));
    write_color(pixel, surface_color(colors[hit.id].rgb, normal, ray));
    write_layers(pixel, hit.t, normal, hit.id);
}
