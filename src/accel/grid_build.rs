//! Builds grids by counting sort, in time proportional to the spheres and the cells.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec3;

use super::cells::{Cells, mean_cells_met};
use super::grid::{Grid, LAST, ListLayout, MAX_CELLS, word};
use super::grid_crowd::{Crowd, inner_lists};
use super::grid_empty::mark_empty_surroundings;
use super::parallel::{chunks, for_each, map, split_mut};

/// What a step from cell to cell costs, in sphere tests. Measured on lavapipe with a million random
/// spheres, where the time hardly changes between four and eight.
pub(super) const STEP_COST: f32 = 5.0;

/// How many spheres or cells one task handles.
const CHUNK: usize = 1 << 14;

/// How large a grid may become.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridBudget {
    /// The most elements of all lists.
    pub listed: usize,
    /// The most cells, of both levels.
    pub cells: usize,
}

/// A grid, with its spheres in the order of its places, and the id of each.
#[derive(Clone, Debug, PartialEq)]
pub struct BuiltGrid {
    /// The cells.
    pub grid: Grid,
    /// Centre and radius; negative at the end of a list that is a run of copies.
    pub spheres: Vec<[f32; 4]>,
    /// Index in input order.
    pub ids: Vec<u32>,
}

/// Builds a grid over spheres, `ids` of all of which there are at least one.
///
/// A sphere is listed in every cell that lies within `margin` of its surface.
#[must_use]
pub fn build_grid(
    spheres: &[[f32; 4]],
    ids: &[u32],
    margin: f32,
    layout: ListLayout,
    budget: GridBudget,
) -> BuiltGrid {
    let (min, max) = bounds(spheres, ids, margin);
    let mut cells = first_level(spheres, ids, (min, max), budget);
    // The size was chosen by volume, and a flat box has more cells than its volume says.
    while cells.len() > budget.cells.min(MAX_CELLS) {
        cells = coarser(&cells, max);
    }
    let (sorted, sorted_ids) = sort_by_cell(spheres, ids, &cells);
    let mut counts = count(&sorted, &cells, margin);
    // The size was chosen for spheres at random positions; spheres in step with the cells may meet more.
    while total(&counts) > budget.listed as u64 && cells.len() > 1 {
        cells = coarser(&cells, max);
        counts = count(&sorted, &cells, margin);
    }
    let lists = fill(&sorted, &cells, margin, &counts);
    drop(counts);
    assemble(&cells, margin, layout, budget, (sorted, sorted_ids), &lists)
}

/// The box of the spheres, inflated.
fn bounds(spheres: &[[f32; 4]], ids: &[u32], margin: f32) -> (Vec3, Vec3) {
    let parts = map_chunks(ids.len(), |range| {
        ids[range].iter().fold((Vec3::MAX, Vec3::MIN), |(min, max), id| {
            let [x, y, z, r] = spheres[*id as usize];
            let center = Vec3::new(x, y, z);
            (min.min(center - r), max.max(center + r))
        })
    });
    let (min, max) = parts
        .into_iter()
        .fold((Vec3::MAX, Vec3::MIN), |(min, max), part| (min.min(part.0), max.max(part.1)));
    (min - margin, max + margin)
}

/// Cells of the size at which a ray is expected to cost least: a walk of length L takes about L/size
/// steps, each with the tests of one cell's list.
fn first_level(
    spheres: &[[f32; 4]],
    ids: &[u32],
    (min, max): (Vec3, Vec3),
    budget: GridBudget,
) -> Cells {
    const SAMPLES: usize = 4096;
    let stride = ids.len().div_ceil(SAMPLES);
    let radii: Vec<f32> = ids.iter().step_by(stride).map(|id| spheres[*id as usize][3]).collect();
    let extent = max - min;
    let longest = extent.max_element();
    // A flat scene has a volume as well.
    let sides = extent.max(Vec3::splat(longest * 1e-3));
    let volume = f64::from(sides.x) * f64::from(sides.y) * f64::from(sides.z);
    let most_cells = budget.cells.min(MAX_CELLS / 2) as f64;
    let mut best: Option<(f64, f32)> = None;
    // From one cell to 1024 along the longest side, in steps of an eighth of an octave.
    for step in 0..=80_u8 {
        let size = longest / (f32::from(step) / 8.0).exp2();
        let met: f32 = radii.iter().map(|r| mean_cells_met(size, *r)).sum();
        let listed = f64::from(met) / radii.len() as f64 * ids.len() as f64;
        let cells = volume / f64::from(size).powi(3);
        let fits = listed <= budget.listed as f64 * 0.97 && cells <= most_cells * 0.9;
        let cost = (f64::from(STEP_COST) + listed / cells.max(1.0)) / f64::from(size);
        if (fits || step == 0) && best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, size));
        }
    }
    cells_of_size(min, max, best.map_or(longest, |(_, size)| size))
}

