// What a path keeps of the light that it looks for.

struct DirectLight {
    // Towards it, and how far; 0 for no light.
    shadow: vec4f,
    // What it adds, and 1 until something is found in between.
    pending: vec4f,
    // The sphere that it is, if it is one.
    sphere: vec4f,
}

fn no_light() -> DirectLight {
    return DirectLight(vec4f(0.0, 0.0, 1.0, 0.0), vec4f(0.0), vec4f(0.0));
}

fn store_light(index: u32, light: DirectLight) {
    store(index, SHADOW, light.shadow);
    store(index, PENDING, light.pending);
    store(index, TARGET, light.sphere);
}

// Leaves nothing to be looked for, or to be added.
fn forget_light(index: u32) {
    store(index, SHADOW, vec4f(0.0, 0.0, 1.0, 0.0));
    store(index, PENDING, vec4f(0.0));
}

fn is_looking(light: DirectLight) -> bool {
    return light.shadow.w > 0.0;
}
