// What a path keeps of the light that it looks for.

//// none
// Paths in a scene without a light that could be looked for, and studios, which add light at once.
// provides: DirectLight, forget_light, is_looking, no_light, radiance_so_far, sought_by, store_light
// needs: NO_EMITTER, RADIANCE, load

struct DirectLight {
    is_none: u32,
}

fn no_light() -> DirectLight {
    return DirectLight(1u);
}

fn sought_by(light: DirectLight) -> u32 {
    return NO_EMITTER;
}

fn store_light(index: u32, light: DirectLight) {}

fn forget_light(index: u32) {}

fn is_looking(light: DirectLight) -> bool {
    return false;
}

fn radiance_so_far(index: u32) -> vec4f {
    return load(index, RADIANCE);
}

//// any
// Paths that look for light at every surface.
// provides: DirectLight, forget_light, is_looking, no_light, radiance_so_far, sought_by, store_light
// needs: NO_EMITTER, PENDING, RADIANCE, SHADOW, load, store

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

// With the light that was looked for last, if nothing is in between.
fn radiance_so_far(index: u32) -> vec4f {
    let pending = load(index, PENDING);
    return load(index, RADIANCE) + vec4f(pending.rgb * pending.w, 0.0);
}
