// Adds the light that was looked for last, if nothing is in between; on a ground that catches shadows, if something
// is.

fn settled(index: u32) -> vec4f {
    let pending = load(index, PENDING);
    let alpha = load(index, NORMAL).w;
    let adds = (pending.w > 0.0) == (alpha == 0.0);
    return load(index, RADIANCE) + select(vec4f(0.0), vec4f(pending.rgb, alpha), adds);
}
