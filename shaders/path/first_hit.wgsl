// The hit of a path's ray before any brick is traced: the far side of the departed shape if the ray goes inside and does not
// leave it through an open end, otherwise a miss.
// provides: first_hit
// needs: Departure, Hit, NO_HIT, NO_ID

fn first_hit(departure: Departure, is_going_inside: bool) -> Hit {
    let is_hit = is_going_inside && departure.exit_distance < NO_HIT;
    // A local struct of a miss would be invalid once wgpu has put in the values of constants.
    return Hit(select(NO_HIT, departure.exit_distance, is_hit), select(NO_ID, departure.id, is_hit),
        select(0u, departure.shape_index, is_hit), 0.0);
}
