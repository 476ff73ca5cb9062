// Radiance and sampling of the sky. Twin: src/light/mod.rs.

//// plain
// Sky of constant colour or with a vertical gradient.
// provides: sample_sky, sky_density, sky_radiance
// needs: lighting

fn sky_radiance(direction: vec3f) -> vec3f {
    let end = select(lighting.nadir, lighting.zenith, direction.y >= 0.0);
    return mix(lighting.horizon, end, abs(direction.y));
}

// The density is 0, because light sampling never chooses this sky.
fn sky_density(direction: vec3f) -> f32 {
    return 0.0;
}

fn sample_sky(u: vec2u) -> vec4f {
    return vec4f(0.0);
}

//// image
// Sky with an environment map.
// provides: sample_sky, sky_density, sky_radiance
// needs: environment_density, environment_radiance, lighting, sample_environment

fn sky_radiance(direction: vec3f) -> vec3f {
    return lighting.environment_strength * environment_radiance(direction);
}

fn sky_density(direction: vec3f) -> f32 {
    return environment_density(direction);
}

// A random direction, and its density.
fn sample_sky(u: vec2u) -> vec4f {
    let found = sample_environment(u);
    return vec4f(found.direction, found.density);
}
