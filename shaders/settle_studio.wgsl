// In a studio light is added at once.

fn settled(index: u32) -> vec4f {
    return load(index, RADIANCE);
}
