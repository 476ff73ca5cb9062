// What the bricks before this one found.

fn hit_before(index: u32) -> Hit {
    return load_hit(index);
}
