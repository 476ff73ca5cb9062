// What is known of a path's ray before the first brick is traced: one that starts on a shape and goes inside meets
// its far side at the latest.

fn hit_before(index: u32) -> Hit {
    let far_side = Hit(leaves.exit_distance, leaves.id, leaves.shape_index, 0.0);
    let nothing = Hit(NO_HIT, NO_ID, 0u, 0.0);
    return Hit(select(nothing.t, far_side.t, is_going_inside), select(nothing.id, far_side.id, is_going_inside),
        select(nothing.shape_index, far_side.shape_index, is_going_inside), 0.0);
}
