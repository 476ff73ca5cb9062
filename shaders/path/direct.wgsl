// Sampling a light source for next-event estimation: the lights, the emitters and the image of the sky are chosen at
// random. Twin: src/cpu/light/path.rs.
// provides: density_of_hit_emitter, sample_light
// needs: DirectLight, LIGHT_MULTIPLE, NO_EMITTER, NO_HIT, PI, Ray, SAMPLES_LIGHT, Surface, axes_around, chosen_emitter,
//   cone_direction, cone_of_sphere, emitter_density, emitter_with_id, exit_distance_of, ground_distance, lighting,
//   no_light, reflect_toward, sample_lamp, sample_pair, sample_sky, sky_radiance, tables, to_local, to_world, unit2

struct LightSample {
    direction: vec3f,
    distance: f32,
    // Density of the direction, if scattered rays can hit the light as well; 0 otherwise.
    density: f32,
    // Radiance divided by the density.
    radiance: vec3f,
    // Index of the emitter, or NO_EMITTER.
    emitter: u32,
}

fn light_from_lamp(source: u32, position: vec3f, u: vec2u) -> LightSample {
    let light = tables[3u * source + 2u].x;
    let lamp = sample_lamp(light, position, u);
    let sources = f32(lighting.source_count);
    let density = select(0.0, 1.0 / (2.0 * PI * lamp.sun * sources), lamp.sun > 0.0);
    return LightSample(lamp.direction, lamp.distance, density, PI * sources * lamp.strength, NO_EMITTER);
}

fn light_from_emitter(position: vec3f, u: vec2u, choice: u32) -> LightSample {
    let which = chosen_emitter(choice);
    let found = emitter(which);
    let density = emitter_density(found, position) / f32(lighting.source_count);
    let toward = found.sphere.xyz - position;
    let length = sqrt(max(dot(toward, toward), 1e-30));
    let k = cone_of_sphere(found.sphere.w, max(length, found.sphere.w));
    let direction = to_world(axes_around(toward / length), cone_direction(u, k));
    let middle = dot(toward, direction);
    let foot = toward - middle * direction;
    let distance = middle - sqrt(max(found.sphere.w * found.sphere.w - dot(foot, foot), 0.0));
    let radiance = select(vec3f(0.0), found.radiance / max(density, 1e-30), density > 0.0);
    return LightSample(direction, max(distance, 0.0), density, radiance, which);
}

fn light_from_sky(u: vec2u) -> LightSample {
    let found = sample_sky(u);
    let density = found.w / f32(lighting.source_count);
    let radiance = sky_radiance(found.xyz) / max(density, 1e-30);
    return LightSample(found.xyz, NO_HIT, density, select(vec3f(0.0), radiance, density > 0.0), NO_EMITTER);
}

fn sample_light(at: Surface, out: vec3f, through: vec3f, seed: u32, sample: u32, is_end: bool) -> DirectLight {
    var light = no_light();
    if (SAMPLES_LIGHT) {
        light = sampled_light(at, out, through, seed, sample, is_end);
    }
    return light;
}

fn sampled_light(at: Surface, out: vec3f, through: vec3f, seed: u32, sample: u32, is_end: bool) -> DirectLight {
    let u = sample_pair(seed, sample, 4u + 8u * at.number);
    let choice = sample_pair(seed, sample, 5u + 8u * at.number);
    let source = min(u32(unit2(choice).x * f32(lighting.source_count)), lighting.source_count - 1u);
    let position = at.vertex.position;
    var found = light_from_lamp(min(source, max(lighting.lamp_sources, 1u) - 1u), position, u);
    let is_emitter = source == lighting.lamp_sources && lighting.emitter_count > 0u;
    if (is_emitter) {
        found = light_from_emitter(position, u, choice.y);
    }
    if (source >= lighting.lamp_sources && !is_emitter) {
        found = light_from_sky(u);
    }
    let toward = to_local(at.axes, found.direction);
    let r = reflect_toward(at.material, at.vertex.color, to_local(at.axes, out), toward);
    let balanced = found.density / max(found.density + r.density, 1e-30);
    let is_balanced = found.density > 0.0 && lighting.light_sampling == LIGHT_MULTIPLE;
    let light = through * r.value * found.radiance * select(1.0, balanced, is_balanced);
    let ray = Ray(position, found.direction);
    let is_in_own = at.vertex.is_back && exit_distance_of(at.vertex, found.direction) < found.distance;
    let is_below = at.vertex.sphere.w > 0.0 && ground_distance(ray, 0.0) < found.distance;
    let is_open = any(light > vec3f(0.0)) && !is_in_own && !is_below && !is_end;
    return DirectLight(vec4f(found.direction, select(0.0, found.distance, is_open)),
        select(vec4f(0.0), vec4f(light, 1.0), is_open), found.emitter);
}

// The density with which light sampling would have chosen the emitter that was hit; 0 if it chooses none.
fn density_of_hit_emitter(id: u32, position: vec3f) -> f32 {
    var density = 0.0;
    if (SAMPLES_LIGHT) {
        let sources = f32(max(lighting.source_count, 1u));
        let chosen = emitter_density(emitter(emitter_with_id(id)), position) / sources;
        density = select(chosen, 0.0, lighting.emitter_count == 0u);
    }
    return density;
}
