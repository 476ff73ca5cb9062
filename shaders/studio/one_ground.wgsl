// The ground of a studio, in one pass. Twin: src/cpu/light/studio.rs.

//// none
// There is no ground.
// provides: is_caught, is_ground, light_at, shade_of_ambient, shade_of_lamp
// needs: CameraRay, Hit, Seen, Vertex

fn is_ground(made: CameraRay, hit: Hit) -> bool {
    return false;
}

fn is_caught(vertex: Vertex) -> bool {
    return false;
}

fn light_at(vertex: Vertex) -> f32 {
    return 1.0;
}

fn shade_of_lamp(light: u32, seen: Seen) -> vec4f {
    return vec4f(0.0);
}

fn shade_of_ambient(hidden: f32, seen: Seen) -> vec4f {
    return vec4f(0.0);
}

//// any
// The ground is a surface or a shadow catcher.
// provides: is_caught, is_ground, light_at, shade_of_ambient, shade_of_lamp
// needs: CameraRay, Hit, LIGHTING_CATCHER, NO_HIT, NO_ID, Seen, Vertex, caught, central_light, ground_distance,
//   light_to_catch, lighting, lighting_has, luminance

// Whether a ray of the camera hits the ground before any sphere.
fn is_ground(made: CameraRay, hit: Hit) -> bool {
    let sphere_distance = select(hit.distance + hit.t, NO_HIT, hit.id == NO_ID);
    return made.is_seen && ground_distance(made.ray, made.distance) < sphere_distance;
}

// Whether only shadows are seen of a surface.
fn is_caught(vertex: Vertex) -> bool {
    return vertex.id == NO_ID && lighting_has(LIGHTING_CATCHER);
}

// The luminance of all lights on a shadow catcher.
fn light_at(vertex: Vertex) -> f32 {
    return light_to_catch(is_caught(vertex), vertex.position);
}

// What a lamp that is hidden changes.
fn shade_of_lamp(light: u32, seen: Seen) -> vec4f {
    let shade = caught(central_light(light, seen.start.position) / seen.light, 1.0);
    return select(vec4f(0.0), shade, seen.is_caught);
}

// What it changes that a share of the directions of ambient light is hidden.
fn shade_of_ambient(hidden: f32, seen: Seen) -> vec4f {
    return caught(hidden * luminance(lighting.ambient) / seen.light, 1.0);
}
