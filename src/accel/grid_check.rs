//! The checks that a grid is valid: that kernels that walk it neither read out of range nor miss a sphere.
//!
//! The geometry is computed in f64 and by other methods than in the builder, so that both do not share a mistake.

use std::ops::RangeInclusive;

use super::ball::BALLS_PER_VECTOR;
use super::grid::{Grid, LAST, MAX_CELLS, elements, word};
use super::grid_geometry::{Cell, Level};

/// The valid levels of a grid inside a cell: 2 to 32 cells along an axis.
const LEVELS: RangeInclusive<u32> = 1..=5;

/// Rounding in the builder's f32 may leave out a sphere that is nearer than `margin`, and list one that is farther
/// away. The arithmetic of a ray needs less than 0.8 of a margin (`slab.rs`, `ball.rs`), so a sphere within that of a cell
/// must be listed; a sphere farther away than two margins must not be listed.
const MUST_LIST: f64 = 0.8;
const MAY_LIST: f64 = 2.0;

/// Why a grid is not valid for kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// The size of the cells, their number, or the number of words or balls is not valid.
    #[error(
        "the first level is not a valid box of cells: its cell size, cell counts or number of words or balls is wrong"
    )]
    Shape,
    /// A word has a kind that is not allowed at its index.
    #[error("word {cell} has a kind that is not valid at this index")]
    Kind {
        /// Index into [`Grid::cells`].
        cell: u32,
    },
    /// A grid inside a cell is too coarse or too fine.
    #[error("the grid inside cell {cell} has the level {level}; it must be from 1 to 5")]
    Level {
        /// Index into [`Grid::cells`].
        cell: u32,
        /// The base-2 logarithm of its number of cells along an axis.
        level: u32,
    },
    /// The words of a grid inside a cell are out of range, or belong to another grid as well.
    #[error("the grid inside cell {cell} is out of range, or overlaps another one")]
    Link {
        /// Index into [`Grid::cells`].
        cell: u32,
    },
    /// A list starts or ends out of range, has an element that is out of range, or overlaps another list.
    #[error("the list of cell {cell} is out of range, has no end, or overlaps another list")]
    List {
        /// Index into [`Grid::cells`].
        cell: u32,
    },
    /// The ids of a list are not in ascending order.
    #[error("the ids in the list of cell {cell} are not in ascending order")]
    Order {
        /// Index into [`Grid::cells`].
        cell: u32,
    },
    /// The id at an index of the structure is not that of an input sphere, is that of another sphere, or is missing.
    #[error(
        "the sphere at index {shape_index} of the structure is not the one with its id, or has no id"
    )]
    Sphere {
        /// Index of the sphere in the order of the structure.
        shape_index: u32,
    },
    /// A sphere, inflated by the margin, extends beyond the cells.
    #[error("sphere {id} extends beyond the cells")]
    Outside {
        /// Index in input order.
        id: u32,
    },
    /// A list lacks a sphere whose surface is near the cell.
    #[error("the list of cell {cell} lacks the sphere {id}, which is near the cell")]
    Missing {
        /// Index into [`Grid::cells`].
        cell: u32,
        /// Index in input order.
        id: u32,
    },
    /// A list has a sphere whose surface is not near the cell.
    #[error("the list of cell {cell} has the sphere {id}, which is not near the cell")]
    Far {
        /// Index into [`Grid::cells`].
        cell: u32,
        /// Index in input order.
        id: u32,
    },
    /// A ball does not contain its sphere, nor its cell.
    #[error(
        "the ball of sphere {id} in the list of cell {cell} contains neither the sphere nor the cell"
    )]
    Ball {
        /// Index into [`Grid::cells`].
        cell: u32,
        /// Index in input order.
        id: u32,
    },
    /// An empty cell states that cells ahead of it are empty, but some of them are not.
    #[error("not all cells ahead of cell {cell} are empty that it states to be empty")]
    Reach {
        /// Index into [`Grid::cells`].
        cell: u32,
    },
}

