// The light of all lamps that a surface, which may have a specular lobe, reflects to the camera, with shadows and
// in one pass. Twin: src/cpu/light/studio.rs.
// provides: lamp_light
// needs: LAMBERT, LAMP_HEAD, LIGHTING_SHADOWS, Lamp, Seen, is_hidden, lamp_kind, lighting, lighting_has, reflected,
//   sample_lamp, sample_pair, shade_of_lamp, table

fn lamp_light(seen: Seen, seed: u32, number: u32) -> vec4f {
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
