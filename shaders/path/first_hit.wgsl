// The hit of a path's ray before any brick is traced: the far side of the departed shape if the ray goes inside,
// otherwise a miss.
// provides: first_hit
// needs: Departure, Hit, NO_HIT, NO_ID

fn first_hit(departure: Departure, is_going_inside: bool) -> Hit {
    // A local struct of a miss would be invalid once wgpu has put in the values of constants.
    return Hit(select(NO_HIT, departure.exit_distance, is_going_inside), select(NO_ID, departure.id, is_going_inside),
        select(0u, departure.shape_index, is_going_inside), 0.0);
}
