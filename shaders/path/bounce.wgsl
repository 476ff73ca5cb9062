// Scattering of a path at a surface. Twin: src/cpu/light/path.rs.
// provides: bounce, head_light, side_of
// needs: DIELECTRIC, LAMP_HEAD, Onward, PATH_ALIVE, PATH_FULL, PATH_INSIDE, PATH_ON_GROUND, PATH_SCATTERED, PI,
//   Surface, lamp_kind, lighting, no_light, reflect_toward, sample_pair, scatter_light, table, to_local, to_world,
//   unit2

// The flags for the side of a surface on which a ray starts.
fn side_of(at: Surface, is_behind: bool) -> u32 {
    let is_sphere = at.vertex.sphere.w > 0.0;
    let side = select(0u, PATH_INSIDE, is_sphere && is_behind != at.vertex.is_back);
    return side | select(PATH_ON_GROUND, 0u, is_sphere);
}

fn bounce(at: Surface, out: vec3f, lobe: f32, through: vec3f, seed: u32, sample: u32, medium: vec3f) -> Onward {
    let u = sample_pair(seed, sample, 2u + 8u * at.number);
    let next = scatter_light(at, to_local(at.axes, out), lobe, u);
    let carried = through * next.weight;
    let most = max(carried.x, max(carried.y, carried.z));
    // Russian roulette.
    let survival = select(1.0, min(most, 0.95), at.number >= lighting.roulette_from);
    let draw = unit2(sample_pair(seed, sample, 6u + 8u * at.number)).x;
    let is_alive = most > 0.0 && draw < survival;
    let is_behind = next.direction.z < 0.0;
    let is_glass = at.material.kind == DIELECTRIC;
    let flags = PATH_SCATTERED | select(0u, PATH_FULL, is_glass) | select(0u, PATH_ALIVE, is_alive);
    let inside = select(vec3f(0.0), at.material.absorption, !at.vertex.is_back);
    return Onward(at.vertex.position, flags | side_of(at, is_behind), to_world(at.axes, next.direction),
        next.density, carried / max(survival, 1e-30), select(medium, inside, is_glass && is_behind), no_light(),
        vec4f(0.0), vec4f(0.0), 0.0);
}

// Light from lights at the eye, which illuminate only surfaces that the camera sees.
fn head_light(at: Surface, out: vec3f, scattered: u32) -> vec3f {
    var sum = vec3f(0.0);
    let toward = to_local(at.axes, out);
    let count = select(lighting.light_count, 0u, scattered != 0u || at.material.kind == DIELECTRIC);
    for (var light = 0u; light < count; light++) {
        let is_head = lamp_kind(light) == LAMP_HEAD;
        sum += select(vec3f(0.0), table(3u * light + 1u).rgb, is_head);
    }
    return PI * sum * reflect_toward(at.material, at.vertex.color, toward, toward).value;
}
