// What is known of a path's ray before a brick is traced.

//// first-brick
// A ray that starts on a shape and goes inside hits its far side at the latest.
// provides: hit_before
// needs: Departure, Hit, NO_HIT, NO_ID

fn hit_before(index: u32, departure: Departure, is_going_inside: bool) -> Hit {
    let far_side = Hit(departure.exit_distance, departure.id, departure.shape_index, 0.0);
    let nothing = Hit(NO_HIT, NO_ID, 0u, 0.0);
    return Hit(select(nothing.t, far_side.t, is_going_inside), select(nothing.id, far_side.id, is_going_inside),
        select(nothing.shape_index, far_side.shape_index, is_going_inside), 0.0);
}

//// later-brick
// What the bricks before this one found.
// provides: hit_before
// needs: Departure, Hit, load_hit

fn hit_before(index: u32, departure: Departure, is_going_inside: bool) -> Hit {
    return load_hit(index);
}
