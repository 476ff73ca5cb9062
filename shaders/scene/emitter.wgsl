// One of the spheres of the scene that send out light.
// provides: Emitter, emitter
// needs: lighting, table, tables

// The sphere; its id, the last number by which it is chosen, and with what probability; its radiance.
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
