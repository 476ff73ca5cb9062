// The sample of a ray that hits an opaque surface in a studio, in one pass. Twin: src/cpu/light/studio.rs.
// provides: Sample, surface_sample
// needs: CameraRay, Departure, EMISSIVE, Material, NO_EMITTER, NO_ID, PATH_BACK, PATH_ON_GROUND, Ray, Seen, Start,
//   Vertex, ambient_light, excluded_by, exit_distance_of, faded, is_caught, lamp_light, light_at, lighting,
//   material_of

struct Sample {
    // Colour and opacity.
    radiance: vec4f,
    // Albedo of the surface.
    albedo: vec3f,
}

// Adds the light that a surface reflects which does not emit, in the order in which several passes add it.
fn add_light(to: vec4f, vertex: Vertex, material: Material, ray: Ray, lit: f32, seed: u32, number: u32) -> vec4f {
    let albedo = vertex.color * lit;
    let on_ground = select(0u, PATH_ON_GROUND, vertex.id == NO_ID);
    let start = Start(vertex.position, select(0u, PATH_BACK, vertex.is_back) | on_ground);
    let departure = Departure(vertex.id, vertex.shape_index, exit_distance_of(vertex, ray.direction), NO_EMITTER);
    let excluded = excluded_by(departure);
    let seen = Seen(
        vertex,
        material,
        start,
        excluded,
        -ray.direction,
        albedo,
        lit,
        is_caught(vertex),
        light_at(vertex),
    );
    var light = to + lamp_light(seen, seed, number);
    if ((number >> 31u) + lighting.occlusion_samples > 0u) {
        light += ambient_light(seen, seed, number);
    }
    return light;
}

// The sample of a ray that hits a surface, before what is shown where there is none.
fn surface_sample(made: CameraRay, vertex: Vertex, shown: vec3f, seed: u32, number: u32) -> Sample {
    let material = material_of(vertex);
    let is_emitter = material.kind == EMISSIVE;
    let fade = faded(made.distance + vertex.distance);
    let lit = 1.0 - fade;
    let open = select(lighting.ambient, vec3f(0.0), lighting.occlusion_samples > 0u);
    let own = select(open, vec3f(material.parameter), is_emitter);
    let color = fade * lighting.cue_color + lit * vertex.color * own;
    var radiance = select(vec4f(color, 1.0), vec4f(shown, 0.0), is_caught(vertex));
    if (!is_emitter) {
        radiance = add_light(radiance, vertex, material, made.ray, lit, seed, number);
    }
    return Sample(radiance, select(min(vertex.color, vec3f(1.0)), vec3f(0.0), is_caught(vertex)));
}
