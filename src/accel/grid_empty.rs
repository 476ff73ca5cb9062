//! How far around an empty cell all others are empty, so that a ray may cross them in one step.

use super::grid::word;

/// A step this long is long enough.
const FARTHEST: u32 = 32;

/// Below this part of empty cells, there is little to skip.
const WORTH_IT: f32 = 0.25;

/// Writes into every empty word of the first level how many cells around it, in every direction, are
/// empty as well: its distance, in Chebyshev's sense, to the nearest cell with a sphere, less one.
///
/// Two sweeps (Rosenfeld and Pfaltz, "Sequential Operations in Digital Picture Processing", 1966, in three
/// dimensions): a cell's distance is one more than the least of its neighbours' that come before it, and
/// then, backwards, of those that come after it.
pub(super) fn mark_empty_surroundings(words: &mut [u32], counts: [u32; 3]) {
    let [width, height, depth] = counts.map(|count| count as usize);
    let len = width * height * depth;
    let empty = words[..len].iter().filter(|word| *word & word::KIND == word::EMPTY).count();
    if (empty as f32) < WORTH_IT * len as f32 {
        return;
    }
    let mut distances: Vec<u8> = words[..len]
        .iter()
        .map(|w| if w & word::KIND == word::EMPTY { u8::MAX } else { 0 })
        .collect();
    // Neighbours that come before a cell in memory.
    let before: Vec<[isize; 3]> =
        (0..13).map(|i: isize| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]).collect();
    let sweep = |distances: &mut [u8], cell: usize, sign: isize| {
        if distances[cell] == 0 {
            return;
        }
        let place = [cell % width, cell / width % height, cell / (width * height)];
        let mut nearest = u32::from(distances[cell]);
        for step in &before {
            let mut index = 0;
            let mut outside = false;
            for axis in [2, 1, 0] {
                let side = [width, height, depth][axis];
                let i = place[axis] as isize + sign * step[axis];
                outside |= i < 0 || i >= side as isize;
                index = index * side as isize + i;
            }
            if !outside {
                nearest = nearest.min(u32::from(distances[index as usize]) + 1);
            }
        }
        distances[cell] = nearest.min(FARTHEST) as u8;
    };
    for cell in 0..len {
        sweep(&mut distances, cell, 1);
    }
    for cell in (0..len).rev() {
        sweep(&mut distances, cell, -1);
    }
    for (word, distance) in words[..len].iter_mut().zip(distances) {
        if distance > 0 {
            *word = word::EMPTY | (u32::from(distance) - 1);
        }
    }
}
