// Search without a structure, which tests every sphere of the brick.
// provides: find_any, find_nearest
// needs: NO_HIT, Nearest, Search, brick, distance_within, offer

fn find_nearest(search: Search, nearest: ptr<function, Nearest>) {
    // Ids ascend, so that `<` keeps the smaller id of equal distances.
    var t = NO_HIT;
    var shape_index = 0u;
    for (var i = 0u; i < brick.shape_count; i++) {
        let here = distance_within(search, i, t);
        if (here < t) {
            t = here;
            shape_index = i;
        }
    }
    offer(nearest, t, shape_index);
}

fn find_any(search: Search, t_max: f32) -> bool {
    for (var i = 0u; i < brick.shape_count; i++) {
        if (distance_within(search, i, t_max) < t_max) {
            return true;
        }
    }
    return false;
}
