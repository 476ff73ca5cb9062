// In a studio: what a ray meets, and what of it needs no further ray. Twin: src/cpu/lit/studio.rs.

// How much of the colour is lost in the distance.
fn faded(distance: f32) -> f32 {
    return clamp((distance - look.cue_near) * look.cue_scale, 0.0, 1.0);
}

// Leaves nothing to be lit, and nothing to be added.
fn finish(index: u32) {
    let radiance = settled(index);
    store(index, RADIANCE, radiance.rgb, radiance.a);
    store(index, PENDING, vec3f(0.0), 0.0);
    store(index, NORMAL, vec3f(0.0), 0.0);
    store(index, ORIGIN, vec3f(0.0), bitcast<f32>(0u));
}

@compute @workgroup_size(64)
fn surface(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    let index = hit_index(pixel);
    let origin = load(index, ORIGIN);
    let flags = bitcast<u32>(origin.w);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    if (!has(flags, PATH_ALIVE)) {
        // The surface before this was its last.
        finish(index);
        return;
    }
    let ray = Ray(origin.xyz, load(index, DIRECTION).xyz);
    let hit = load_hit(index);
    let behind = come_from_camera(index);
    let met = what_is_met(ray, hit, has(flags, PATH_ON_GROUND), behind);
    if (met == NOBODY) {
        return;
    }
    var radiance = settled(index);
    let left_over = load(index, THROUGHPUT).x;
    let background = select(left_over, 0.0, is_look(LOOK_TRANSPARENT)) * look.background;
    store(index, PENDING, vec3f(0.0), 0.0);
    if (met == NOTHING_MET) {
        finish(index);
        store(index, RADIANCE, radiance.rgb + background, radiance.a);
        return;
    }
    var vertex = ground_vertex(ray, behind);
    if (met == GROUND_MET) {
        // No other brick is to take the sphere behind for what is met.
        store_hit(index, Hit(NO_HIT, NO_ID, 0u, 0.0));
    } else {
        vertex = sphere_vertex(ray, hit, has(flags, PATH_INSIDE) && hit.id == bitcast<u32>(load(index, SURFACE).w));
    }
    let material = material_of(vertex);
    let first = load(index, FIRST);
    let far = first.w + vertex.distance;
    let fade = faded(far);
    let weight = left_over * vertex.opacity;
    let rest = left_over - weight;
    let lit = weight * (1.0 - fade);
    let is_caught = met == GROUND_MET && is_look(LOOK_CATCHER);
    let emitted = select(0.0, material.parameter, material.kind == EMISSIVE);
    let open = select(look.ambient, vec3f(0.0), look.occlusion_samples > 0u);
    let own = select(open, vec3f(emitted), material.kind == EMISSIVE);
    let is_last = stage.is_last != 0u || is_caught || rest <= 0.0;
    let through = select(vec3f(0.0), select(rest, 0.0, is_look(LOOK_TRANSPARENT)) * look.background, stage.is_last != 0u);
    let seen = weight * fade * look.cue_color + lit * vertex.color * own + through;
    radiance += select(vec4f(seen, weight), vec4f(background, 0.0), is_caught);
    store(index, RADIANCE, radiance.rgb, radiance.a);
    let is_first = stage.surface == 0u;
    store(index, FIRST, select(first.rgb, min(vertex.color, vec3f(1.0)), is_first && !is_caught), far);
    store(index, NORMAL, vertex.normal, 0.0);
    store(index, LEFT, vertex.sphere.xyz, vertex.sphere.w);
    // What is left for what is behind, and what this surface counts.
    store(index, THROUGHPUT, vec3f(rest, lit, 0.0), bitcast<f32>(hit.place));
    store(index, SURFACE, vertex.color * lit, bitcast<f32>(hit.id));
    let share = select(0.0, material.parameter, material.kind == LAMBERT);
    store(index, LOBE, vec3f(share, material.alpha, f32(material.energies)), select(0.0, left_over, is_caught));
    let goes_on = select(PATH_ALIVE, 0u, is_last) | select(PATH_INSIDE, 0u, vertex.is_back || met == GROUND_MET);
    let is_lit = select(PATH_LIT, 0u, material.kind == EMISSIVE) | select(0u, PATH_BACK, vertex.is_back);
    let on_ground = select(0u, PATH_ON_GROUND, met == GROUND_MET);
    store(index, ORIGIN, vertex.position, bitcast<f32>(goes_on | is_lit | on_ground));
}
