// Sampling the lights of the settings, which are not spheres of the scene, from a surface. Twin: src/cpu/light/sources.rs.
// provides: LAMP_DIRECTIONAL, LAMP_HEAD, LAMP_SPHERE, Lamp, lamp_kind, sample_lamp
// needs: NO_HIT, axes_around, cone_direction, cone_of_sphere, table, tables, to_world

const LAMP_HEAD: u32 = 0u;
const LAMP_DIRECTIONAL: u32 = 1u;
const LAMP_POINT: u32 = 2u;
const LAMP_SPHERE: u32 = 3u;

struct Lamp {
    // Unit vector towards the light.
    direction: vec3f,
    // Distance to the light.
    distance: f32,
    // Radiance that a white surface facing the light would reflect.
    strength: vec3f,
    // 1 minus the cosine of the angular radius of a sun; 0 for other lights.
    sun: f32,
}

fn lamp_kind(light: u32) -> u32 {
    return tables[3u * light].w;
}

// Light from a point of the light that `u` chooses.
fn sample_lamp(light: u32, position: vec3f, u: vec2u) -> Lamp {
    let light_record = table(3u * light);
    let power = table(3u * light + 1u);
    let kind = lamp_kind(light);
    if (kind == LAMP_DIRECTIONAL) {
        let k = power.w;
        let direction = to_world(axes_around(light_record.xyz), cone_direction(u, k));
        // The strength is radiance times solid angle divided by pi: strength / sin^2 * 2 k, with sin^2 = k (2 - k).
        return Lamp(direction, NO_HIT, power.rgb * (2.0 / (2.0 - k)), k);
    }
    let toward = light_record.xyz - position;
    let distance = sqrt(dot(toward, toward));
    let axis = toward / max(distance, 1e-30);
    if (kind == LAMP_POINT) {
        return Lamp(axis, distance, power.rgb / max(distance * distance, 1e-30), 0.0);
    }
    let radius = power.w;
    let is_inside = distance <= radius;
    let k = select(cone_of_sphere(radius, distance), 2.0, is_inside);
    let around = select(axis, vec3f(0.0, 0.0, 1.0), is_inside);
    let direction = to_world(axes_around(around), cone_direction(u, k));
    let middle = dot(toward, direction);
    let foot = toward - middle * direction;
    let half_chord = sqrt(max(radius * radius - dot(foot, foot), 0.0));
    let to_surface = middle + select(-half_chord, half_chord, is_inside);
    return Lamp(direction, max(to_surface, 0.0), power.rgb * (2.0 * k), 0.0);
}
