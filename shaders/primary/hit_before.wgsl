// The hit of a pixel before a brick is traced.
// provides: IS_LATER_BRICK, hit_before
// needs: Hit, NO_HIT, NO_ID, load_hit

// Whether the brick is not the first. It is a constant because a software device also reads the memory that a branch not
// taken would read.
override IS_LATER_BRICK: bool;

// The hit in the bricks before this one, which is a miss if this is the first.
fn hit_before(index: u32) -> Hit {
    if (IS_LATER_BRICK) {
        return load_hit(index);
    }
    return Hit(NO_HIT, NO_ID, 0u, 0.0);
}
