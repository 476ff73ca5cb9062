// A path that is kept in registers, and how it begins at the camera: as in `path/start.wgsl`. Twin:
// src/cpu/light/sample.rs.
// provides: Path, begin_path
// needs: Departure, LIGHTING_TRANSPARENT, NO_EMITTER, NO_ID, PATH_ALIVE, PATH_FULL, Ray, camera_ray, filter_offset,
//   lighting, lighting_has, sample_location, sample_pair, unit2

// A path whose next ray is to be traced, or that has ended.
struct Path {
    ray: Ray,
    // Sum of PATH_ flags.
    flags: u32,
    // Density with which the last surface scattered the ray.
    density: f32,
    through: vec3f,
    // Absorption of the glass that the ray is in.
    medium: vec3f,
    // Radiance of the sample so far, and its opacity.
    radiance: vec4f,
    // Albedo of the first surface, and the length of the ray so far; negative once the first surface is recorded.
    first: vec4f,
    departure: Departure,
    // Number of surfaces so far.
    surface: u32,
}

fn begin_path(pixel: vec2u, seed: u32, sample: u32) -> Path {
    let offset = filter_offset(sample_pair(seed, sample, 0u));
    let lens = unit2(sample_pair(seed, sample, 1u));
    let made = camera_ray(sample_location(pixel, offset), lens);
    let is_shown = !made.is_seen && !lighting_has(LIGHTING_TRANSPARENT);
    let flags = select(0u, PATH_ALIVE, made.is_seen) | PATH_FULL;
    let radiance = vec4f(select(vec3f(0.0), lighting.background, is_shown), 0.0);
    let first = vec4f(0.0, 0.0, 0.0, made.distance);
    let departure = Departure(NO_ID, 0u, 0.0, NO_EMITTER);
    return Path(made.ray, flags, 0.0, vec3f(1.0), vec3f(0.0), radiance, first, departure, 0u);
}
