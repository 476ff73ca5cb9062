//! Computes how many cells ahead of an empty cell are empty, so that a ray may cross them in one step.

use super::grid::word;
use crate::parallel::map;

/// The largest number of cells beyond the first that a step may cross.
pub(super) const MAX_AHEAD: u8 = word::REACH as u8;

/// The fraction of empty cells below which skipping is not worthwhile.
const WORTH_IT: f32 = 0.25;

/// Writes into every empty word of the first level, for each of the eight octants of ray directions, how many cells
/// ahead along all three axes are empty as well, in three bits each.
///
/// By dynamic programming, as for the largest square of ones in a matrix: the empty cube that starts at a cell is one
/// larger than the smallest of those that start at its seven neighbours ahead. Everything outside the grid is empty.
pub(super) fn mark_empty_surroundings(words: &mut [u32], counts: [u32; 3]) {
    let counts = counts.map(|count| count as usize);
    let len = counts.iter().product();
    let is_empty: Vec<bool> =
        words[..len].iter().map(|word| word & word::KIND == word::EMPTY).collect();
    let empty = is_empty.iter().filter(|is_empty| **is_empty).count();
    if (empty as f32) < WORTH_IT * len as f32 {
        return;
    }
    let octants = map(8, |octant| cubes_ahead(&is_empty, counts, octant));
    for (cell, word) in words[..len].iter_mut().enumerate() {
        if is_empty[cell] {
            let bits = |octant: usize| {
                u32::from(octants[octant][cell]) << (word::REACH_BITS as usize * octant)
            };
            *word = word::EMPTY | (0..8).map(bits).sum::<u32>();
        }
    }
}

/// For every empty cell, the number of empty cells ahead of it. Bit i of the octant is set for a ray that descends
/// along axis i.
fn cubes_ahead(is_empty: &[bool], counts: [usize; 3], octant: usize) -> Vec<u8> {
    let [width, height, depth] = counts;
    // For each cell, the side of the empty cube that starts there.
    let mut sides = vec![0_u8; is_empty.len()];
    let in_order = |axis: usize, i: usize| {
        if octant >> axis & 1 == 1 { i } else { counts[axis] - 1 - i }
    };
    for k in 0..depth {
        for j in 0..height {
            for i in 0..width {
                let coordinates = [in_order(0, i), in_order(1, j), in_order(2, k)];
                let index = |[x, y, z]: [usize; 3]| (z * height + y) * width + x;
                if !is_empty[index(coordinates)] {
                    continue;
                }
                let mut side = MAX_AHEAD;
                for neighbour in 1..8_usize {
                    let ahead = [0, 1, 2].map(|axis| {
                        let moves = neighbour >> axis & 1 == 1;
                        match (moves, octant >> axis & 1) {
                            (false, _) => Some(coordinates[axis]),
                            (true, 1) => coordinates[axis].checked_sub(1),
                            (true, _) => Some(coordinates[axis] + 1).filter(|x| *x < counts[axis]),
                        }
                    });
                    if let [Some(x), Some(y), Some(z)] = ahead {
                        side = side.min(sides[index([x, y, z])]);
                    }
                }
                sides[index(coordinates)] = side + 1;
            }
        }
    }
    for side in &mut sides {
        *side = side.saturating_sub(1);
    }
    sides
}
