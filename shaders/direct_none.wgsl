// No light that could be looked for.

fn look_for_light(index: u32, out: vec3f, at: Surface, through: vec3f, seed: u32) {}
