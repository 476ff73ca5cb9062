// The words of the cells of the grid, and of the grids inside its cells, one for each cell: after the ids, in the same
// buffer.
// provides: cell_word
// needs: brick, ids

fn cell_word(index: u32) -> u32 {
    return ids[brick.shape_count + index];
}
