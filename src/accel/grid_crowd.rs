//! Which cells of the first level get a grid of their own, and how fine it is.

use glam::Vec3;

use super::cells::{Cells, mean_cells_met};
use super::grid_build::{GridBudget, STEP_COST};

/// A list this long or longer may be worth a grid.
const CROWDED: u32 = 24;

/// The finest grid inside a cell: 2⁵ cells along an axis.
const MAX_LEVEL: u32 = 5;

/// What a cell may become, for what it is crowded: this many times as many inner cells and list
/// elements, together, as its list has elements.
const GROWTH: usize = 12;

/// The crowded cells that the budget is enough for.
pub(super) struct Crowd<'a> {
    starts: &'a [u32],
    /// Lists shorter than this stay as they are.
    shortest: u32,
}

impl<'a> Crowd<'a> {
    /// The longest lists come first.
    pub(super) fn of(starts: &'a [u32], budget: GridBudget, first_level_len: usize) -> Self {
        let listed = starts.last().map_or(0, |end| *end as usize);
        let left = budget.listed.saturating_sub(listed);
        let left = left.min(budget.cells.saturating_sub(first_level_len));
        let mut crowded: Vec<u32> =
            starts.windows(2).map(|pair| pair[1] - pair[0]).filter(|len| *len >= CROWDED).collect();
        // A kernel that knows of two levels is slower in all cells, by a tenth.
        if (crowded.iter().sum::<u32>() as usize) < listed / 20 {
            return Self { starts, shortest: u32::MAX };
        }
        crowded.sort_unstable_by(|a, b| b.cmp(a));
        let mut needed = 0;
        let mut shortest = u32::MAX;
        for len in crowded {
            needed += len as usize * GROWTH;
            if needed > left {
                // Of equals, all or none.
                return Self { starts, shortest: shortest.max(len + 1) };
            }
            shortest = len;
        }
        Self { starts, shortest }
    }

    pub(super) fn allows(&self, cell: usize) -> bool {
        self.starts[cell + 1] - self.starts[cell] >= self.shortest
    }

    /// The most inner cells, and the most inner list elements, of a cell whose list is so long.
    pub(super) fn share(&self, len: usize) -> usize {
        len * GROWTH
    }
}

/// A grid inside a cell.
pub(super) struct Finer {
    /// It has 2 to this power cells along an axis.
    pub(super) level: u32,
    /// Its cells' lists: places, by ascending id as in the list that they are made from.
    pub(super) lists: Vec<Vec<u32>>,
}

/// The grid inside a cell that makes rays cheapest, if there is one that is cheaper than the list.
pub(super) fn finer_grid(
    cells: &Cells,
    cell: usize,
    list: &[u32],
    spheres: &[[f32; 4]],
    margin: f32,
    share: usize,
) -> Option<Finer> {
    let level = best_level(cells.size, list, spheres, margin, share)?;
    let side = 1_u32 << level;
    let inner =
        Cells { min: corner(cells, cell), size: cells.size / side as f32, counts: [side; 3] };
    let mut lists = vec![Vec::new(); inner.len()];
    let mut listed = 0;
    for &place in list {
        inner.met_by_clipped(&spheres[place as usize], margin, |cell| {
            lists[cell].push(place);
            listed += 1;
        });
    }
    (listed <= share).then_some(Finer { level, lists })
}

fn best_level(
    size: f32,
    list: &[u32],
    spheres: &[[f32; 4]],
    margin: f32,
    share: usize,
) -> Option<u32> {
    let radius = |place: &u32| spheres[*place as usize][3];
    let all = list.len() as f32;
    let mut best = (STEP_COST + all, None);
    for level in 1..=MAX_LEVEL {
        let side = (1_u32 << level) as f32;
        let inner = size / side;
        if inner < 16.0 * margin || side * side * side > share as f32 {
            break;
        }
        // Of the cells that a sphere meets, the part that lies in this one.
        let met: f32 = list
            .iter()
            .map(|place| {
                let r = radius(place);
                let in_all = mean_cells_met(inner, r);
                in_all / mean_cells_met(size, r)
            })
            .sum();
        if met > share as f32 {
            break;
        }
        let cost = side * (STEP_COST + met / (side * side * side));
        // A level for a small gain is not worth its memory.
        if cost < 0.9 * best.0 {
            best = (cost, Some(level));
        }
    }
    best.1
}

fn corner(cells: &Cells, cell: usize) -> Vec3 {
    let [width, height, _] = cells.counts.map(|count| count as usize);
    let place = [cell % width, cell / width % height, cell / (width * height)];
    cells.min + cells.size * Vec3::from(place.map(|i| i as f32))
}
