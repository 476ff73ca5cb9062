// The hit of a path's ray before any brick is traced: the far side of the departed shape if the ray goes inside,
// otherwise a miss.

fn first_hit(departure: Departure, is_going_inside: bool) -> Hit {
    let far_side = Hit(departure.exit_distance, departure.id, departure.shape_index, 0.0);
    let nothing = Hit(NO_HIT, NO_ID, 0u, 0.0);
    return Hit(select(nothing.t, far_side.t, is_going_inside), select(nothing.id, far_side.id, is_going_inside),
        select(nothing.shape_index, far_side.shape_index, is_going_inside), 0.0);
}
