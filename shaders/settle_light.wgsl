// Adds the light that was looked for last, if nothing is in between.

fn radiance_so_far(index: u32) -> vec4f {
    let pending = load(index, PENDING);
    return load(index, RADIANCE) + vec4f(pending.rgb * pending.w, 0.0);
}
