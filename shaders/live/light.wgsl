// The light on a surface of a live picture. All lamps shine as from their middle, as if nothing hid them; one of them,
// chosen by how much it contributes, is tested, and so are some directions of ambient light. Twin: src/cpu/light/live.rs.
// provides: Lit, lit_surface
// needs: CameraRay, Departure, EMISSIVE, LAMBERT, LAMP_HEAD, LIGHTING_SHADOWS, Lamp, NO_EMITTER, NO_ID, PATH_BACK,
//   PATH_ON_GROUND, Seen, Shades, Start, Vertex, axes_around, cosine_direction, excluded_by, exit_distance_of, faded,
//   is_caught, is_hidden, lamp_kind, light_at, lighting, lighting_has, luminance, material_of, reflected, sample_lamp,
//   sample_pair, shade_of_ambient, shade_of_lamp, table, to_world, unit2

struct Lit {
    shades: Shades,
    // The visible shares of lamps and of ambient light, from one ray and from a few.
    shares: vec2f,
}

// A choice among lamps, each with the probability of its weight.
struct Choice {
    light: u32,
    total: f32,
    // What is left of the random number.
    u: f32,
}

fn choose(choice: Choice, light: u32, weight: f32) -> Choice {
    let total = choice.total + weight;
    let share = weight / max(total, 1e-30);
    let takes = weight > 0.0 && choice.u < share;
    let rest = select((choice.u - share) / max(1.0 - share, 1e-7), choice.u / max(share, 1e-30), takes);
    return Choice(select(choice.light, light, takes), total, clamp(rest, 0.0, 0x1.fffffep-1));
}

fn lit_by_lamps(seen: Seen, before: Shades, seed: u32, number: u32) -> Lit {
    let share = select(0.0, seen.material.parameter, seen.material.kind == LAMBERT);
    let lobe = vec3f(share, seen.material.alpha, bitcast<f32>(seen.material.energies));
    let normal = seen.vertex.normal;
    var shades = before;
    var choice = Choice(0u, 0.0, unit2(sample_pair(seed, number, 2u + 4094u)).x);
    for (var light = 0u; light < (number >> 31u) + lighting.light_count; light++) {
        var lamp = sample_lamp(light, seen.start.position, vec2u(0x80000000u));
        let is_head = lamp_kind(light) == LAMP_HEAD;
        if (is_head) {
            lamp = Lamp(seen.out, 0.0, table(3u * light + 1u).rgb, 0.0);
        }
        let bright = lamp.strength * reflected(lobe, normal, seen.out, lamp.direction, seen.albedo, seen.weight);
        let is_cast = dot(normal, lamp.direction) > 0.0 && !is_head && lighting_has(LIGHTING_SHADOWS);
        let open = vec4f(select(bright, vec3f(0.0), seen.is_caught), 0.0);
        let shade = select(vec4f(0.0), shade_of_lamp(light, seen), is_cast);
        shades.steady += select(open, shade, is_cast);
        shades.lamps += select(vec4f(0.0), open - shade, is_cast);
        choice = choose(choice, light, select(0.0, luminance(open.rgb) + shade.w, is_cast));
    }
    let lamp = sample_lamp(choice.light, seen.start.position, sample_pair(seed, number, 2u + choice.light));
    // A point of the lamp behind the surface is hidden.
    var is_dark = dot(normal, lamp.direction) <= 0.0;
    if (choice.total > 0.0 && !is_dark) {
        let to_center = seen.vertex.sphere.w * normal;
        is_dark = is_hidden(seen.start, seen.excluded, to_center, lamp.direction, lamp.distance);
    }
    return Lit(shades, vec2f(select(1.0, 0.0, choice.total > 0.0 && is_dark), 1.0));
}

// The share of some directions of ambient light that nothing hides.
fn open_share(seen: Seen, seed: u32, number: u32) -> f32 {
    let axes = axes_around(seen.vertex.normal);
    let to_center = seen.vertex.sphere.w * seen.vertex.normal;
    var open = 0u;
    for (var i = 0u; i < (number >> 31u) + lighting.occlusion_samples; i++) {
        let u = sample_pair(seed, number * lighting.occlusion_samples + i, 2u + 4095u);
        let direction = to_world(axes, cosine_direction(u));
        open += u32(!is_hidden(seen.start, seen.excluded, to_center, direction, lighting.occlusion_radius));
    }
    return f32(open) / f32(max(lighting.occlusion_samples, 1u));
}

// The light of a surface that a ray of the camera hits, before what is shown where there is none.
fn lit_surface(made: CameraRay, vertex: Vertex, shown: vec3f, seed: u32, number: u32) -> Lit {
    let material = material_of(vertex);
    let is_emitter = material.kind == EMISSIVE;
    let fade = faded(made.distance + vertex.distance);
    let weight = 1.0 - fade;
    let has_occlusion = lighting.occlusion_samples > 0u;
    let own = select(select(lighting.ambient, vec3f(0.0), has_occlusion), vec3f(material.parameter), is_emitter);
    let color = fade * lighting.cue_color + weight * vertex.color * own;
    let steady = select(vec4f(color, 1.0), vec4f(shown, 0.0), is_caught(vertex));
    var lit = Lit(Shades(steady, vec4f(0.0), vec4f(0.0)), vec2f(1.0));
    if (!is_emitter) {
        let on_ground = select(0u, PATH_ON_GROUND, vertex.id == NO_ID);
        let start = Start(vertex.position, select(0u, PATH_BACK, vertex.is_back) | on_ground);
        let exit = exit_distance_of(vertex, made.ray.direction);
        let excluded = excluded_by(Departure(vertex.id, vertex.shape_index, exit, NO_EMITTER));
        let caught = is_caught(vertex);
        let albedo = vertex.color * weight;
        let out = -made.ray.direction;
        let seen = Seen(vertex, material, start, excluded, out, albedo, weight, caught, light_at(vertex));
        lit = lit_by_lamps(seen, lit.shades, seed, number);
        // A branch must not depend on this uniform alone; see docs/explain/drivers.md.
        if ((number >> 31u) + lighting.occlusion_samples > 0u) {
            lit.shares.y = open_share(seen, seed, number);
            let open = vec4f(albedo * lighting.ambient, 0.0);
            let shade = select(vec4f(0.0), shade_of_ambient(1.0, seen), caught);
            lit.shades.steady += shade;
            lit.shades.ambient = select(open, -shade, caught);
        }
    }
    return lit;
}
