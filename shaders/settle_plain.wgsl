// Where light is added at once, or none is looked for.

fn radiance_so_far(index: u32) -> vec4f {
    return load(index, RADIANCE);
}
