// A sky without an image. Twin: src/light/sky.rs.

fn sky_radiance(direction: vec3f) -> vec3f {
    let end = select(look.nadir, look.zenith, direction.y >= 0.0);
    return mix(look.horizon, end, abs(direction.y));
}

// It is found by chance alone.
fn sky_density(direction: vec3f) -> f32 {
    return 0.0;
}

fn sample_sky(u: vec2u) -> vec4f {
    return vec4f(0.0);
}
