// The state of a path's sampled light, until it is known whether the light is occluded.

//// none
// Variant for scenes without a light source that can be sampled, and for studios, which add light immediately.
// provides: DirectLight, clear_light, emitter_of, needs_shadow_ray, no_light, radiance_so_far, store_light
// needs: NO_EMITTER, RADIANCE, load

struct DirectLight {
    is_none: u32,
}

fn no_light() -> DirectLight {
    return DirectLight(1u);
}

fn emitter_of(light: DirectLight) -> u32 {
    return NO_EMITTER;
}

fn store_light(index: u32, light: DirectLight) {}

fn clear_light(index: u32) {}

fn needs_shadow_ray(light: DirectLight) -> bool {
    return false;
}

fn radiance_so_far(index: u32) -> vec4f {
    return load(index, RADIANCE);
}

//// any
// Variant for paths that sample a light at every surface.
// provides: DirectLight, clear_light, emitter_of, needs_shadow_ray, no_light, radiance_so_far, store_light
// needs: NO_EMITTER, PENDING, RADIANCE, SHADOW, load, store

struct DirectLight {
    // Direction towards the light, and its distance, which is 0 if there is no light.
    shadow: vec4f,
    // Pending contribution of the light, and its visibility: 1 until an occluder is found.
    pending: vec4f,
    // Index of the emitter, or NO_EMITTER.
    emitter: u32,
}

fn no_light() -> DirectLight {
    return DirectLight(vec4f(0.0, 0.0, 1.0, 0.0), vec4f(0.0), NO_EMITTER);
}

// The index of the sampled emitter, or NO_EMITTER.
fn emitter_of(light: DirectLight) -> u32 {
    return light.emitter;
}

fn store_light(index: u32, light: DirectLight) {
    store(index, SHADOW, light.shadow);
    store(index, PENDING, light.pending);
}

// Stores that there is no sampled light.
fn clear_light(index: u32) {
    store(index, SHADOW, vec4f(0.0, 0.0, 1.0, 0.0));
    store(index, PENDING, vec4f(0.0));
}

fn needs_shadow_ray(light: DirectLight) -> bool {
    return light.shadow.w > 0.0;
}

// The radiance of the path, including the pending light if it is visible.
fn radiance_so_far(index: u32) -> vec4f {
    let pending = load(index, PENDING);
    return load(index, RADIANCE) + vec4f(pending.rgb * pending.w, 0.0);
}
