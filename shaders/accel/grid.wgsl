// Traversal of a grid with a single level. Twin: src/accel/grid_walk.rs.
//
// Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing" (1987), with a change: distances to planes are
// computed from the index of the plane instead of being accumulated, so that their error does not grow.
// provides: walk
// needs: EMPTY, Found, KIND, NO_SHAPE, Search, brick, cell_word, first_cell, grid_ray, least, spend, test_list

fn walk(search: Search, found: ptr<function, Found>, stop_at_first: bool) {
    let along = grid_ray(search.ray, search.inverse);
    if (along.t_enter > along.t_leave || along.t_enter > (*found).t) {
        return;
    }
    let counts = vec3f(brick.cell_counts);
    let strides = vec3f(1.0, counts.x, counts.x * counts.y);
    var cell = first_cell(along);
    loop {
        let word = cell_word(u32(dot(cell, strides)));
        let planes = along.base + (cell + along.ahead) * along.delta;
        let t_leave = least(planes);
        if (word != EMPTY) {
            test_list(search, word & ~KIND, found);
        }
        let is_done = (*found).t <= t_leave || (stop_at_first && (*found).shape_index != NO_SHAPE);
        if (is_done || t_leave >= along.t_leave || !spend(1u)) {
            break;
        }
        cell = select(cell, cell + along.step, planes <= vec3f(t_leave));
    }
}
