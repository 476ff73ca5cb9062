//! Sorting spheres by cell, and making lists for all cells, on all cores. The number of cores changes no result.
//!
//! A counting sort of all spheres at once would write every sphere far from the one before, and wait for memory each
//! time. Here spheres are first moved into buckets. A bucket covers so few cells that its spheres fit into a
//! processor's L2 cache. Then each bucket is sorted. Both steps keep the order of ids.
//!
//! Lists are made slab by slab. A slab is a range of rows of cells. Only one task at a time writes to it, so that counting needs no atomic operations,
//! which take several times as long. Each sphere is looked at in every slab that it may overlap.
use std::ops::Range;

use super::cells::{CellVectors, Cells, Octet, Strides};
use super::listed::elements;
use crate::parallel::{for_each, map_parts, ranges, split_mut};

/// The number of spheres or cells that one task handles.
pub(super) const CHUNK: usize = 1 << 14;

/// The number of spheres that one task moves into buckets.
const MOVED: usize = 1 << 17;

/// The average number of spheres in a bucket, and the largest number of buckets. A task writes to all buckets by turns,
/// so their ends must fit into a cache.
const IN_BUCKET: usize = 1 << 13;
const MOST_BUCKETS: usize = 1 << 10;

/// A sphere on its way, with its id and the index of its cell.
type Item = ([f32; 4], u32, u32);

/// Sorts spheres with ascending ids by the cells of their centres, block by block, so that spheres that are close in
/// space are close in memory. Spheres of one cell are sorted by id. Returns the spheres and their ids.
pub(super) fn sort_by_cell(spheres: Vec<[f32; 4]>, ids: &[u32], cells: &Cells) -> (Vec<[f32; 4]>, Vec<u32>) {
    let buckets = spheres.len().div_ceil(IN_BUCKET).clamp(1, MOST_BUCKETS);
    // The number of cells per bucket is a power of two.
    let cells = CellVectors::of(cells);
    let shift = cells.len_in_blocks().div_ceil(buckets).next_power_of_two().trailing_zeros();
    let buckets = (cells.len_in_blocks() >> shift) + 1;
    let (items, ends) = into_buckets(&spheres, ids, &cells, shift, buckets);
    // The memory of the spheres is used again, because allocating fresh memory is slow.
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
    // The places of a chunk in each bucket follow those of the previous chunk.
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
            // The places were counted by the same function, so there is one for each sphere.
            if let Some(place) = targets[cell >> shift].next() {
                *place = (*sphere, *id, cell as u32);
            }
        }
    });
    (items, ends)
}

/// Sorts the spheres of a bucket of consecutive cells by cell, with a counting sort.
fn sort_bucket(items: &[Item], first: usize, cells: usize, spheres: &mut [[f32; 4]], ids: &mut [u32]) {
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

/// The number of slabs: several for each core of most machines. With more, more spheres would overlap two slabs.
const SLABS: usize = 32;

/// The number of spheres that one task assigns to slabs.
const ASSIGNED: usize = 1 << 16;

/// The lists of all cells. They hold indices of spheres in the order of ids.
pub(super) struct Lists {
    pub(super) shape_indices: Vec<u32>,
    /// The start of each cell's list, and the end of the last.
    pub(super) starts: Vec<u32>,
}

/// The number of spheres that overlap each cell, and the data to list them.
pub(super) struct Overlaps<'a> {
    cells: Cells,
    spheres: &'a [[f32; 4]],
    margin: f32,
    octets: Vec<Octet>,
    slabs: Vec<Slab>,
    counts: Vec<u32>,
}

/// A range of rows of cells, and the spheres that may overlap it.
struct Slab {
    rows: Range<usize>,
    /// Ranges of spheres that may overlap the slab. Spheres are sorted by cell, so most are in a few long ranges.
    spheres: Vec<Range<u32>>,
}

impl<'a> Overlaps<'a> {
    /// Counts the spheres that overlap each cell.
    pub(super) fn new(spheres: &'a [[f32; 4]], cells: &Cells, margin: f32) -> Self {
        let (octets, slabs) = assign(spheres, cells, margin);
        let mut all = Self { cells: *cells, spheres, margin, octets, slabs, counts: Vec::new() };
        let mut counts = vec![0; cells.len()];
        let targets = split_mut(&mut counts, all.slabs.iter().map(|slab| slab.end(cells)));
        for_each(all.slabs.iter().zip(targets).collect(), |(slab, counts): (&Slab, &mut [u32])| {
            all.for_each_near(slab, |_, cell| counts[cell] += 1);
        });
        all.counts = counts;
        all
    }

    /// The number of elements of all lists together.
    pub(super) fn total(&self) -> u64 {
        self.counts.iter().map(|count| elements::<[f32; 4]>(*count as usize) as u64).sum()
    }

    /// Fills the lists of all cells.
    pub(super) fn fill(mut self, ids: &[u32]) -> Lists {
        let mut starts = std::mem::take(&mut self.counts);
        let (mut end, mut ends) = (0, Vec::with_capacity(self.slabs.len()));
        for slab in &self.slabs {
            let counts = &starts[slab.start(&self.cells)..slab.end(&self.cells)];
            end += counts.iter().map(|count| *count as usize).sum::<usize>();
            ends.push(end);
        }
        let mut shape_indices = vec![0; end];
        let lists = split_mut(&mut shape_indices, ends.iter().copied());
        let cell_ends = self.slabs.iter().map(|slab| slab.end(&self.cells));
        let mut tasks = Vec::with_capacity(self.slabs.len());
        let mut start = 0;
        for ((slab, lists), starts) in self.slabs.iter().zip(lists).zip(split_mut(&mut starts, cell_ends)) {
            let first = start;
            start += lists.len();
            tasks.push((slab, first as u32, lists, starts));
        }
        for_each(tasks, |(slab, first, lists, starts)| {
            self.fill_slab(slab, ids, lists, starts);
            for start in starts {
                *start += first;
            }
        });
        starts.push(end as u32);
        Lists { shape_indices, starts }
    }

