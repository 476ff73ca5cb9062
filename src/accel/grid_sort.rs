//! Sorting spheres by cell on all cores. The result does not depend on the number of cores.
//!
//! A counting sort of all spheres at once would write every sphere far from the one before, and wait for memory each
//! time. Here spheres are first moved into buckets, of so few cells that the spheres of a bucket fit into a processor's
//! L2 cache, and then sorted bucket by bucket. Both steps keep the order of ids.

use super::cells::{CellVectors, Cells};
use crate::parallel::{for_each, map_parts, ranges, split_mut};

/// The number of spheres or cells that one task handles.
pub(super) const CHUNK: usize = 1 << 14;

/// The number of spheres that one task moves into buckets.
const MOVED: usize = 1 << 17;

/// The number of spheres in a bucket, on average, and the largest number of buckets: a task writes to all of them by
/// turns, so their ends must fit into a cache.
const IN_BUCKET: usize = 1 << 13;
const MOST_BUCKETS: usize = 1 << 10;

/// A sphere on its way, with its id and the index of its cell.
type Item = ([f32; 4], u32, u32);

/// Sorts spheres with ascending ids by the cells of their centres, block by block, so that spheres that are close in
/// space are close in memory; within a cell, by id. Returns the spheres and their ids.
pub(super) fn sort_by_cell(
    spheres: Vec<[f32; 4]>,
    ids: &[u32],
    cells: &Cells,
) -> (Vec<[f32; 4]>, Vec<u32>) {
    let buckets = spheres.len().div_ceil(IN_BUCKET).clamp(1, MOST_BUCKETS);
    // The number of cells of a bucket is a power of two.
    let cells = CellVectors::of(cells);
    let shift = cells.len_in_blocks().div_ceil(buckets).next_power_of_two().trailing_zeros();
    let buckets = (cells.len_in_blocks() >> shift) + 1;
    let (items, ends) = into_buckets(&spheres, ids, &cells, shift, buckets);
    // The memory of the spheres is used again, because fresh memory is slow to come by.
    let (mut sorted, mut sorted_ids) = (spheres, vec![0; ids.len()]);
    let targets = split_mut(&mut sorted, ends.iter().copied());
    let targets = targets.into_iter().zip(split_mut(&mut sorted_ids, ends.iter().copied()));
    let mut start = 0;
    let tasks = ends.iter().zip(targets).enumerate().map(|(bucket, (end, target))| {
        let items = &items[start..*end];
        start = *end;
        (bucket << shift, items, target)
    });
    for_each(tasks.collect(), |(first, items, (spheres, ids))| {
        sort_bucket(items, first, 1 << shift, spheres, ids);
    });
    (sorted, sorted_ids)
}

/// Moves spheres into buckets. Returns them bucket by bucket, and the ends of the buckets.
fn into_buckets(
    spheres: &[[f32; 4]],
    ids: &[u32],
    cells: &CellVectors,
    shift: u32,
    buckets: usize,
) -> (Vec<Item>, Vec<usize>) {
    let chunks = ranges(spheres.len(), MOVED);
    let counts = map_parts(chunks.clone(), |chunk| {
        let (cells, mut counts) = (*cells, vec![0_u32; buckets]);
        for sphere in &spheres[chunk] {
            counts[cells.index_in_blocks(sphere) >> shift] += 1;
        }
        counts
    });
    let mut items: Vec<Item> = vec![([0.0; 4], 0, 0); spheres.len()];
    // The places of a chunk in each bucket follow those of the chunk before.
    let (mut end, mut ends) = (0, Vec::with_capacity(buckets));
    let mut ends_of_places = Vec::with_capacity(buckets * chunks.len());
    for bucket in 0..buckets {
        for of_chunk in &counts {
            end += of_chunk[bucket] as usize;
            ends_of_places.push(end);
        }
        ends.push(end);
    }
    let mut tasks: Vec<_> = chunks.into_iter().map(|chunk| (chunk, Vec::new())).collect();
    let places = split_mut(&mut items, ends_of_places);
    for (number, place) in places.into_iter().enumerate() {
        let chunk = number % counts.len();
        tasks[chunk].1.push(place.iter_mut());
    }
    for_each(tasks, |(chunk, mut targets)| {
        let cells = *cells;
        for (sphere, id) in spheres[chunk.clone()].iter().zip(&ids[chunk]) {
            let cell = cells.index_in_blocks(sphere);
            // The places were counted by the same function.
            if let Some(place) = targets[cell >> shift].next() {
                *place = (*sphere, *id, cell as u32);
            }
        }
    });
    (items, ends)
}

/// Sorts the spheres of a bucket of consecutive cells by cell: a counting sort.
fn sort_bucket(
    items: &[Item],
    first: usize,
    cells: usize,
    spheres: &mut [[f32; 4]],
    ids: &mut [u32],
) {
    let mut starts = vec![0_u32; cells];
    for (_, _, cell) in items {
        starts[*cell as usize - first] += 1;
    }
    let mut end = 0;
    for start in &mut starts {
        let count = *start;
        *start = end;
        end += count;
    }
    for (sphere, id, cell) in items {
        let start = &mut starts[*cell as usize - first];
        let at = *start as usize;
        *start += 1;
        (spheres[at], ids[at]) = (*sphere, *id);
    }
}
