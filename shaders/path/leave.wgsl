// What becomes of a path at a surface: it takes up the light that the surface emits, samples a light source, and is
// scattered, passes through or ends. Twin: src/cpu/light/path.rs.
// provides: Arrived, Onward, leave
// needs: DIELECTRIC, DirectLight, EMISSIVE, PATH_ALIVE, PATH_FULL, PATH_INSIDE, PATH_SCATTERED, Ray, Surface, Vertex,
//   axes_around, bounce, density_of_hit_emitter, exit_distance_of, has, head_light, material_of, sample_light,
//   sample_pair, side_of, transmittance, unit2, weight_of_hit_light

// A path that arrives at a surface.
struct Arrived {
    ray: Ray,
    // Density with which the surface before scattered the ray.
    density: f32,
    // Sum of PATH_ flags.
    flags: u32,
    through: vec3f,
    // Absorption of the glass that the ray is in.
    medium: vec3f,
    // Radiance of the sample so far, and its opacity.
    radiance: vec4f,
    // Albedo of the first surface, and the length of the ray so far; negative once the first surface is recorded.
    first: vec4f,
    seed: u32,
    sample: u32,
    // Number of surfaces before this one.
    surface: u32,
    is_last: bool,
}

// A path that leaves a surface.
struct Onward {
    position: vec3f,
    flags: u32,
    direction: vec3f,
    density: f32,
    through: vec3f,
    medium: vec3f,
    light: DirectLight,
    radiance: vec4f,
    first: vec4f,
    // Distance to the far side of the sphere that it starts on, if it goes inside.
    exit_distance: f32,
}

fn leave(path: Arrived, vertex: Vertex) -> Onward {
    let at = Surface(vertex, material_of(vertex), axes_around(vertex.normal), path.surface);
    let arriving = path.through * transmittance(path.medium, vertex.distance);
    let chance = unit2(sample_pair(path.seed, path.sample, 3u + 8u * path.surface));
    let scattered = path.flags & PATH_SCATTERED;
    let is_passed = chance.y >= vertex.opacity;
    let is_emitter = at.material.kind == EMISSIVE;
    let out = -path.ray.direction;

    var light = head_light(at, out, scattered);
    if (is_emitter) {
        let density = density_of_hit_emitter(vertex.id, path.ray.origin);
        light = vertex.color * at.material.parameter * weight_of_hit_light(path.flags, path.density, density);
    }
    let is_first = !is_passed && scattered == 0u && path.first.w >= 0.0;
    let is_end = path.is_last || (is_emitter && !is_passed);
    var next = bounce(at, out, chance.x, arriving, path.seed, path.sample, path.medium);
    next.light = sample_light(at, out, arriving, path.seed, path.sample, is_end || is_passed);
    if (is_passed) {
        next.position = vertex.position;
        next.flags = PATH_FULL | PATH_ALIVE | scattered | side_of(at, true);
        next.direction = path.ray.direction;
        next.density = 0.0;
        next.through = arriving;
        // Glass ends at its far side, even if the path passes through that side.
        next.medium = select(path.medium, vec3f(0.0), at.material.kind == DIELECTRIC && vertex.is_back);
    }
    next.flags = select(next.flags, next.flags & ~PATH_ALIVE, is_end);
    next.radiance = select(vec4f(path.radiance.rgb + arriving * light, 1.0), path.radiance, is_passed);
    // A negative length means that the first surface has been recorded.
    next.first = select(path.first, vec4f(min(vertex.color, vec3f(1.0)), -1.0), is_first);
    next.exit_distance = select(0.0, exit_distance_of(vertex, next.direction), has(next.flags, PATH_INSIDE));
    return next;
}
