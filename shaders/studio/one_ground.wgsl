// The ground of a studio, which is a surface or a shadow catcher, in one pass. Twin: src/cpu/light/studio.rs.
// provides: is_caught, is_ground, light_at, shade_of_ambient, shade_of_lamp
// needs: CameraRay, Hit, LIGHTING_CATCHER, NO_HIT, NO_ID, Seen, Vertex, caught, central_light, ground_distance,
//   light_to_catch, lighting, lighting_has, luminance

override HAS_GROUND: bool;

// Whether a ray of the camera hits the ground before any sphere.
fn is_ground(made: CameraRay, hit: Hit) -> bool {
    let sphere_distance = select(hit.distance + hit.t, NO_HIT, hit.id == NO_ID);
    return HAS_GROUND && made.is_seen && ground_distance(made.ray, made.distance) < sphere_distance;
}

// Whether only shadows are seen of a surface.
fn is_caught(vertex: Vertex) -> bool {
    return HAS_GROUND && vertex.id == NO_ID && lighting_has(LIGHTING_CATCHER);
}

// The luminance of all lights on a shadow catcher.
fn light_at(vertex: Vertex) -> f32 {
    var light = 1.0;
    if (HAS_GROUND) {
        light = light_to_catch(is_caught(vertex), vertex.position);
    }
    return light;
}

// What a lamp that is hidden changes.
fn shade_of_lamp(light: u32, seen: Seen) -> vec4f {
    var shade = vec4f(0.0);
    if (HAS_GROUND) {
        let all = caught(central_light(light, seen.start.position) / seen.light, 1.0);
        shade = select(vec4f(0.0), all, seen.is_caught);
    }
    return shade;
}

// What it changes that a share of the directions of ambient light is hidden.
fn shade_of_ambient(hidden: f32, seen: Seen) -> vec4f {
    var shade = vec4f(0.0);
    if (HAS_GROUND) {
        shade = caught(hidden * luminance(lighting.ambient) / seen.light, 1.0);
    }
    return shade;
}
