// Shadow catchers in a studio, which are grounds on which only shadows are visible.
// provides: caught, central_light, light_to_catch
// needs: LAMP_DIRECTIONAL, LAMP_HEAD, LAMP_SPHERE, LIGHTING_TRANSPARENT, cone_of_sphere, lamp_kind, lighting,
//   lighting_has, luminance, table

// The luminance that the centre of a light contributes to the ground. It is 0 for a light at the eye, which casts no
// shadow.
fn central_light(light: u32, position: vec3f) -> f32 {
    let light_record = table(3u * light);
    let power = table(3u * light + 1u);
    let kind = lamp_kind(light);
    let toward = light_record.xyz - position;
    let distance = sqrt(max(dot(toward, toward), 1e-30));
    let cone = select(cone_of_sphere(power.w, distance), 2.0, distance <= power.w);
    let far = select(1.0 / (distance * distance), 2.0 * cone, kind == LAMP_SPHERE);
    let is_sun = kind == LAMP_DIRECTIONAL;
    let axis = select(toward / distance, light_record.xyz, is_sun);
    let strength = select(far, 2.0 / (2.0 - power.w), is_sun);
    let light_there = luminance(power.rgb) * strength * max(dot(lighting.ground_normal, axis), 0.0);
    return select(light_there, 0.0, kind == LAMP_HEAD);
}

// The luminance that all lights together contribute, or 1 if there is no light, so that it can be a divisor.
fn light_to_catch(is_caught: bool, position: vec3f) -> f32 {
    var sum = luminance(lighting.ambient);
    for (var light = 0u; light < select(0u, lighting.light_count, is_caught); light++) {
        sum += central_light(light, position);
    }
    return select(sum, 1.0, sum == 0.0);
}

// The change of radiance and opacity if a share of all light is missing on the ground, behind which the background is
// visible.
fn caught(share: f32, left_over: f32) -> vec4f {
    let alpha = left_over * share;
    let behind = select(alpha, 0.0, lighting_has(LIGHTING_TRANSPARENT)) * lighting.background;
    return vec4f(-behind, alpha);
}
