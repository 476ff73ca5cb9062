// What a surface in a studio reflects of the light from all directions, in one pass. Twin: src/cpu/light/studio.rs.
// provides: ambient_light
// needs: Seen, axes_around, cosine_direction, is_hidden, lighting, sample_pair, shade_of_ambient, to_world

// The light from the directions that nothing occludes.
fn ambient_light(seen: Seen, seed: u32, number: u32) -> vec4f {
    let axes = axes_around(seen.vertex.normal);
    let to_center = seen.vertex.sphere.w * seen.vertex.normal;
    var hidden = 0u;
    for (var i = 0u; i < (number >> 31u) + lighting.occlusion_samples; i++) {
        let u = sample_pair(seed, number * lighting.occlusion_samples + i, 2u + 4095u);
        let direction = to_world(axes, cosine_direction(u));
        hidden += u32(is_hidden(seen.start, seen.excluded, to_center, direction, lighting.occlusion_radius));
    }
    let share = 1.0 / f32(lighting.occlusion_samples);
    let count = f32(lighting.occlusion_samples);
    let open = vec4f(seen.albedo * lighting.ambient * (share * (count - f32(hidden))), 0.0);
    return select(open, shade_of_ambient(share * f32(hidden), seen), seen.is_caught);
}