impl Grid {
    /// Checks that the grid is valid for kernels: every index is in range, every list has an end and ascending ids, and
    /// every sphere is listed in exactly the cells that need it, with a ball that contains it.
    ///
    /// `spheres` and `ids` are in the order that the grid refers to. `input` are all spheres from which the grid was
    /// built, and `margin` is the distance from a surface within which cells must list it. If several spheres are
    /// equal, a list may lack all but the one with the smallest id.
    ///
    /// # Errors
    /// Returns an error if the grid is not valid; the error describes the first problem.
    pub fn validate(
        &self,
        spheres: &[[f32; 4]],
        ids: &[u32],
        input: &[[f32; 4]],
        margin: f32,
    ) -> Result<(), GridError> {
        self.check_shape()?;
        self.check_shapes(spheres, ids, input)?;
        let check = Check { grid: self, ids, input, margin: f64::from(margin) };
        let lists = check.lists()?;
        check.check_reach()?;
        for id in 0..input.len() as u32 {
            check.check_listed(&lists, id)?;
        }
        check.check_near(&lists)
    }

    fn check_shape(&self) -> Result<(), GridError> {
        let is_length = self.cell_size.is_finite() && self.cell_size > 0.0;
        let count = self.cell_counts.iter().try_fold(1, |all: u32, count| all.checked_mul(*count));
        let is_box = count.is_some_and(|count| (1..=MAX_CELLS as u32).contains(&count));
        let has_all_balls = self.balls.len() == self.references.len();
        if !is_length || !self.min.is_finite() || !is_box || !has_all_balls {
            return Err(GridError::Shape);
        }
        let padded = word::in_whole_units(self.first_level_len());
        if self.cells.len() < padded || word::in_whole_units(self.cells.len()) != self.cells.len() {
            return Err(GridError::Shape);
        }
        // Because of rounding, a walk may read one cell too far, so the padding must be empty.
        match (self.first_level_len()..padded).find(|cell| self.cells[*cell] != word::EMPTY) {
            Some(cell) => Err(GridError::Kind { cell: cell as u32 }),
            None => Ok(()),
        }
    }

    /// Checks that each index has the sphere of its id, and that each id has exactly one index.
    fn check_shapes(
        &self,
        spheres: &[[f32; 4]],
        ids: &[u32],
        input: &[[f32; 4]],
    ) -> Result<(), GridError> {
        let wrong = |shape_index: usize| Err(GridError::Sphere { shape_index: shape_index as u32 });
        if spheres.len() != ids.len() {
            return wrong(spheres.len().min(ids.len()));
        }
        let mut seen = vec![false; input.len()];
        for (shape_index, (sphere, id)) in spheres.iter().zip(ids).enumerate() {
            let Some(original) = input.get(*id as usize) else { return wrong(shape_index) };
            let is_taken = std::mem::replace(&mut seen[*id as usize], true);
            if is_taken || sphere.map(f32::to_bits) != original.map(f32::to_bits) {
                return wrong(shape_index);
            }
        }
        if ids.len() != input.len() {
            return wrong(ids.len());
        }
        Ok(())
    }
}

/// The range of a cell's list in the references; empty without a list.
type Range = std::ops::Range<usize>;

struct Check<'a> {
    grid: &'a Grid,
    ids: &'a [u32],
    input: &'a [[f32; 4]],
    margin: f64,
}

