// Light that a scattered ray hits, weighted by multiple importance sampling. Twin: src/cpu/light/path.rs.
// provides: light_of_miss, weight_of_hit_light
// needs: LAMP_DIRECTIONAL, LIGHTING_SKY_SEEN, LIGHTING_TRANSPARENT, LIGHT_CHANCE, LIGHT_DIRECT, PATH_FULL,
//   PATH_SCATTERED, PI, background, has, lamp_kind, lighting, lighting_has, sky_density, sky_radiance, table

// The weight of light that a ray hits, from the density with which the ray was scattered there and the density with
// which light sampling would have chosen it: the balance heuristic (Veach and Guibas, "Optimally Combining Sampling
// Techniques for Monte Carlo Rendering", 1995).
fn weight_of_hit_light(flags: u32, scattered: f32, light_density: f32) -> f32 {
    let balanced = scattered / max(scattered + light_density, 1e-30);
    let weight = select(balanced, 0.0, lighting.light_sampling == LIGHT_DIRECT);
    return select(weight, 1.0, has(flags, PATH_FULL) || lighting.light_sampling == LIGHT_CHANCE || light_density == 0.0);
}

// The radiance of a ray that hits nothing: the sky, and suns with an angular radius.
fn light_of_miss(direction: vec3f, flags: u32, density: f32) -> vec3f {
    let is_seen = !has(flags, PATH_SCATTERED);
    if (is_seen && !lighting_has(LIGHTING_SKY_SEEN)) {
        return background();
    }
    let sources = f32(max(lighting.source_count, 1u));
    var sum = sky_radiance(direction) * weight_of_hit_light(flags, density, sky_density(direction) / sources);
    // If this number depended on a uniform only, Mesa's lavapipe would compile the kernel again for every dispatch.
    let count = select(lighting.light_count, 0u, is_seen && lighting_has(LIGHTING_TRANSPARENT));
    for (var light = 0u; light < count; light++) {
        let light_record = table(3u * light);
        let power = table(3u * light + 1u);
        let k = power.w;
        let aside = direction - light_record.xyz;
        // |d - a|^2 is 2 (1 - cosine), computed without cancellation.
        let is_sun = lamp_kind(light) == LAMP_DIRECTIONAL && k > 0.0;
        let is_hit = is_sun && dot(aside, aside) <= 2.0 * k;
        let weight = weight_of_hit_light(flags, density, 1.0 / (2.0 * PI * max(k, 1e-30) * sources));
        let radiance = power.rgb / max(k * (2.0 - k), 1e-30);
        sum += select(vec3f(0.0), radiance * weight, is_hit);
    }
    return select(sum, vec3f(0.0), is_seen && lighting_has(LIGHTING_TRANSPARENT));
}
