// Traversal of a grid with a single level, whose lists have balls.
//
// Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing" (1987), with a change: distances to planes are
// computed from the index of the plane instead of being accumulated, so that their error does not grow.
// provides: walk
// needs: Found, NO_LIST, NO_SHAPE, Search, brick, cell_word, find_candidates, first_cell, grid_ray, least, list_of,
//   part_in_cell, spend, test_candidates

fn walk(search: Search, found: ptr<function, Found>, stop_at_first: bool) {
    let along = grid_ray(search.ray, search.inverse);
    if (along.t_enter > along.t_leave || along.t_enter > (*found).t) {
        return;
    }
    let counts = vec3f(brick.cell_counts);
    let strides = vec3f(1.0, counts.x, counts.x * counts.y);
    var t = along.t_enter;
    var cell = first_cell(along);
    var list = list_of(cell_word(u32(dot(cell, strides))));
    var planes = along.base + (cell + along.ahead) * along.delta;
    var t_leave = least(planes);
    loop {
        // A loop of its own advances to the next ball that the ray meets. Rays that run together on a software device
        // then test spheres at the same time, instead of one testing while others search.
        loop {
            let length = (t_leave - t) * along.per_cell;
            let start = along.start + t * along.speed - cell;
            find_candidates(&list, part_in_cell(start, search.ray.direction, length));
            let is_end = (*found).t <= t_leave || t_leave >= along.t_leave;
            if (list.candidates != 0u || (list.next == NO_LIST && is_end) || !spend(1u)) {
                break;
            }
            if (list.next == NO_LIST) {
                t = t_leave;
                cell = select(cell, cell + along.step, planes <= vec3f(t_leave));
                list = list_of(cell_word(u32(dot(cell, strides))));
                planes = along.base + (cell + along.ahead) * along.delta;
                t_leave = least(planes);
            }
        }
        test_candidates(search, &list, found);
        let is_end = (*found).t <= t_leave || t_leave >= along.t_leave;
        let is_found = stop_at_first && (*found).shape_index != NO_SHAPE;
        if (is_found || (list.next == NO_LIST && is_end) || !spend(1u)) {
            break;
        }
    }
}
