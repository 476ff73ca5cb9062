//! The choice of first-level cells that get grids of their own, and of how fine these are.

use glam::Vec3;

use super::cells::Cells;
use super::grid::{GridBudget, word};
use super::listed::{Listed, elements};
use crate::parallel::{map_parts, ranges};

/// The length of a list from which a grid may be worthwhile. Even the coarsest grid costs two steps.
const fn crowded<T: Listed>() -> u32 {
    (2.0 * T::STEP_COST / GAIN - T::STEP_COST) as u32 + 1
}

/// The finest level of a grid inside a cell: 2⁵ cells along an axis.
const MAX_LEVEL: u8 = 5;

/// The largest number of inner cells, and of inner list elements, for each element of the list that they replace.
const MOST_GROWTH: usize = 64;

/// A grid is worth its memory if a ray's cost in it is less than this fraction of the list's cost.
const GAIN: f32 = 0.9;

/// Two levels are worthwhile if they save this fraction of the cost of all cells, because a kernel that supports two
/// levels is slower by a tenth in every cell.
const WORTH_IT: f32 = 0.1;

/// A grid inside a cell that would reduce the cost of rays.
#[derive(Clone, Copy)]
struct Candidate {
    cell: u32,
    /// Number of elements of the list that it replaces.
    len: u32,
    level: u8,
    /// Expected number of elements of the lists inside.
    listed: f32,
    /// Cost that a ray through the cell saves.
    saved: f32,
}

/// The crowded cells that get grids of their own within the budget.
pub(super) struct DenseCells {
    /// For every cell, the level of the grid inside it. 0 means no grid.
    levels: Vec<u8>,
}

impl DenseCells {
    /// Chooses cells from the lists of indices. The longest lists come first.
    pub(super) fn of<T: Listed>(
        cells: &Cells,
        shapes: &[T],
        margin: f32,
        (shape_indices, starts): (&[u32], &[u32]),
        budget: GridBudget,
    ) -> Self {
        let candidates = map_parts(ranges(cells.len(), 1 << 12), |range| {
            let lists = range.map(|cell| (cell, starts[cell], starts[cell + 1]));
            lists
                .filter(|(_, start, end)| end - start >= crowded::<T>())
                .filter_map(|(cell, start, end)| {
                    let list = &shape_indices[start as usize..end as usize];
                    let best = best_level(cells.size, list, shapes, margin)?;
                    Some(Candidate { cell: cell as u32, len: end - start, ..best })
                })
                .collect::<Vec<_>>()
        });
        let mut candidates: Vec<Candidate> = candidates.into_iter().flatten().collect();
        let mut levels = vec![0; cells.len()];
        let saved: f32 = candidates.iter().map(|candidate| candidate.saved).sum();
        let all = cells.len() as f32 * T::STEP_COST + shape_indices.len() as f32;
        if saved < WORTH_IT * all {
            return Self { levels };
        }
        candidates.sort_unstable_by_key(|candidate| (std::cmp::Reverse(candidate.len), candidate.cell));
        let mut cells_left = budget.cells.saturating_sub(word::in_whole_units(cells.len()));
        let listed: usize = starts.windows(2).map(|ends| elements::<T>((ends[1] - ends[0]) as usize)).sum();
        let mut listed_left = budget.listed.saturating_sub(listed);
        for Candidate { cell, len, level, listed, .. } in candidates {
            let inner = 1_usize << (3 * level);
            let needed = (inner, max_listed::<T>(listed, inner).saturating_sub(len as usize));
            if needed.0 <= cells_left && needed.1 <= listed_left {
                cells_left -= needed.0;
                listed_left -= needed.1;
                levels[cell as usize] = level;
            }
        }
        Self { levels }
    }

    /// Whether no cell gets a grid.
    pub(super) fn is_none(&self) -> bool {
        self.levels.iter().all(|level| *level == 0)
    }

    /// The level of the grid inside a cell, if there is one.
    pub(super) fn level(&self, cell: usize) -> Option<u8> {
        Some(self.levels[cell]).filter(|level| *level > 0)
    }
}

/// The largest allowed number of list elements inside a cell, given the number expected if spheres are spread evenly.
fn max_listed<T: Listed>(expected: f32, cells: usize) -> usize {
    let most = (expected * 2.0) as usize + 64;
    most + (T::PER_VECTOR - 1) * cells.min(most)
}

/// Makes the lists of the grid inside a cell. They hold indices of shapes and keep the order of the cell's list, which
/// is that of ids. Returns `None` if the lists are longer than [`max_listed`] allows.
pub(super) fn inner_lists<T: Listed>(
    cells: &Cells,
    cell: usize,
    list: &[u32],
    shapes: &[T],
    margin: f32,
    level: u8,
) -> Option<Vec<Vec<u32>>> {
    let inner = inner_cells(cells, cell, level);
    let expected = expected_listed(cells.size, inner.size, list, shapes);
    let most = max_listed::<T>(expected, inner.len());
    let mut lists = vec![Vec::new(); inner.len()];
    for &shape_index in list {
        shapes[shape_index as usize].for_each_near(&inner, margin, |cell| lists[cell].push(shape_index));
    }
    let listed: usize = lists.iter().map(|list| elements::<T>(list.len())).sum();
    (listed <= most).then_some(lists)
}

/// Finds the level at which a ray costs least, if it is cheaper than the list. The caller fills in `cell` and `len`.
fn best_level<T: Listed>(size: f32, list: &[u32], shapes: &[T], margin: f32) -> Option<Candidate> {
    let list_cost = T::STEP_COST + list.len() as f32;
    let mut least = GAIN * list_cost;
    let mut coarser = list_cost;
    let mut best = None;
    for level in 1..=MAX_LEVEL {
        let side = (1_u32 << level) as f32;
        let inner = size / side;
        let most = (MOST_GROWTH * list.len()) as f32;
        if inner < 16.0 * margin || side * side * side > most {
            break;
        }
        let listed = expected_listed(size, inner, list, shapes);
        if listed > most {
            break;
        }
        let cost = side * (T::STEP_COST + listed / (side * side * side));
        if cost < least {
            least = cost;
            best = Some(Candidate { cell: 0, len: 0, level, listed, saved: list_cost - cost });
        }
        // The cost has a single minimum.
        if cost > coarser {
            break;
        }
        coarser = cost;
    }
    best
}

/// The expected number of elements of the lists inside a cell with edge length `size`. Each shape counts the fraction
/// of its overlapped inner cells that lie in this cell.
fn expected_listed<T: Listed>(size: f32, inner: f32, list: &[u32], shapes: &[T]) -> f32 {
    let of = |shape_index: &u32| {
        let shape = &shapes[*shape_index as usize];
        shape.mean_overlapped_cells(inner) / shape.mean_overlapped_cells(size)
    };
    list.iter().map(of).sum()
}

/// The cells of the grid inside a cell.
pub(super) fn inner_cells(cells: &Cells, cell: usize, level: u8) -> Cells {
    let side = 1_u32 << level;
    Cells { min: corner(cells, cell), size: cells.size / side as f32, counts: [side; 3] }
}

/// The corner of a cell that has the smallest coordinates.
pub(super) fn corner(cells: &Cells, cell: usize) -> Vec3 {
    let [width, height, _] = cells.counts.map(|count| count as usize);
    let coordinates = [cell % width, cell / width % height, cell / (width * height)];
    cells.min + cells.size * Vec3::from(coordinates.map(|i| i as f32))
}
