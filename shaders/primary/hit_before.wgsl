// The hit of a pixel before a brick is traced. The variants belong to different kernels, because a software device also
// reads the memory that a branch not taken would read.

//// first-brick
// The hit of a pixel before the first brick is traced, which is always a miss.
// provides: hit_before
// needs: Hit, NO_HIT, NO_ID

fn hit_before(index: u32) -> Hit {
    return Hit(NO_HIT, NO_ID, 0u, 0.0);
}

//// later-brick
// The hit of a pixel in the bricks before this one.
// provides: hit_before
// needs: Hit, load_hit

fn hit_before(index: u32) -> Hit {
    return load_hit(index);
}
