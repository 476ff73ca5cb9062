// What a surface in a studio receives of the light from all directions, in one pass. Twin: src/cpu/light/studio.rs.
// provides: Seen, open_share
// needs: Excluded, Material, Start, Vertex, axes_around, cosine_direction, is_hidden, lighting, sample_pair, to_world

// A surface that the camera sees.
struct Seen {
    vertex: Vertex,
    material: Material,
    start: Start,
    excluded: Excluded,
    // Unit vector towards the camera.
    out: vec3f,
    // The colour times the weight.
    albedo: vec3f,
    // How much of the surface is seen behind depth cueing.
    weight: f32,
}

// The share of the directions of ambient light that no sphere occludes.
fn open_share(seen: Seen, seed: u32, number: u32) -> f32 {
    let axes = axes_around(seen.vertex.normal);
    let to_center = seen.vertex.sphere.w * seen.vertex.normal;
    var hidden = 0u;
    for (var i = 0u; i < (number >> 31u) + lighting.occlusion_samples; i++) {
        let u = sample_pair(seed, number * lighting.occlusion_samples + i, 2u + 4095u);
        let direction = to_world(axes, cosine_direction(u));
        hidden += u32(is_hidden(seen.start, seen.excluded, to_center, direction, lighting.occlusion_radius));
    }
    return f32(lighting.occlusion_samples - hidden) / f32(lighting.occlusion_samples);
}