fn cells_of_size(min: Vec3, max: Vec3, size: f32) -> Cells {
    let counts = ((max - min) / size).to_array().map(|count| (count.ceil() as u32).max(1));
    Cells { min, size, counts }
}

fn coarser(cells: &Cells, max: Vec3) -> Cells {
    cells_of_size(cells.min, max, cells.size * 1.1)
}

/// The spheres in the order of the cells that hold their centres, block by block, so that what is near in
/// space is near in memory; within a cell, by id.
fn sort_by_cell(spheres: &[[f32; 4]], ids: &[u32], cells: &Cells) -> (Vec<[f32; 4]>, Vec<u32>) {
    let counts = zeros(cells.len_in_blocks());
    for_chunks(ids.len(), |range| {
        for id in &ids[range] {
            let cell = cells.index_in_blocks(&spheres[*id as usize]);
            counts[cell].fetch_add(1, Ordering::Relaxed);
        }
    });
    let starts = starts(&counts);
    let order = zeros(ids.len());
    for_chunks(ids.len(), |range| {
        for id in &ids[range] {
            let cell = cells.index_in_blocks(&spheres[*id as usize]);
            // Counts down, so that no second array of counts is needed.
            let at = starts[cell] + counts[cell].fetch_sub(1, Ordering::Relaxed) - 1;
            order[at as usize].store(*id, Ordering::Relaxed);
        }
    });
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

/// How many spheres meet each cell.
fn count(spheres: &[[f32; 4]], cells: &Cells, margin: f32) -> Vec<AtomicU32> {
    let counts = zeros(cells.len());
    for_chunks(spheres.len(), |range| {
        for sphere in &spheres[range] {
            cells.met_by(sphere, margin, |cell| {
                counts[cell].fetch_add(1, Ordering::Relaxed);
            });
        }
    });
    counts
}

fn total(counts: &[AtomicU32]) -> u64 {
    counts.iter().map(|count| u64::from(count.load(Ordering::Relaxed))).sum()
}

/// The places of the spheres that meet each cell, cell by cell, and where each cell's start.
struct Lists {
    places: Vec<u32>,
    starts: Vec<u32>,
}

/// The second half of the counting sort. Uses up the counts.
fn fill(spheres: &[[f32; 4]], cells: &Cells, margin: f32, counts: &[AtomicU32]) -> Lists {
    let starts = starts(counts);
    let places = zeros(starts[cells.len()] as usize);
    for_chunks(spheres.len(), |range| {
        for place in range {
            cells.met_by(&spheres[place], margin, |cell| {
                let at = starts[cell] + counts[cell].fetch_sub(1, Ordering::Relaxed) - 1;
                places[at as usize].store(place as u32, Ordering::Relaxed);
            });
        }
    });
    Lists { places: plain(places), starts }
}

/// A run of cells on its way into the grid: its words, with positions that count from its own start.
#[derive(Default)]
struct Part {
    /// Words of the first level.
    words: Vec<u32>,
    /// Words of the grids inside.
    inner: Vec<u32>,
    /// Places, list after list; the last of each is marked.
    lists: Vec<u32>,
}

fn assemble(
    cells: &Cells,
    margin: f32,
    layout: ListLayout,
    budget: GridBudget,
    (sorted, sorted_ids): (Vec<[f32; 4]>, Vec<u32>),
    lists: &Lists,
) -> BuiltGrid {
    let first_level_len = cells.len().next_multiple_of(8);
    let crowd = Crowd::of(cells, &sorted, margin, (&lists.places, &lists.starts), budget);
    let parts = map_chunks(cells.len(), |range| {
        let mut part = Part::default();
        for cell in range {
            let (start, end) = (lists.starts[cell] as usize, lists.starts[cell + 1] as usize);
            let mut list = lists.places[start..end].to_vec();
            prepare(&mut list, &sorted, &sorted_ids);
            let inner = crowd.level(cell).and_then(|level| {
                Some((level, inner_lists(cells, cell, &list, &sorted, margin, level)?))
            });
            let word = match inner {
                Some((level, inner)) => {
                    let start = (part.inner.len() / 8) as u32;
                    for list in inner {
                        let word = append(&mut part.lists, &list);
                        part.inner.push(word);
                    }
                    word::GRID | u32::from(level) << word::LEVEL_SHIFT | start
                }
                None => append(&mut part.lists, &list),
            };
            part.words.push(word);
        }
        part
    });
    let mut grid = Grid {
        min: cells.min,
        cell_size: cells.size,
        cell_counts: cells.counts,
        cells: Vec::new(),
        references: None,
    };
    let places = join(&mut grid.cells, first_level_len, &parts);
    drop(parts);
    mark_empty_surroundings(&mut grid.cells, cells.counts);
    match layout {
        ListLayout::Referenced => {
            grid.references = Some(places);
            BuiltGrid { grid, spheres: sorted, ids: sorted_ids }
        }
        ListLayout::Copied => {
            let (spheres, ids) = copies(&places, &sorted, &sorted_ids);
            BuiltGrid { grid, spheres, ids }
        }
    }
}

/// Sorts a list by id, so that of equal distances the first is the one that counts. In a long list, of
/// spheres that are the same, only the one that counts remains.
fn prepare(list: &mut Vec<u32>, sorted: &[[f32; 4]], sorted_ids: &[u32]) {
    const LONG: usize = 32;
    list.sort_unstable_by_key(|place| sorted_ids[*place as usize]);
    if list.len() > LONG {
        let mut seen = std::collections::HashSet::with_capacity(list.len());
        list.retain(|place| seen.insert(sorted[*place as usize].map(f32::to_bits)));
    }
}

/// Appends a list, and gives the word of its cell.
fn append(lists: &mut Vec<u32>, list: &[u32]) -> u32 {
    let Some((last, others)) = list.split_last() else {
        return word::EMPTY;
    };
    let start = lists.len() as u32;
    lists.extend_from_slice(others);
    lists.push(last | LAST);
    word::LIST | start
}

/// Joins the parts' words into `cells`, and gives their lists.
fn join(cells: &mut Vec<u32>, first_level_len: usize, parts: &[Part]) -> Vec<u32> {
    let inner_len: usize = parts.iter().map(|part| part.inner.len()).sum();
    let mut places = Vec::with_capacity(parts.iter().map(|part| part.lists.len()).sum());
    let mut inner = Vec::with_capacity(inner_len);
    cells.reserve_exact(first_level_len + inner_len);
    for part in parts {
        let list_start = places.len() as u32;
        let inner_start = ((first_level_len + inner.len()) / 8) as u32;
        let moved = |cell: &u32| match cell & word::KIND {
            word::LIST => cell + list_start,
            word::GRID => cell + inner_start,
            _ => *cell,
        };
        cells.extend(part.words.iter().map(moved));
        inner.extend(part.inner.iter().map(moved));
        places.extend_from_slice(&part.lists);
    }
    cells.resize(first_level_len, word::EMPTY);
    cells.extend_from_slice(&inner);
    places
}

/// Every listed sphere by itself.
fn copies(places: &[u32], sorted: &[[f32; 4]], sorted_ids: &[u32]) -> (Vec<[f32; 4]>, Vec<u32>) {
    let mut spheres = vec![[0.0; 4]; places.len()];
    let mut ids = vec![0; places.len()];
    let parts = spheres.chunks_mut(CHUNK).zip(ids.chunks_mut(CHUNK)).zip(places.chunks(CHUNK));
    for_each(parts.collect(), |((spheres, ids), places)| {
        for ((sphere, id), place) in spheres.iter_mut().zip(ids).zip(places) {
            let at = (place & !LAST) as usize;
            *sphere = sorted[at];
            if place & LAST != 0 {
                sphere[3] = -sphere[3];
            }
            *id = sorted_ids[at];
        }
    });
    (spheres, ids)
}

fn zeros(len: usize) -> Vec<AtomicU32> {
    std::iter::repeat_with(AtomicU32::default).take(len).collect()
}

fn plain(atomics: Vec<AtomicU32>) -> Vec<u32> {
    atomics.into_iter().map(AtomicU32::into_inner).collect()
}

/// Where each cell's list starts, and at the end where the last one ends.
fn starts(counts: &[AtomicU32]) -> Vec<u32> {
    let mut starts = Vec::with_capacity(counts.len() + 1);
    let mut next = 0;
    for count in counts {
        starts.push(next);
        next += count.load(Ordering::Relaxed);
    }
    starts.push(next);
    starts
}

/// Calls `f` with every list and its cell.
fn each_list(values: &mut [u32], starts: &[u32], f: impl Fn(usize, &mut [u32]) + Sync) {
    let ranges = chunks(starts.len() - 1, CHUNK);
    let parts = split_mut(values, ranges.iter().map(|range| starts[range.end] as usize));
    for_each(ranges.into_iter().zip(parts).collect(), |(range, part)| {
        let first = starts[range.start];
        for cell in range {
            f(
                cell,
                &mut part[(starts[cell] - first) as usize..(starts[cell + 1] - first) as usize],
            );
        }
    });
}

fn for_chunks(count: usize, f: impl Fn(std::ops::Range<usize>) + Sync) {
    for_each(chunks(count, CHUNK), f);
}

fn map_chunks<R: Send>(count: usize, f: impl Fn(std::ops::Range<usize>) -> R + Sync) -> Vec<R> {
    let ranges = chunks(count, CHUNK);
    map(ranges.len(), |i| f(ranges[i].clone()))
}
