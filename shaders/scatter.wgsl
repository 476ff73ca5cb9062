// What a path meets, what light it finds there, and where it goes on. Twin: src/cpu/lit/path.rs.

// Ends the path.
fn end(index: u32, radiance: vec3f, alpha: f32) {
    store(index, RADIANCE, radiance, alpha);
    store(index, ORIGIN, vec3f(0.0), bitcast<f32>(0u));
}

// Lets the path go on from a point, on one side of it.
fn go_on(index: u32, at: Vertex, hit: Hit, through: vec3f, is_behind: bool, flags: u32) {
    let is_sphere = at.sphere.w > 0.0;
    let side = select(0u, PATH_INSIDE, is_sphere && is_behind != at.is_back);
    let on = side | select(PATH_ON_GROUND, 0u, is_sphere) | PATH_ALIVE | flags;
    store(index, ORIGIN, at.position, bitcast<f32>(on));
    store(index, LEFT, at.sphere.xyz, at.sphere.w);
    store(index, THROUGHPUT, through, bitcast<f32>(hit.place));
    store(index, SURFACE, vec3f(0.0), bitcast<f32>(hit.id));
}

@compute @workgroup_size(64)
fn scatter(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    let index = hit_index(pixel);
    let origin = load(index, ORIGIN);
    let flags = bitcast<u32>(origin.w);
    if (any(pixel >= frame.tile_size) || !has(flags, PATH_ALIVE)) {
        return;
    }
    let direction = load(index, DIRECTION);
    let ray = Ray(origin.xyz, direction.xyz);
    let hit = load_hit(index);
    let behind = come_from_camera(index);
    let met = what_is_met(ray, hit, has(flags, PATH_ON_GROUND), behind);
    if (met == NOBODY) {
        return;
    }
    var radiance = settled(index);
    var through = load(index, THROUGHPUT).rgb;
    store(index, PENDING, vec3f(0.0), 0.0);
    if (met == NOTHING_MET) {
        end(index, radiance.rgb + through * light_from_afar(ray.direction, flags, direction.w), radiance.a);
        return;
    }
    var vertex = ground_vertex(ray, behind);
    if (met == GROUND_MET) {
        // No other brick is to take the sphere behind for what is met.
        store_hit(index, Hit(NO_HIT, NO_ID, 0u, 0.0));
    } else {
        vertex = sphere_vertex(ray, hit, has(flags, PATH_INSIDE) && hit.id == bitcast<u32>(load(index, SURFACE).w));
    }
    through *= exp(-load(index, MEDIUM).xyz * vertex.distance);
    let seed = pixel_seed(frame.tile_origin + pixel, look.seed);
    let chance = unit2(sample_pair(seed, stage.sample, 3u + 8u * stage.surface));
    let scattered = flags & PATH_SCATTERED;
    if (chance.y >= vertex.opacity) {
        store(index, RADIANCE, radiance.rgb, radiance.a);
        go_on(index, vertex, hit, through, true, PATH_FULL | scattered);
        return;
    }
    if (scattered == 0u && radiance.a == 0.0) {
        let first = load(index, FIRST);
        store(index, FIRST, min(vertex.color, vec3f(1.0)), first.w);
    }
    let at = Surface(vertex, material_of(vertex), axes_around(vertex.normal));
    if (at.material.kind == EMISSIVE) {
        let density = known_density(hit.id, ray.origin);
        let light = vertex.color * at.material.parameter * chance_weight(flags, direction.w, density);
        end(index, radiance.rgb + through * light, 1.0);
        return;
    }
    radiance.a = 1.0;
    radiance += vec4f(through * head_light(at, -ray.direction, scattered), 0.0);
    if (stage.is_last != 0u) {
        end(index, radiance.rgb, 1.0);
        return;
    }
    store(index, RADIANCE, radiance.rgb, 1.0);
    look_for_light(index, -ray.direction, at, through, seed);
    bounce(index, at, hit, -ray.direction, chance.x, through, seed);
}
