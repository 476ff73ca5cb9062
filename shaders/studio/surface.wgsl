// Finds the surface that each ray hits, and adds all light that needs no shadow rays, in a studio. Twin:
// src/cpu/light/studio.rs.
// dispatched: for each surface that the camera sees and each brick.
// provides: surface
// needs: ALBEDO, DIRECTION, Departure, EMISSIVE, FIRST, HIT_GROUND, HIT_NOTHING, LAMBERT, LIGHTING_CATCHER,
//   LIST_OF_LIGHT, LOBE, NORMAL, NO_PATH, OTHER_BRICK, PATH_ALIVE, PATH_BACK, PATH_INSIDE, PATH_ON_GROUND, RADIANCE,
//   Ray, THROUGHPUT, append, background, classify_hit, dispatch, distance_from_camera, exit_distance_of, faded, has,
//   lighting, lighting_has, load, load_hit, load_start, material_of, next_list, path_of, paths, slot, start_fences,
//   store, store_departure, store_start, vertex_of

@compute @workgroup_size(64)
fn surface(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let index = path_of(group, lane);
    if (index == NO_PATH) {
        return;
    }
    let start = load_start(index);
    if (!has(start.flags, PATH_ALIVE)) {
        return;
    }
    let ray = Ray(start.position, load(index, DIRECTION).xyz);
    let hit = load_hit(index);
    let first = load(index, FIRST);
    let behind = distance_from_camera(first.w, dispatch.surface);
    let kind = classify_hit(ray, hit, has(start.flags, PATH_ON_GROUND), behind);
    if (kind == OTHER_BRICK) {
        return;
    }
    let radiance = load(index, RADIANCE);
    let left_over = load(index, THROUGHPUT).x;
    let shown = background();
    if (kind == HIT_NOTHING) {
        store(index, RADIANCE, radiance + vec4f(left_over * shown, 0.0));
        store_start(index, vec3f(0.0), 0u);
        return;
    }
    let vertex = vertex_of(index, ray, hit, kind, start.flags, behind);
    let material = material_of(vertex);
    let is_caught = kind == HIT_GROUND && lighting_has(LIGHTING_CATCHER);
    let is_emitter = material.kind == EMISSIVE;
    let far = first.w + vertex.distance;
    let fade = faded(far);
    let weight = left_over * vertex.opacity;
    let rest = left_over - weight;
    let lit = weight * (1.0 - fade);
    let open = select(lighting.ambient, vec3f(0.0), lighting.occlusion_samples > 0u);
    let own = select(open, vec3f(material.parameter), is_emitter);
    let is_last = dispatch.is_last != 0u || is_caught || rest <= 0.0;
    let through = select(0.0, rest, dispatch.is_last != 0u) * shown;
    let seen = weight * fade * lighting.cue_color + lit * vertex.color * own + through;
    let added = select(vec4f(seen, weight), vec4f(left_over * shown, 0.0), is_caught);
    store(index, RADIANCE, radiance + added);
    let is_first = dispatch.surface == 0u && !is_caught;
    store(index, FIRST, vec4f(select(first.rgb, min(vertex.color, vec3f(1.0)), is_first), far));
    let exit_distance = exit_distance_of(vertex, ray.direction);
    store_departure(index, Departure(vertex.id, vertex.shape_index, exit_distance, bitcast<u32>(vertex.sphere.w)));
    store(index, THROUGHPUT, vec4f(rest, lit, 0.0, 0.0));
    store(index, NORMAL, vec4f(vertex.normal, 0.0));
    store(index, ALBEDO, vec4f(vertex.color * lit, select(0.0, left_over, is_caught)));
    let share = select(0.0, material.parameter, material.kind == LAMBERT);
    paths[slot(index, LOBE)] = vec4u(bitcast<vec2u>(vec2f(share, material.alpha)), material.energies, 0u);
    let next_flags = select(PATH_ALIVE, 0u, is_last) | select(PATH_INSIDE, 0u, vertex.is_back || kind == HIT_GROUND);
    // A surface that is not opaque hides no light.
    let is_closed = vertex.is_back && vertex.opacity >= 1.0;
    let is_back = select(0u, PATH_BACK, is_closed);
    let on_ground = select(0u, PATH_ON_GROUND, kind == HIT_GROUND);
    store_start(index, vertex.position, next_flags | is_back | on_ground);
    if (has(next_flags, PATH_ALIVE)) {
        append(next_list(), index);
    }
    if (!is_emitter) {
        append(LIST_OF_LIGHT, index);
    }
}
