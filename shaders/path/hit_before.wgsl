// The hit of a path's ray before a brick is traced.
// provides: hit_before
// needs: Departure, Hit, first_hit, load_hit

// Whether the brick is not the first.
override IS_LATER_BRICK: bool;

// The hit in the bricks before this one.
fn hit_before(index: u32, departure: Departure, is_going_inside: bool) -> Hit {
    if (IS_LATER_BRICK) {
        return load_hit(index);
    }
    return first_hit(departure, is_going_inside);
}
