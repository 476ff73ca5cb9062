// Nearest hit by trying every sphere of one slice; slices are dispatched one after the other, in
// ascending order. Twin: src/cpu/trace.rs.

@group(1) @binding(0) var<uniform> slice: Slice;
// The spheres of the slice: centre in the scene's frame, and radius.
@group(1) @binding(1) var<storage, read> slice_spheres: array<vec4f>;

@compute @workgroup_size(8, 8)
fn trace(@builtin(global_invocation_id) invocation: vec3u) {
    if (any(invocation.xy >= frame.tile_size)) {
        return;
    }
    let ray = camera_ray(relative_location(frame.tile_origin + invocation.xy));
    let index = hit_index(invocation.xy);

    var nearest = Hit(NO_HIT, NO_ID);
    if (slice.first > 0u) {
        nearest = hits[index];
    }
    for (var i = 0u; i < slice.count; i++) {
        let t = intersect_sphere(ray, slice_spheres[i]).t;
        // Ids ascend, so `<` leaves a tie to the smaller id.
        if (t < nearest.t) {
            nearest = Hit(t, slice.first + i);
        }
    }
    hits[index] = nearest;
}
