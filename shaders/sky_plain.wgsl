// A sky without an image. Twin: src/light/sky.rs.

fn sky_radiance(direction: vec3f) -> vec3f {
    let end = select(lighting.nadir, lighting.zenith, direction.y >= 0.0);
    return mix(lighting.horizon, end, abs(direction.y));
}

// It is found by chance alone.
fn sky_density(direction: vec3f) -> f32 {
    return 0.0;
}

fn sample_sky(u: vec2u) -> vec4f {
    return vec4f(0.0);
}
