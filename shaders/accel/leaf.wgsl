// Testing the spheres of a leaf.
// provides: any_in_leaf, offer_leaf
// needs: NO_HIT, Nearest, Search, distance_within, offer

// Offers the nearest sphere of a leaf. Ids ascend within a leaf, so that `<` keeps the smaller id of equal distances,
// and a single offer suffices.
fn offer_leaf(search: Search, first: u32, count: u32, nearest: ptr<function, Nearest>) {
    var t = NO_HIT;
    var shape_index = first;
    for (var i = first; i < first + count; i++) {
        let found = distance_within(search, i, t);
        if (found < t) {
            t = found;
            shape_index = i;
        }
    }
    if (t < NO_HIT) {
        offer(nearest, t, shape_index);
    }
}

// Whether the ray hits a sphere of a leaf at a distance less than `t_max`.
fn any_in_leaf(search: Search, first: u32, count: u32, t_max: f32) -> bool {
    for (var i = first; i < first + count; i++) {
        if (distance_within(search, i, t_max) < t_max) {
            return true;
        }
    }
    return false;
}
