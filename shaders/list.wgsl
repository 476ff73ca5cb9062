// No structure: every sphere of the brick. Twin: src/accel/list.rs.

fn find_nearest(ray: Ray, inverse: vec3f, nearest: ptr<function, Nearest>) {
    // Ids ascend, so that `<` leaves a tie to the smaller id.
    var t = NO_HIT;
    var shape_index = 0u;
    for (var i = 0u; i < brick.shape_count; i++) {
        let here = distance_to(ray, i);
        if (here < t) {
            t = here;
            shape_index = i;
        }
    }
    offer(nearest, t, shape_index);
}

fn find_any(ray: Ray, inverse: vec3f, t_max: f32) -> bool {
    for (var i = 0u; i < brick.shape_count; i++) {
        if (distance_to(ray, i) < t_max) {
            return true;
        }
    }
    return false;
}
