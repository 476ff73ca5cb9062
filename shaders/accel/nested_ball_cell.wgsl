// Traversal of a cell of the outer grid, whose lists have balls. ball_grid.wgsl explains the loops.
// provides: walk_cell
// needs: Found, GRID, GridRay, INNER_START, INNER_UNIT, KIND, LEVEL, LEVEL_SHIFT, NO_LIST, NO_SHAPE, Search, cell_word,
//   find_candidates, least, list_of, part_in_cell, spend, test_candidates

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
    let first = (word & INNER_START) * INNER_UNIT;
    let start = (along.start - cell) * side;
    let speed = along.speed * side;
    var t = t_enter;
    var inner = clamp(floor(start + t * speed), vec3f(0.0), vec3f(side - 1.0));
    var list = list_of(inner_word(word, is_grid, first + u32(dot(inner, strides))));
    var planes = along.base + (cell + (inner + along.ahead) / side) * along.delta;
    var t_inner = least(planes);
    loop {
        loop {
            let length = (t_inner - t) * along.per_cell * side;
            find_candidates(&list, part_in_cell(start + t * speed - inner, search.ray.direction, length));
            let is_end = (*found).t <= t_inner || t_inner >= t_leave;
            if (list.candidates != 0u || (list.next == NO_LIST && is_end) || !spend(1u)) {
                break;
            }
            if (list.next == NO_LIST) {
                t = t_inner;
                inner = select(inner, inner + along.step, planes <= vec3f(t_inner));
                list = list_of(inner_word(word, is_grid, first + u32(dot(inner, strides))));
                planes = along.base + (cell + (inner + along.ahead) / side) * along.delta;
                t_inner = least(planes);
            }
        }
        test_candidates(search, &list, found);
        let is_end = (*found).t <= t_inner || t_inner >= t_leave;
        let is_found = stop_at_first && (*found).shape_index != NO_SHAPE;
        if (is_found || (list.next == NO_LIST && is_end) || !spend(1u)) {
            break;
        }
    }
}

// The word of an inner cell, or that of the outer one if it has no grid inside.
fn inner_word(word: u32, is_grid: bool, index: u32) -> u32 {
    var inner = word;
    if (is_grid) {
        inner = cell_word(index);
    }
    return inner;
}
