// No light that could be looked for.

struct DirectLight {
    is_none: u32,
}

fn no_light() -> DirectLight {
    return DirectLight(1u);
}

fn look_for_light(at: Surface, out: vec3f, through: vec3f, seed: u32, sample: u32, is_end: bool) -> DirectLight {
    return no_light();
}

fn sought_by(light: DirectLight) -> u32 {
    return NO_EMITTER;
}

fn store_light(index: u32, light: DirectLight) {}

fn forget_light(index: u32) {}

fn is_looking(light: DirectLight) -> bool {
    return false;
}
