//! Grid cells in f64, for checking a grid by other methods than those of the builder.

use super::grid::{Grid, word};

/// A cell of either level: the index of its word, and its box.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub(super) index: usize,
    pub(super) low: [f64; 3],
    pub(super) size: f64,
}

impl Cell {
    /// Distances from a point to the nearest and the farthest point of the cell.
    pub(super) fn distances(&self, point: [f64; 3]) -> (f64, f64) {
        let (mut near, mut far) = (0.0, 0.0);
        for (low, x) in self.low.into_iter().zip(point) {
            let nearest = x.clamp(low, low + self.size);
            near += (x - nearest).powi(2);
            far += (x - low).abs().max((x - low - self.size).abs()).powi(2);
        }
        (near.sqrt(), far.sqrt())
    }

    /// Whether the distance between the surface of a sphere and the cell is at most `margin`.
    pub(super) fn is_near(&self, [x, y, z, radius]: [f32; 4], margin: f64) -> bool {
        let radius = f64::from(radius);
        let (near, far) = self.distances([x, y, z].map(f64::from));
        near <= radius + margin && far >= radius - margin
    }
}

/// The rounding errors of a kernel's test of a ball need this much of the square of its radius, in quanta.
const BALL_SLACK: f64 = 0.5;

impl Cell {
    /// Whether a ball in this cell contains a sphere inflated by `margin`, or the cell.
    pub(super) fn has_in_ball(&self, ball: u32, [x, y, z, radius]: [f32; 4], margin: f64) -> bool {
        let quantum = self.size / 85.0;
        let center = [0, 1, 2]
            .map(|axis| self.low[axis] - self.size + f64::from(ball >> (8 * axis) & 255) * quantum);
        let code = ball >> 24 & 127;
        let square = (1.0 + f64::from(code & 7) / 8.0) * 2_f64.powi((code >> 3) as i32);
        let reach = (square - BALL_SLACK).sqrt() * quantum;
        let [x, y, z] = [x, y, z].map(f64::from);
        let [i, j, k] = center;
        let apart = ((x - i).powi(2) + (y - j).powi(2) + (z - k).powi(2)).sqrt();
        apart + f64::from(radius) + margin <= reach || self.distances(center).1 <= reach
    }
}

/// A box of cells whose words are consecutive.
pub(super) struct Level {
    pub(super) first: usize,
    pub(super) low: [f64; 3],
    pub(super) size: f64,
    pub(super) counts: [usize; 3],
}

impl Level {
    pub(super) fn of(grid: &Grid) -> Self {
        Self {
            first: 0,
            low: grid.min.to_array().map(f64::from),
            size: f64::from(grid.cell_size),
            counts: grid.cell_counts.map(|count| count as usize),
        }
    }

    /// The grid inside a cell whose word is `value`.
    pub(super) fn inside(cell: &Cell, value: u32) -> Self {
        let side = 1_usize << word::level(value);
        let size = cell.size / side as f64;
        Self { first: word::first_inner(value), low: cell.low, size, counts: [side; 3] }
    }

    pub(super) fn cells(&self) -> impl Iterator<Item = Cell> {
        self.cells_between([0; 3], self.counts)
    }

    /// The cells within `reach` of a sphere's centre, and possibly some others.
    pub(super) fn cells_around(
        &self,
        [x, y, z, _]: [f32; 4],
        reach: f64,
    ) -> impl Iterator<Item = Cell> {
        let center = [x, y, z].map(f64::from);
        let low = [0, 1, 2].map(|axis| {
            ((center[axis] - reach - self.low[axis]) / self.size - 1.0).max(0.0) as usize
        });
        let high = [0, 1, 2].map(|axis| {
            let beyond = (center[axis] + reach - self.low[axis]) / self.size + 2.0;
            (beyond.max(0.0) as usize).min(self.counts[axis])
        });
        self.cells_between(low, high)
    }

    pub(super) fn cells_between(
        &self,
        low: [usize; 3],
        high: [usize; 3],
    ) -> impl Iterator<Item = Cell> {
        let along = move |axis: usize| low[axis]..high[axis];
        let cells = along(2)
            .flat_map(move |z| along(1).flat_map(move |y| along(0).map(move |x| [x, y, z])));
        cells.map(move |[x, y, z]| Cell {
            index: self.first + (z * self.counts[1] + y) * self.counts[0] + x,
            low: [0, 1, 2].map(|axis| self.low[axis] + [x, y, z][axis] as f64 * self.size),
            size: self.size,
        })
    }
}
