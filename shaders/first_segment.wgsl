// What is known of a path's ray before the first brick is traced: one that starts on a shape and goes inside meets
// its far wall at the latest.

fn hit_before(index: u32) -> Hit {
    let far_wall = Hit(leaves.far_wall, leaves.id, leaves.place, 0.0);
    let nothing = Hit(NO_HIT, NO_ID, 0u, 0.0);
    return Hit(select(nothing.t, far_wall.t, is_going_inside), select(nothing.id, far_wall.id, is_going_inside),
        select(nothing.place, far_wall.place, is_going_inside), 0.0);
}