impl Check<'_> {
    /// The list of every word, after a check that all references are valid.
    fn lists(&self) -> Result<Vec<Range>, GridError> {
        let words = &self.grid.cells;
        let first_level_len = self.grid.first_level_len();
        let padded = word::in_whole_units(first_level_len);
        // Each word after the first level, and each element of a list, must belong to exactly one cell.
        let mut is_inner = vec![false; words.len()];
        let mut is_listed = vec![false; self.grid.references.len()];
        for (cell, value) in words.iter().enumerate().take(first_level_len) {
            if value & word::KIND == word::GRID {
                self.take_inner(cell, padded, &mut is_inner)?;
            }
        }
        let mut lists = vec![0..0; words.len()];
        for (index, value) in words.iter().enumerate() {
            let cell = index as u32;
            let is_first = index < first_level_len;
            match value & word::KIND {
                // After the first level, empty words say nothing about the cells around them.
                word::EMPTY if is_first || *value == word::EMPTY => {}
                word::LIST if is_first || is_inner[index] => {
                    let list = self.list(cell, (value & !word::KIND) as usize)?;
                    for at in list.clone() {
                        if std::mem::replace(&mut is_listed[at], true) {
                            return Err(GridError::List { cell });
                        }
                    }
                    lists[index] = list;
                }
                word::GRID if is_first => {}
                _ => return Err(GridError::Kind { cell }),
            }
        }
        Ok(lists)
    }

    fn take_inner(
        &self,
        cell: usize,
        padded: usize,
        is_inner: &mut [bool],
    ) -> Result<(), GridError> {
        let value = self.grid.cells[cell];
        let level = word::level(value);
        let cell = cell as u32;
        if !LEVELS.contains(&level) {
            return Err(GridError::Level { cell, level });
        }
        let first = word::first_inner(value);
        let link = GridError::Link { cell };
        let own = is_inner.get_mut(first..first + (1 << (3 * level))).ok_or(link)?;
        if first < padded || own.contains(&true) {
            return Err(link);
        }
        own.fill(true);
        Ok(())
    }

    /// Follows a list to its end, and checks that its elements are in range and their ids ascend. Its last element may
    /// be repeated to fill up the list of a layout with balls.
    fn list(&self, cell: u32, start: usize) -> Result<Range, GridError> {
        let out = GridError::List { cell };
        let references = &self.grid.references;
        let is_last = |at: &usize| references[*at] & LAST != 0;
        let end = (start..references.len()).find(is_last).ok_or(out)? + 1;
        let list = start..end;
        if list.clone().any(|at| self.shape_index(at) >= self.ids.len()) {
            return Err(out);
        }
        let mut len = list.len();
        let ends = list.clone().filter(|at| self.grid.balls[*at] & LAST != 0);
        if !start.is_multiple_of(BALLS_PER_VECTOR) || !ends.eq([end - 1]) {
            return Err(out);
        }
        let repeats = |at: &usize| self.id(*at) == self.id(end - 1);
        len -= (start..end - 1).rev().take_while(repeats).count();
        if elements(len) != list.len() {
            return Err(out);
        }
        if (start..start + len).map(|at| self.id(at)).is_sorted_by(|a, b| a < b) {
            Ok(list)
        } else {
            Err(GridError::Order { cell })
        }
    }

    /// The index of the sphere that an element of a list refers to.
    fn shape_index(&self, at: usize) -> usize {
        (self.grid.references[at] & !LAST) as usize
    }

    fn id(&self, at: usize) -> u32 {
        self.ids[self.shape_index(at)]
    }

    /// Checks what empty cells state about the cells ahead, with a summed-volume table: the number of occupied cells
    /// between the first cell and each cell.
    fn check_reach(&self) -> Result<(), GridError> {
        let [width, height, depth] = self.grid.cell_counts.map(|count| count as usize);
        let sum_index = |x: usize, y: usize, z: usize| (z * (height + 1) + y) * (width + 1) + x;
        let index = |x: usize, y: usize, z: usize| (z * height + y) * width + x;
        let mut sums = vec![0_i64; (width + 1) * (height + 1) * (depth + 1)];
        let all = || {
            (0..depth).flat_map(move |z| {
                (0..height).flat_map(move |y| (0..width).map(move |x| (x, y, z)))
            })
        };
        for (x, y, z) in all() {
            let is_full = self.grid.cells[index(x, y, z)] & word::KIND != word::EMPTY;
            let at = |i: usize, j: usize, k: usize| sums[sum_index(x + i, y + j, z + k)];
            let sum = i64::from(is_full) + at(0, 1, 1) + at(1, 0, 1) + at(1, 1, 0)
                - at(0, 0, 1)
                - at(0, 1, 0)
                - at(1, 0, 0)
                + at(0, 0, 0);
            sums[sum_index(x + 1, y + 1, z + 1)] = sum;
        }
        for (x, y, z) in all() {
            let cell = index(x, y, z);
            let value = self.grid.cells[cell];
            if value & word::KIND != word::EMPTY {
                continue;
            }
            for octant in 0..8 {
                let reach = (value >> (3 * octant) & 7) as usize;
                let descends = |axis: usize| octant >> axis & 1 == 1;
                let coordinates = [x, y, z];
                let low = [0, 1, 2].map(|axis| {
                    if descends(axis) {
                        coordinates[axis].saturating_sub(reach)
                    } else {
                        coordinates[axis]
                    }
                });
                let high = [(0, width), (1, height), (2, depth)].map(|(axis, count)| {
                    let last =
                        if descends(axis) { coordinates[axis] } else { coordinates[axis] + reach };
                    (last + 1).min(count)
                });
                let corner = |i: usize| {
                    let [a, b, c] = [0, 1, 2]
                        .map(|axis| if i >> axis & 1 == 1 { high[axis] } else { low[axis] });
                    let sign = if i.count_ones().is_multiple_of(2) { -1 } else { 1 };
                    sign * sums[sum_index(a, b, c)]
                };
                if value >> 24 != 0 || (0..8).map(corner).sum::<i64>() != 0 {
                    return Err(GridError::Reach { cell: cell as u32 });
                }
            }
        }
        Ok(())
    }

    /// Checks that every cell near the surface of a sphere lists it, or an equal sphere with a smaller id.
    fn check_listed(&self, lists: &[Range], id: u32) -> Result<(), GridError> {
        let sphere = self.input[id as usize];
        let whole = Level::of(self.grid);
        let reach = f64::from(sphere[3]) + MUST_LIST * self.margin;
        for (axis, x) in sphere.into_iter().take(3).enumerate() {
            let center = f64::from(x) - whole.low[axis];
            let side = whole.size * whole.counts[axis] as f64;
            if center - reach < 0.0 || center + reach > side {
                return Err(GridError::Outside { id });
            }
        }
        self.check_level(lists, id, sphere, &whole)
    }

    fn check_level(
        &self,
        lists: &[Range],
        id: u32,
        sphere: [f32; 4],
        level: &Level,
    ) -> Result<(), GridError> {
        let reach = f64::from(sphere[3]) + self.margin;
        for cell in level.cells_around(sphere, reach) {
            if !cell.is_near(sphere, MUST_LIST * self.margin) {
                continue;
            }
            let value = self.grid.cells[cell.index];
            if value & word::KIND == word::GRID {
                self.check_level(lists, id, sphere, &Level::inside(&cell, value))?;
            } else if !self.lists_it(&lists[cell.index], id, sphere) {
                return Err(GridError::Missing { cell: cell.index as u32, id });
            }
        }
        Ok(())
    }

    fn lists_it(&self, list: &Range, id: u32, sphere: [f32; 4]) -> bool {
        // Binary search, because ids ascend.
        let (mut low, mut high) = (list.start, list.end);
        while low < high {
            let middle = low + (high - low) / 2;
            if self.id(middle) < id { low = middle + 1 } else { high = middle }
        }
        let is_same = |at: usize| {
            self.input[self.id(at) as usize].map(f32::to_bits) == sphere.map(f32::to_bits)
        };
        (low < list.end && self.id(low) == id) || (list.start..low).any(is_same)
    }

    /// Checks that no cell lists a sphere that is not near it.
    fn check_near(&self, lists: &[Range]) -> Result<(), GridError> {
        for cell in Level::of(self.grid).cells() {
            let value = self.grid.cells[cell.index];
            if value & word::KIND == word::GRID {
                for inner in Level::inside(&cell, value).cells() {
                    self.check_list_near(&inner, &lists[inner.index])?;
                }
            } else {
                self.check_list_near(&cell, &lists[cell.index])?;
            }
        }
        Ok(())
    }

    fn check_list_near(&self, cell: &Cell, list: &Range) -> Result<(), GridError> {
        let word = cell.index as u32;
        for at in list.clone() {
            let id = self.id(at);
            let sphere = self.input[id as usize];
            if !cell.is_near(sphere, MAY_LIST * self.margin) {
                return Err(GridError::Far { cell: word, id });
            }
            if !cell.has_in_ball(self.grid.balls[at], sphere, MUST_LIST * self.margin) {
                return Err(GridError::Ball { cell: word, id });
            }
        }
        Ok(())
    }
}
