// The spheres of one leaf. Twin of src/accel/leaf.rs.

// Offers the nearest sphere of a leaf. Ids ascend within a leaf, so `<` leaves a tie to the smaller one,
// and one offer is enough.
fn offer_leaf(ray: Ray, first: u32, count: u32, nearest: ptr<function, Nearest>) {
    var t = NO_HIT;
    var shape_index = first;
    for (var i = first; i < first + count; i++) {
        let found = distance_to(ray, i);
        if (found < t) {
            t = found;
            shape_index = i;
        }
    }
    if (t < NO_HIT) {
        offer(nearest, t, shape_index);
    }
}

// Whether a sphere of a leaf is hit before `t_max`.
fn any_in_leaf(ray: Ray, first: u32, count: u32, t_max: f32) -> bool {
    for (var i = first; i < first + count; i++) {
        if (distance_to(ray, i) < t_max) {
            return true;
        }
    }
    return false;
}
