// Traversal of a cell of the outer grid, whose lists are references. Twin: src/accel/grid_walk.rs.
// provides: walk_cell
// needs: Found, GRID, GridRay, INNER_START, INNER_UNIT, KIND, LEVEL, LEVEL_SHIFT, LIST, NO_SHAPE, Search, cell_word,
//   least, spend, test_list

// Traverses a cell of the outer grid that is not empty. A cell with a list is treated as a grid of one cell.
fn walk_cell(
    search: Search,
    along: GridRay,
    word: u32,
    cell: vec3f,
    t_enter: f32,
    t_leave: f32,
    found: ptr<function, Found>,
    stop_at_first: bool,
) {
    let is_grid = (word & KIND) == GRID;
    let side = f32(1u << select(0u, (word >> LEVEL_SHIFT) & LEVEL, is_grid));
    let strides = vec3f(1.0, side, side * side);
    let there = floor((along.start + t_enter * along.speed - cell) * side);
    var inner = clamp(there, vec3f(0.0), vec3f(side - 1.0));
    loop {
        var inner_word = word;
        if (is_grid) {
            inner_word = cell_word((word & INNER_START) * INNER_UNIT + u32(dot(inner, strides)));
        }
        let planes = along.base + (cell + (inner + along.ahead) / side) * along.delta;
        let t_inner = least(planes);
        if ((inner_word & KIND) == LIST) {
            test_list(search, inner_word & ~KIND, found);
        }
        let is_done = (*found).t <= t_inner || (stop_at_first && (*found).shape_index != NO_SHAPE);
        if (is_done || t_inner >= t_leave || !spend(1u)) {
            break;
        }
        inner = select(inner, inner + along.step, planes <= vec3f(t_inner));
    }
}
