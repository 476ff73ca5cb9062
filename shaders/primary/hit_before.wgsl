// What is known of a pixel before a brick is traced. The variants make kernels of their own, because a software device
// reads what a branch that is not taken would read.

//// first-brick
// What is known of a pixel before the first brick is traced. A kernel of its own, because a software device
// reads what a branch that is not taken would read.
// provides: hit_before
// needs: Hit, NO_HIT, NO_ID

fn hit_before(index: u32) -> Hit {
    return Hit(NO_HIT, NO_ID, 0u, 0.0);
}

//// later-brick
// What the bricks before this one found.
// provides: hit_before
// needs: Hit, load_hit

fn hit_before(index: u32) -> Hit {
    return load_hit(index);
}
