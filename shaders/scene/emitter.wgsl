// An emissive sphere of the scene, read from the table of emitters.
// provides: Emitter, emitter
// needs: lighting, table, tables

// An emissive sphere, the probability with which it is sampled, and its radiance.
struct Emitter {
    sphere: vec4f,
    id: u32,
    probability: f32,
    radiance: vec3f,
}

fn emitter(index: u32) -> Emitter {
    let at = lighting.emitter_first + 3u * index;
    return Emitter(table(at), tables[at + 1u].x, table(at + 1u).z, table(at + 2u).rgb);
}
