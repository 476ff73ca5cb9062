// The sphere that a path looks for.

fn aim(index: u32) -> vec4f {
    return load(index, TARGET);
}
