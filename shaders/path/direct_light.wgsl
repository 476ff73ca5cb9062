// The state of a path's sampled light, until it is known whether the light is occluded. Without a light source that can
// be sampled there is none; studios add light immediately.
// provides: DirectLight, clear_light, emitter_of, needs_shadow_ray, no_light, radiance_so_far, store_light
// needs: NO_EMITTER, PENDING, RADIANCE, SAMPLES_LIGHT, SHADOW, load, store

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
    if (SAMPLES_LIGHT) {
        store(index, SHADOW, light.shadow);
        store(index, PENDING, light.pending);
    }
}

// Stores that there is no sampled light.
fn clear_light(index: u32) {
    store_light(index, no_light());
}

fn needs_shadow_ray(light: DirectLight) -> bool {
    return SAMPLES_LIGHT && light.shadow.w > 0.0;
}

// The radiance of the path, including the pending light if it is visible.
fn radiance_so_far(index: u32) -> vec4f {
    var radiance = load(index, RADIANCE);
    if (SAMPLES_LIGHT) {
        let pending = load(index, PENDING);
        radiance += vec4f(pending.rgb * pending.w, 0.0);
    }
    return radiance;
}
