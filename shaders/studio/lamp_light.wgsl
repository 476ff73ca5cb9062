// The light of all lamps that a surface reflects to the camera, in one pass. Software devices compute both sides of every
// branch, so what most pictures need has a pipeline of its own. Twin: src/cpu/light/studio.rs.
// provides: lamp_light
// needs: LAMBERT, LAMP_HEAD, LIGHTING_SHADOWS, Lamp, Seen, fence3, is_hidden, lamp_kind, lighting, lighting_has,
//   reflected, sample_lamp, sample_pair, shade_of_lamp, table

// Whether all lamps are at the eye or infinitely far away, have no size and cast no shadows, and all surfaces are matt.
override IS_SHARP: bool;

fn lamp_light(seen: Seen, seed: u32, number: u32) -> vec4f {
    var sum: vec4f;
    if (IS_SHARP) {
        sum = sharp_light(seen, number);
    } else {
        sum = soft_light(seen, seed, number);
    }
    return sum;
}

fn sharp_light(seen: Seen, number: u32) -> vec4f {
    var sum = vec4f(0.0);
    for (var light = 0u; light < (number >> 31u) + lighting.light_count; light++) {
        let away = fence3(normalize(table(3u * light).xyz));
        let direction = select(away, seen.out, lamp_kind(light) == LAMP_HEAD);
        let cosine = max(dot(seen.vertex.normal, direction), 0.0);
        sum += vec4f(table(3u * light + 1u).rgb * (cosine * seen.albedo), 0.0);
    }
    return sum;
}

// The light of lamps of all kinds, with shadows, on surfaces that may have a specular lobe.
fn soft_light(seen: Seen, seed: u32, number: u32) -> vec4f {
    let share = select(0.0, seen.material.parameter, seen.material.kind == LAMBERT);
    let lobe = vec3f(share, seen.material.alpha, bitcast<f32>(seen.material.energies));
    let normal = seen.vertex.normal;
    var sum = vec4f(0.0);
    for (var light = 0u; light < (number >> 31u) + lighting.light_count; light++) {
        let u = sample_pair(seed, number, 2u + light);
        var lamp = sample_lamp(light, seen.start.position, u);
        let is_head = lamp_kind(light) == LAMP_HEAD;
        if (is_head) {
            lamp = Lamp(seen.out, 0.0, table(3u * light + 1u).rgb, 0.0);
        }
        // A light behind the surface needs no search.
        let is_before = dot(normal, lamp.direction) > 0.0;
        let is_cast = is_before && !is_head && lighting_has(LIGHTING_SHADOWS);
        let to_center = seen.vertex.sphere.w * normal;
        if (is_cast && is_hidden(seen.start, seen.excluded, to_center, lamp.direction, lamp.distance)) {
            sum += shade_of_lamp(light, seen);
            continue;
        }
        let bright = lamp.strength * reflected(lobe, normal, seen.out, lamp.direction, seen.albedo, seen.weight);
        sum += vec4f(select(bright, vec3f(0.0), seen.is_caught), 0.0);
    }
    return sum;
}
