// In a studio: what is between a surface and a light, as far as it needs no search.

// `light` is added if nothing is, or what `opacity` says if something is; a distance of 0 is not searched.
fn look_for(index: u32, direction: vec3f, distance: f32, light: vec3f, opacity: f32) {
    let origin = load(index, ORIGIN);
    let flags = bitcast<u32>(origin.w);
    let to_far_wall = max(2.0 * dot(load(index, LEFT).xyz - origin.xyz, direction), 0.0);
    let is_in_own = has(flags, PATH_BACK) && to_far_wall < distance;
    let to_ground = ground_distance(Ray(origin.xyz, direction), 0.0);
    let is_below = !has(flags, PATH_ON_GROUND) && to_ground < distance;
    let is_hidden = is_in_own || is_below;
    store(index, SHADOW, direction, select(distance, 0.0, is_hidden));
    store(index, PENDING, light, select(1.0, 0.0, is_hidden));
    store(index, NORMAL, load(index, NORMAL).xyz, opacity);
}

// How bright a light is on a surface, by its middle; of a head light, which casts no shadow, nothing.
fn central_light(light: u32, position: vec3f, normal: vec3f) -> f32 {
    let place = tables[3u * light];
    let power = tables[3u * light + 1u];
    let kind = bitcast<u32>(place.w);
    let toward = place.xyz - position;
    let distance = sqrt(max(dot(toward, toward), 1e-30));
    let cone = select(cone_of_sphere(power.w, distance), 2.0, distance <= power.w);
    let far = select(1.0 / (distance * distance), 2.0 * cone, kind == LAMP_SPHERE);
    let is_sun = kind == LAMP_DIRECTIONAL;
    let axis = select(toward / distance, place.xyz, is_sun);
    let strength = select(far, 2.0 / (2.0 - power.w), is_sun);
    let is_lamp = kind != LAMP_HEAD;
    return select(0.0, luminance(power.rgb) * strength * max(dot(normal, axis), 0.0), is_lamp);
}

// What all light together is on a ground that catches shadows; 0 elsewhere.
fn light_to_catch(is_caught: bool, position: vec3f) -> f32 {
    var sum = select(0.0, luminance(look.ambient), is_caught);
    for (var light = 0u; light < select(0u, look.light_count, is_caught); light++) {
        sum += central_light(light, position, look.ground_normal);
    }
    return sum;
}

// What a shadow of a share of all light does to a background that is seen through the ground.
fn caught(share: f32, total: f32, left_over: f32) -> vec4f {
    let alpha = left_over * share / max(total, 1e-30);
    let behind = select(alpha, 0.0, is_look(LOOK_TRANSPARENT)) * look.background;
    return vec4f(-behind, alpha);
}
