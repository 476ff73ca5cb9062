// What is known of a pixel before the first brick is traced. A kernel of its own, because a software device
// reads what a branch that is not taken would read.

fn hit_before(index: u32) -> Hit {
    return Hit(NO_HIT, NO_ID, 0u, 0.0);
}
