// The words of the cells of the grid, and of the grids inside its cells, one for each cell.

//// alone
// The words in a buffer of their own.
// provides: cell_word

// Words of the cells.
@group(1) @binding(3) var<storage, read> cells: array<u32>;

fn cell_word(index: u32) -> u32 {
    return cells[index];
}

//// with-ids
// The words after the ids, in the same buffer.
// provides: cell_word
// needs: brick, ids

fn cell_word(index: u32) -> u32 {
    return ids[brick.shape_count + index];
}
