// Light that a path meets by chance. Twin: src/cpu/light/path.rs.
// provides: chance_weight, light_from_afar
// needs: LAMP_DIRECTIONAL, LIGHTING_SKY_SEEN, LIGHTING_TRANSPARENT, LIGHT_CHANCE, LIGHT_DIRECT, PATH_FULL,
//   PATH_SCATTERED, PI, has, lamp_kind, lighting, lighting_has, sky_density, sky_radiance, table

// What it counts, if it was scattered there with a density and might have been looked for with another: the balance
// heuristic (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995).
fn chance_weight(flags: u32, scattered: f32, looked_for: f32) -> f32 {
    let balanced = scattered / max(scattered + looked_for, 1e-30);
    let weight = select(balanced, 0.0, lighting.light_sampling == LIGHT_DIRECT);
    return select(weight, 1.0, has(flags, PATH_FULL) || lighting.light_sampling == LIGHT_CHANCE || looked_for == 0.0);
}

// The radiance from infinitely far away.
fn light_from_afar(direction: vec3f, flags: u32, density: f32) -> vec3f {
    let is_seen = !has(flags, PATH_SCATTERED);
    if (is_seen && !lighting_has(LIGHTING_SKY_SEEN)) {
        return select(lighting.background, vec3f(0.0), lighting_has(LIGHTING_TRANSPARENT));
    }
    let sources = f32(max(lighting.source_count, 1u));
    var sum = sky_radiance(direction) * chance_weight(flags, density, sky_density(direction) / sources);
    // If the number came from a uniform alone, Mesa's lavapipe would build the kernel anew for every dispatch.
    let count = select(lighting.light_count, 0u, is_seen && lighting_has(LIGHTING_TRANSPARENT));
    for (var light = 0u; light < count; light++) {
        let light_record = table(3u * light);
        let power = table(3u * light + 1u);
        let k = power.w;
        let aside = direction - light_record.xyz;
        // |d - a|^2 is twice 1 minus the cosine, and does not cancel.
        let is_sun = lamp_kind(light) == LAMP_DIRECTIONAL && k > 0.0;
        let is_met = is_sun && dot(aside, aside) <= 2.0 * k;
        let weight = chance_weight(flags, density, 1.0 / (2.0 * PI * max(k, 1e-30) * sources));
        let radiance = power.rgb / max(k * (2.0 - k), 1e-30);
        sum += select(vec3f(0.0), radiance * weight, is_met);
    }
    return select(sum, vec3f(0.0), is_seen && lighting_has(LIGHTING_TRANSPARENT));
}
