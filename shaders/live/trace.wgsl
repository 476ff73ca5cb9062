// Finds what the camera sees through the centre of each pixel of a live picture, and traces a few rays to its light.
// Twin: src/cpu/light/live.rs.
// dispatched: once for each frame of a live picture.
// provides: live
// needs: CameraRay, Departure, Hit, Lit, NO_EMITTER, NO_HIT, NO_ID, Shades, WORKGROUP_SIDE, background, camera_ray,
//   dispatch, enter_scene, excluded_by, frame, ground_vertex, is_ground, lighting, lit_surface, nearest_hit,
//   pack_normal, pixel_in_tile, pixel_seed, relative_location, report_spent, shape_vertex, start_fences

// Four vectors for each pixel, row by row:
//   the colour and the opacity `steady`,
//   the colour `lamps`, and the visible shares,
//   the colour `ambient`, and the normal,
//   the depth, the id, and the opacities `lamps` and `ambient`.
@group(0) @binding(5) var<storage, read_write> surfaces: array<vec4u>;

struct PixelLight {
    lit: Lit,
    normal: vec3f,
    depth: f32,
    id: u32,
}

// There is no early return: with one, Mesa 22.3 fails to compile the kernel.
fn find(pixel: vec2u, is_traced: bool, seed: u32, number: u32) -> PixelLight {
    let shown = background();
    let empty = Shades(vec4f(shown, 0.0), vec4f(0.0), vec4f(0.0));
    var found = PixelLight(Lit(empty, vec2f(1.0)), vec3f(0.0), NO_HIT, NO_ID);
    let made = camera_ray(relative_location(pixel), vec2f(0.5));
    let entry = enter_scene(CameraRay(made.ray, 0.0, made.is_seen && is_traced));
    let nothing = Departure(NO_ID, 0u, 0.0, NO_EMITTER);
    let hit = nearest_hit(entry, excluded_by(nothing), Hit(NO_HIT, NO_ID, 0u, 0.0));
    let on_ground = is_ground(made, hit);
    if (on_ground || hit.id != NO_ID) {
        var vertex = ground_vertex(made.ray, made.distance);
        if (!on_ground) {
            vertex = shape_vertex(made.ray, hit, false);
        }
        let lit = lit_surface(made, vertex, shown, seed, number);
        found = PixelLight(lit, vertex.normal, made.distance + vertex.distance, vertex.id);
    }
    return found;
}

@compute @workgroup_size(64)
fn live(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixel = pixel_in_tile(dispatch.first + group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = pixel.y * frame.tile_size.x + pixel.x;
    let place = pixel / WORKGROUP_SIDE - dispatch.visible_first;
    let is_traced = all(place < dispatch.visible_size);
    let found = find(pixel, is_traced, pixel_seed(pixel, lighting.seed), dispatch.sample + (index >> 31u));
    let shades = found.lit.shades;
    let shares = pack2x16unorm(found.lit.shares);
    let normal = pack2x16snorm(pack_normal(found.normal));
    let opacities = pack2x16snorm(vec2f(shades.lamps.w, shades.ambient.w));
    surfaces[4u * index] = bitcast<vec4u>(shades.steady);
    surfaces[4u * index + 1u] = vec4u(bitcast<vec3u>(shades.lamps.rgb), shares);
    surfaces[4u * index + 2u] = vec4u(bitcast<vec3u>(shades.ambient.rgb), normal);
    surfaces[4u * index + 3u] = vec4u(bitcast<u32>(found.depth), found.id, opacities, 0u);
    report_spent();
}
