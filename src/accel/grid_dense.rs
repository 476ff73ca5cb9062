//! Which cells of the first level get a grid of their own, and how fine it is.

use glam::Vec3;

use super::cells::{Cells, mean_cells_met};
use super::grid::word;
use super::grid_build::{GridBudget, STEP_COST};
use crate::parallel::{map_parts, ranges};

/// A list this long or longer may be worth a grid.
const CROWDED: u32 = 8;

/// The finest grid inside a cell: 2⁵ cells along an axis.
const MAX_LEVEL: u8 = 5;

/// The most inner cells, and inner list elements, for each element of the list that they replace.
const MOST_GROWTH: usize = 64;

/// A grid is worth its memory if it costs a ray less than this part of what the list costs.
const GAIN: f32 = 0.9;

/// Two levels are worth it if they save this part of the cost of all cells: a kernel that knows of two is
/// slower in all of them, by a tenth.
const WORTH_IT: f32 = 0.1;

/// A grid that a cell would be better with.
#[derive(Clone, Copy)]
struct Wish {
    cell: u32,
    /// Elements of the list that it replaces.
    len: u32,
    level: u8,
    /// Expected elements of the lists inside.
    met: f32,
    /// What a ray through the cell saves.
    saved: f32,
}

/// The crowded cells that the budget is enough for.
pub(super) struct DenseCells {
    /// Of every cell, the level of the grid inside; 0 for none.
    levels: Vec<u8>,
}

impl DenseCells {
    /// Of the lists, by the spheres' places; the longest come first.
    pub(super) fn of(
        cells: &Cells,
        spheres: &[[f32; 4]],
        margin: f32,
        (shape_indices, starts): (&[u32], &[u32]),
        budget: GridBudget,
    ) -> Self {
        let wishes = map_parts(ranges(cells.len(), 1 << 12), |range| {
            let lists = range.map(|cell| (cell, starts[cell], starts[cell + 1]));
            lists
                .filter(|(_, start, end)| end - start >= CROWDED)
                .filter_map(|(cell, start, end)| {
                    let list = &shape_indices[start as usize..end as usize];
                    let best = best_level(cells.size, list, spheres, margin)?;
                    Some(Wish { cell: cell as u32, len: end - start, ..best })
                })
                .collect::<Vec<_>>()
        });
        let mut wishes: Vec<Wish> = wishes.into_iter().flatten().collect();
        let mut levels = vec![0; cells.len()];
        let saved: f32 = wishes.iter().map(|wish| wish.saved).sum();
        let all = cells.len() as f32 * STEP_COST + shape_indices.len() as f32;
        if saved < WORTH_IT * all {
            return Self { levels };
        }
        wishes.sort_unstable_by_key(|wish| (std::cmp::Reverse(wish.len), wish.cell));
        let mut cells_left = budget.cells.saturating_sub(word::in_whole_units(cells.len()));
        let mut listed_left = budget.listed.saturating_sub(shape_indices.len());
        for Wish { cell, len, level, met, .. } in wishes {
            let needed = (1_usize << (3 * level), most_listed(met).saturating_sub(len as usize));
            if needed.0 <= cells_left && needed.1 <= listed_left {
                cells_left -= needed.0;
                listed_left -= needed.1;
                levels[cell as usize] = level;
            }
        }
        Self { levels }
    }

    /// The level of the grid inside a cell, if it has one.
    pub(super) fn level(&self, cell: usize) -> Option<u8> {
        Some(self.levels[cell]).filter(|level| *level > 0)
    }
}

/// What lists inside may have, where so many elements are expected if spheres lie evenly in the cell.
fn most_listed(met: f32) -> usize {
    (met * 2.0) as usize + 64
}

/// The lists of the grid inside a cell: places, by ascending id as in the list that they are made from.
/// `None` if they are longer than they were expected to be.
pub(super) fn inner_lists(
    cells: &Cells,
    cell: usize,
    list: &[u32],
    spheres: &[[f32; 4]],
    margin: f32,
    level: u8,
) -> Option<Vec<Vec<u32>>> {
    let side = 1_u32 << level;
    let inner =
        Cells { min: corner(cells, cell), size: cells.size / side as f32, counts: [side; 3] };
    let most = most_listed(met(cells.size, inner.size, list, spheres));
    let mut lists = vec![Vec::new(); inner.len()];
    let mut listed = 0;
    for &shape_index in list {
        inner.met_by_clipped(&spheres[shape_index as usize], margin, |cell| {
            lists[cell].push(shape_index);
            listed += 1;
        });
    }
    (listed <= most).then_some(lists)
}

/// The level at which a ray costs least, if there is one that is cheaper than the list; of no cell yet.
fn best_level(size: f32, list: &[u32], spheres: &[[f32; 4]], margin: f32) -> Option<Wish> {
    let list_cost = STEP_COST + list.len() as f32;
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
        let met = met(size, inner, list, spheres);
        if met > most {
            break;
        }
        let cost = side * (STEP_COST + met / (side * side * side));
        if cost < least {
            least = cost;
            best = Some(Wish { cell: 0, len: 0, level, met, saved: list_cost - cost });
        }
        // The cost has one minimum.
        if cost > coarser {
            break;
        }
        coarser = cost;
    }
    best
}

/// Expected elements of the lists inside a cell of edge `size`: of the inner cells that a sphere meets, the
/// part that lies in this cell.
fn met(size: f32, inner: f32, list: &[u32], spheres: &[[f32; 4]]) -> f32 {
    let of = |shape_index: &u32| {
        let radius = spheres[*shape_index as usize][3];
        mean_cells_met(inner, radius) / mean_cells_met(size, radius)
    };
    list.iter().map(of).sum()
}

fn corner(cells: &Cells, cell: usize) -> Vec3 {
    let [width, height, _] = cells.counts.map(|count| count as usize);
    let coordinates = [cell % width, cell / width % height, cell / (width * height)];
    cells.min + cells.size * Vec3::from(coordinates.map(|i| i as f32))
}