    /// Fills the lists of a slab: the second half of a counting sort. On entry, `starts` has the number of spheres of
    /// each cell. On return, it has the starts of their lists, counted from the start of the slab's first list.
    fn fill_slab(&self, slab: &Slab, ids: &[u32], lists: &mut [u32], starts: &mut [u32]) {
        let mut end = 0;
        for count in starts.iter_mut() {
            end += *count;
            *count = end;
        }
        // Elements combined with their ids, by which each list is sorted.
        let mut keys = vec![0_u64; lists.len()];
        self.for_each_near(slab, |shape_index, cell| {
            let end = &mut starts[cell];
            *end -= 1;
            let id = u64::from(ids[shape_index as usize]);
            keys[*end as usize] = id << 32 | u64::from(shape_index);
        });
        // The ends have been counted down and are starts now. The lists are sorted from the last to the first.
        let mut end = lists.len();
        for start in starts.iter().rev() {
            keys[*start as usize..end].sort_unstable();
            end = *start as usize;
        }
        for (element, key) in lists.iter_mut().zip(keys) {
            // The lower half of the key is the index.
            *element = key as u32;
        }
    }

    /// Calls `f` with every sphere and every cell of the slab that it overlaps. Cells count from the slab's first.
    fn for_each_near(&self, slab: &Slab, mut f: impl FnMut(u32, usize)) {
        let Self { cells, spheres, margin, octets, .. } = self;
        let strides = Strides::of(cells);
        let (start, end) = (slab.start(cells), slab.end(cells));
        for range in &slab.spheres {
            for shape_index in range.clone() {
                let octet = octets[shape_index as usize];
                if octet.is_known() {
                    octet.for_each(&strides, |cell| {
                        if (start..end).contains(&cell) {
                            f(shape_index, cell - start);
                        }
                    });
                } else {
                    let sphere = &spheres[shape_index as usize];
                    cells.for_each_near(sphere, *margin, true, &slab.rows, |cell| {
                        f(shape_index, cell - start);
                    });
                }
            }
        }
    }
}

impl Slab {
    /// The index of the first cell.
    fn start(&self, cells: &Cells) -> usize {
        self.rows.start * cells.counts[0] as usize
    }

    /// The index of the cell after the last.
    fn end(&self, cells: &Cells) -> usize {
        self.rows.end * cells.counts[0] as usize
    }
}

/// Divides the rows of cells into slabs, and assigns the spheres to them.
fn assign(spheres: &[[f32; 4]], cells: &Cells, margin: f32) -> (Vec<Octet>, Vec<Slab>) {
    let rows = ranges(cells.rows(), cells.rows().div_ceil(SLABS));
    let rows_of_slab = rows.first().map_or(1, Range::len);
    let cells_of_slab = rows_of_slab * cells.counts[0] as usize;
    let strides = Strides::of(cells);
    let mut octets = vec![Octet::default(); spheres.len()];
    let chunks = spheres.chunks(ASSIGNED).zip(octets.chunks_mut(ASSIGNED)).enumerate();
    let assigned = map_parts(chunks.collect(), |(chunk, (spheres, octets))| {
        let mut of_slabs: Vec<Vec<Range<u32>>> = vec![Vec::new(); rows.len()];
        let vectors = CellVectors::of(cells);
        let mut here = 0;
        for (number, (sphere, octet)) in spheres.iter().zip(octets).enumerate() {
            let shape_index = (chunk * ASSIGNED + number) as u32;
            *octet = Octet::of(sphere, &vectors, margin);
            if !octet.is_known() {
                let mut next = 0;
                cells.for_each_range_of_rows(sphere, margin, |first, last| {
                    let (from, to) = (next.max(first / rows_of_slab), last / rows_of_slab);
                    for of_slab in of_slabs.iter_mut().take(to + 1).skip(from) {
                        add(of_slab, shape_index);
                    }
                    next = to + 1;
                });
                continue;
            }
            // Most spheres are in the same slab as the previous one.
            let first = octet.first();
            if !(here * cells_of_slab..(here + 1) * cells_of_slab).contains(&first) {
                here = first / cells_of_slab;
            }
            add(&mut of_slabs[here], shape_index);
            if octet.last(&strides) >= (here + 1) * cells_of_slab {
                let mut before = here;
                octet.for_each(&strides, |cell| {
                    let slab = cell / cells_of_slab;
                    if slab > before {
                        add(&mut of_slabs[slab], shape_index);
                        before = slab;
                    }
                });
            }
        }
        of_slabs
    });
    let slab = |(slab, rows): (usize, Range<usize>)| {
        let spheres = assigned.iter().flat_map(|of_slabs: &Vec<Vec<Range<u32>>>| of_slabs[slab].clone());
        Slab { rows, spheres: spheres.collect() }
    };
    let slabs = rows.into_iter().enumerate().map(slab).collect();
    (octets, slabs)
}

/// Adds an index to ranges of ascending indices.
fn add(ranges: &mut Vec<Range<u32>>, index: u32) {
    match ranges.last_mut() {
        Some(last) if last.end == index => last.end = index + 1,
        _ => ranges.push(index..index + 1),
    }
}
