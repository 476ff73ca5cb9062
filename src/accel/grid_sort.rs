//! Counting sort by cell, in time proportional to the number of spheres and cells, on all cores. The result does not
//! depend on the number of cores.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use super::cells::Cells;
use super::grid::ListLayout;
use crate::parallel::{for_each, map, map_parts, ranges, split_mut};

/// The number of spheres or cells that one task handles.
pub(super) const CHUNK: usize = 1 << 14;

/// Sorts spheres by the cells of their centres, block by block, so that spheres that are close in space are close in
/// memory; within a cell, by id. Returns the spheres and their ids.
pub(super) fn sort_by_cell(
    spheres: &[[f32; 4]],
    ids: &[u32],
    cells: &Cells,
) -> (Vec<[f32; 4]>, Vec<u32>) {
    let counts = zeros(cells.len_in_blocks());
    for_ranges(ids.len(), |range| {
        for id in &ids[range] {
            let cell = cells.index_in_blocks(&spheres[*id as usize]);
            counts[cell].fetch_add(1, Ordering::Relaxed);
        }
    });
    let ends = add_up(counts);
    let order = zeros(ids.len());
    for_ranges(ids.len(), |range| {
        for id in &ids[range] {
            let cell = cells.index_in_blocks(&spheres[*id as usize]);
            let at = ends[cell].fetch_sub(1, Ordering::Relaxed) - 1;
            order[at as usize].store(*id, Ordering::Relaxed);
        }
    });
    // The ends have been counted down, so they are starts now.
    let starts = plain(ends);
    let mut order = plain(order);
    each_list(&mut order, &starts, |_, list| list.sort_unstable());
    let mut sorted = vec![[0.0; 4]; order.len()];
    let parts = sorted.chunks_mut(CHUNK).zip(order.chunks(CHUNK)).collect();
    for_each(parts, |(target, ids): (&mut [[f32; 4]], &[u32])| {
        for (sphere, id) in target.iter_mut().zip(ids) {
            *sphere = spheres[*id as usize];
        }
    });
    (sorted, order)
}

/// The number of spheres that overlap each cell.
pub(super) fn count(spheres: &[[f32; 4]], cells: &Cells, margin: f32) -> Vec<AtomicU32> {
    let counts = zeros(cells.len());
    for_ranges(spheres.len(), |range| {
        for sphere in &spheres[range] {
            cells.for_each_near(sphere, margin, |cell| {
                counts[cell].fetch_add(1, Ordering::Relaxed);
            });
        }
    });
    counts
}

/// The number of elements of lists with so many spheres each.
pub(super) fn total(counts: &[AtomicU32], layout: ListLayout) -> u64 {
    let elements =
        |count: &AtomicU32| layout.elements(count.load(Ordering::Relaxed) as usize) as u64;
    counts.iter().map(elements).sum()
}

/// The indices of the spheres that overlap each cell, cell by cell, and the start of each cell's list.
pub(super) struct Lists {
    pub(super) shape_indices: Vec<u32>,
    pub(super) starts: Vec<u32>,
}

/// Fills the lists of all cells: the second half of the counting sort.
pub(super) fn fill(
    spheres: &[[f32; 4]],
    cells: &Cells,
    margin: f32,
    counts: Vec<AtomicU32>,
) -> Lists {
    let total = total(&counts, ListLayout::Referenced) as usize;
    let ends = add_up(counts);
    let shape_indices = zeros(total);
    for_ranges(spheres.len(), |range| {
        for shape_index in range {
            cells.for_each_near(&spheres[shape_index], margin, |cell| {
                let at = ends[cell].fetch_sub(1, Ordering::Relaxed) - 1;
                shape_indices[at as usize].store(shape_index as u32, Ordering::Relaxed);
            });
        }
    });
    // The ends have been counted down, so they are starts now.
    Lists { shape_indices: plain(shape_indices), starts: plain(ends) }
}

fn zeros(len: usize) -> Vec<AtomicU32> {
    map(len, |_| AtomicU32::default())
}

fn plain(atomics: Vec<AtomicU32>) -> Vec<u32> {
    atomics.into_iter().map(AtomicU32::into_inner).collect()
}

/// Turns the length of each list into the index where it ends, and appends the total length.
fn add_up(mut counts: Vec<AtomicU32>) -> Vec<AtomicU32> {
    let mut end = 0;
    for count in &mut counts {
        end += *count.get_mut();
        *count.get_mut() = end;
    }
    counts.push(AtomicU32::new(end));
    counts
}

/// Calls `f` with every cell and its list.
fn each_list(values: &mut [u32], starts: &[u32], f: impl Fn(usize, &mut [u32]) + Sync + Send) {
    let chunks = ranges(starts.len() - 1, CHUNK);
    let parts = split_mut(values, chunks.iter().map(|range| starts[range.end] as usize));
    for_each(chunks.into_iter().zip(parts).collect(), |(range, part)| {
        let first = starts[range.start];
        for cell in range {
            f(
                cell,
                &mut part[(starts[cell] - first) as usize..(starts[cell + 1] - first) as usize],
            );
        }
    });
}

fn for_ranges(count: usize, f: impl Fn(Range<usize>) + Sync + Send) {
    for_each(ranges(count, CHUNK), f);
}

pub(super) fn map_ranges<R: Send>(
    count: usize,
    f: impl Fn(Range<usize>) -> R + Sync + Send,
) -> Vec<R> {
    map_parts(ranges(count, CHUNK), f)
}
