// A sky with an image. Twin: src/light/sky.rs.

fn sky_radiance(direction: vec3f) -> vec3f {
    return lighting.environment_strength * environment_radiance(direction);
}

fn sky_density(direction: vec3f) -> f32 {
    return environment_density(direction);
}

// A direction, and the density with which it is chosen.
fn sample_sky(u: vec2u) -> vec4f {
    let found = sample_environment(u);
    return vec4f(found.direction, found.density);
}
