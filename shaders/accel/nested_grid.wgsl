// Traversal of a grid with two levels, whose crowded cells contain inner grids.
//
// Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing" (1987), with a change: distances to planes are
// computed from the index of the plane instead of being accumulated, so that their error does not grow. The word of an
// empty cell contains the number of empty cells ahead of it, and the ray crosses all of them in one step.
// provides: walk
// needs: EMPTY, Found, GridRay, KIND, NO_SHAPE, REACH, REACH_BITS, Search, brick, cell_word, first_cell, grid_ray,
//   least, spend, walk_cell

fn walk(search: Search, found: ptr<function, Found>, stop_at_first: bool) {
    let along = grid_ray(search.ray, search.inverse);
    var t = along.t_enter;
    if (t > along.t_leave || t > (*found).t) {
        return;
    }
    let counts = vec3f(brick.cell_counts);
    let strides = vec3f(1.0, counts.x, counts.x * counts.y);
    // Bit i of the octant is set for a ray that descends along axis i.
    let behind = vec3u(1.0 - along.ahead);
    let octant = REACH_BITS * (behind.x + 2u * behind.y + 4u * behind.z);
    var cell = first_cell(along);
    var word = EMPTY;
    var t_leave = 0.0;
    loop {
        // A loop of its own advances to the next cell with spheres. Rays that run together on a software device then
        // test spheres at the same time, instead of one testing while others cross empty space.
        loop {
            word = cell_word(u32(dot(cell, strides)));
            // The word of an empty cell contains the number of empty cells ahead for each octant.
            let reach = select(0.0, f32((word >> octant) & REACH), (word & KIND) == EMPTY);
            t_leave = least(leaving(along, cell, reach));
            if ((word & KIND) != EMPTY || t_leave >= along.t_leave || !spend(1u)) {
                break;
            }
            t = t_leave;
            cell = next_cell(along, cell, reach, t);
        }
        if ((word & KIND) != EMPTY) {
            walk_cell(search, along, word, cell, t, t_leave, found, stop_at_first);
        }
        let is_done = (*found).t <= t_leave || (stop_at_first && (*found).shape_index != NO_SHAPE);
        if (is_done || t_leave >= along.t_leave || !spend(1u)) {
            break;
        }
        t = t_leave;
        cell = next_cell(along, cell, 0.0, t);
    }
}

// The distances at which the ray leaves `cell` and the `reach` cells ahead of it.
fn leaving(along: GridRay, cell: vec3f, reach: f32) -> vec3f {
    return along.base + (cell + along.step * reach + along.ahead) * along.delta;
}

// The cell that the ray enters at the distance `t`, where it leaves these cells.
fn next_cell(along: GridRay, cell: vec3f, reach: f32, t: f32) -> vec3f {
    let there = floor(along.start + t * along.speed);
    let last = vec3f(brick.cell_counts) - 1.0;
    let farthest = cell + along.step * reach;
    let ahead = clamp(there, min(cell, farthest), max(cell, farthest));
    let kept = clamp(ahead, vec3f(0.0), last);
    let is_left = leaving(along, cell, reach) <= vec3f(t);
    return select(kept, cell + along.step * (reach + 1.0), is_left);
}
