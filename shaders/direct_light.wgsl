// What a path keeps of the light that it looks for.

struct DirectLight {
    // Towards it, and how far; 0 for no light.
    shadow: vec4f,
    // What it adds, and 1 until something is found in between.
    pending: vec4f,
    // Which emitter it is, or NO_EMITTER.
    emitter: u32,
}

fn no_light() -> DirectLight {
    return DirectLight(vec4f(0.0, 0.0, 1.0, 0.0), vec4f(0.0), NO_EMITTER);
}

// Which emitter is looked for, or NO_EMITTER.
fn sought_by(light: DirectLight) -> u32 {
    return light.emitter;
}

fn store_light(index: u32, light: DirectLight) {
    store(index, SHADOW, light.shadow);
    store(index, PENDING, light.pending);
}

// Leaves nothing to be looked for, or to be added.
fn forget_light(index: u32) {
    store(index, SHADOW, vec4f(0.0, 0.0, 1.0, 0.0));
    store(index, PENDING, vec4f(0.0));
}

fn is_looking(light: DirectLight) -> bool {
    return light.shadow.w > 0.0;
}
