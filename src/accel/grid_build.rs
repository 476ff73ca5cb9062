//! Building grids by counting sort, in time proportional to the number of spheres and cells: the choice of cells, their
//! words and lists, and the number of empty cells ahead of each empty cell, which a ray can cross in one step.

use glam::Vec3;

use super::ball::BallFrame;
use super::cells::Cells;
use super::grid::{Grid, GridBudget, LAST, MAX_CELLS, MAX_FIRST_LEVEL, word};
use super::grid_dense::{DenseCells, corner, inner_cells, inner_lists};
use super::grid_sort::{CHUNK, Lists, Overlaps, sort_by_cell};
use super::listed::{Listed, elements};
use crate::parallel::{for_each, map, map_parts, ranges, split_mut};

/// The largest number of shapes that are examined to choose the cell size.
const SAMPLED: usize = 4096;

/// A grid, its spheres in the order that its references use, and their ids.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BuiltGrid {
    /// The cells.
    pub grid: Grid,
    /// Centre and radius of each sphere.
    pub spheres: Vec<[f32; 4]>,
    /// Index of each sphere in input order.
    pub ids: Vec<u32>,
}

/// Builds a grid of the spheres with the given ids, which must ascend.
///
/// The grid has at least eight cells, even beyond the budget. A sphere is listed in every cell that lies within
/// `margin` of its surface.
#[must_use]
pub(crate) fn build_grid(spheres: &[[f32; 4]], ids: &[u32], margin: f32, budget: GridBudget) -> BuiltGrid {
    let (own, (min, max)) = gather(spheres, ids, margin);
    let mut cells = first_level(&own, (min, max), budget);
    let (sorted, sorted_ids) = sort_by_cell(own, ids, &cells);
    let mut overlaps = Overlaps::new(&sorted, &cells, margin);
    // The size was chosen for spheres at random positions. Spheres that are aligned with the cells may overlap more
    // cells.
    while overlaps.total() > budget.listed as u64 && cells.len() > 1 {
        cells = coarser(&cells, max);
        overlaps = Overlaps::new(&sorted, &cells, margin);
    }
    let lists = overlaps.fill(&sorted_ids);
    let grid = assemble(&cells, margin, budget, &sorted, &lists);
    BuiltGrid { grid, spheres: sorted, ids: sorted_ids }
}

/// Gathers the spheres with the given ids. Returns them with their bounding box, inflated by the margin.
fn gather(spheres: &[[f32; 4]], ids: &[u32], margin: f32) -> (Vec<[f32; 4]>, (Vec3, Vec3)) {
    let mut own = vec![[0.0; 4]; ids.len()];
    let chunks: Vec<_> = own.chunks_mut(CHUNK).zip(ids.chunks(CHUNK)).collect();
    let parts = map_parts(chunks, |(own, ids): (&mut [[f32; 4]], &[u32])| {
        own.iter_mut().zip(ids).fold((Vec3::MAX, Vec3::MIN), |(min, max), (own, id)| {
            *own = spheres[*id as usize];
            let [x, y, z, r] = *own;
            let center = Vec3::new(x, y, z);
            (min.min(center - r), max.max(center + r))
        })
    });
    if parts.is_empty() {
        return (own, (Vec3::ZERO, Vec3::ONE));
    }
    let (min, max) =
        parts.into_iter().fold((Vec3::MAX, Vec3::MIN), |(min, max), part| (min.min(part.0), max.max(part.1)));
    (own, (min - margin, max + margin))
}

/// Chooses the first level of cells for the given shapes.
pub(super) fn first_level<T: Listed>(shapes: &[T], (min, max): (Vec3, Vec3), budget: GridBudget) -> Cells {
    let mut cells = cells_of_size(min, max, first_level_size(shapes, max - min, budget));
    // The size was chosen by volume, but a flat box has more cells than its volume suggests.
    while cells.len() > 1 && word::in_whole_units(cells.len()) > budget.cells.min(MAX_CELLS) {
        cells = coarser(&cells, max);
    }
    cells
}

/// Chooses the cell size with the smallest expected cost of a ray, from a sample of the shapes. A ray of length L takes
/// about L/size steps, each with the elements of one cell's list.
fn first_level_size<T: Listed>(shapes: &[T], extent: Vec3, budget: GridBudget) -> f32 {
    let stride = shapes.len().div_ceil(SAMPLED).max(1);
    let sample: Vec<T> = shapes.iter().step_by(stride).copied().collect();
    let longest = extent.max_element();
    // Prevents a volume of zero for flat scenes.
    let sides = extent.max(Vec3::splat(longest * 1e-3));
    let volume = f64::from(sides.x) * f64::from(sides.y) * f64::from(sides.z);
    let most_cells = budget.cells.min(MAX_FIRST_LEVEL) as f64;
    let mut best: Option<(f64, f32)> = None;
    // From one cell to 1024 along the longest side, in steps of an eighth of an octave.
    for step in 0..=80_u8 {
        let size = longest / (f32::from(step) / 8.0).exp2();
        let overlaps: f32 = sample.iter().map(|shape| shape.mean_overlapped_cells(size)).sum();
        let overlaps = f64::from(overlaps) / sample.len() as f64 * shapes.len() as f64;
        let cells = volume / f64::from(size).powi(3);
        let listed = expected_elements(overlaps, cells);
        let fits = listed <= budget.listed as f64 * 0.97 && cells <= most_cells * 0.9;
        let cost = (f64::from(T::STEP_COST) + listed / cells.max(1.0)) / f64::from(size);
        if (fits || step == 0) && best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, size));
        }
    }
    best.map_or(longest, |(_, size)| size)
}

/// The expected number of list elements in `cells` cells that spheres overlap `overlaps` times in all.
fn expected_elements(overlaps: f64, cells: f64) -> f64 {
    // Padding adds one and a half elements to each list on average.
    overlaps + 1.5 * cells.min(overlaps)
}

fn cells_of_size(min: Vec3, max: Vec3, size: f32) -> Cells {
    let counts = ((max - min) / size).to_array().map(|count| (count.ceil() as u32).max(1));
    Cells { min, size, counts }
}

pub(super) fn coarser(cells: &Cells, max: Vec3) -> Cells {
    cells_of_size(cells.min, max, cells.size * 1.1)
}

/// A range of cells under construction. Start indices in its words are relative to its own lists and words.
#[derive(Default)]
struct BuiltCells {
    /// Words of the first level.
    words: Vec<u32>,
    /// Words of the grids inside cells.
    inner: Vec<u32>,
    lists: BuiltLists,
}

/// Makes a grid from the lists of its first level.
pub(super) fn assemble<T: Listed>(cells: &Cells, margin: f32, budget: GridBudget, sorted: &[T], lists: &Lists) -> Grid {
    let mut grid = without_surroundings(cells, margin, budget, sorted, lists);
    mark_empty_surroundings(&mut grid.cells, cells.counts);
    grid
}

fn without_surroundings<T: Listed>(
    cells: &Cells,
    margin: f32,
    budget: GridBudget,
    sorted: &[T],
    lists: &Lists,
) -> Grid {
    let dense = DenseCells::of(cells, sorted, margin, (&lists.shape_indices, &lists.starts), budget);
    let is_long = |list: &[u32]| (list[1] - list[0]) as usize > LONG;
    if dense.is_none() && !lists.starts.windows(2).any(is_long) {
        return flat(cells, lists, sorted, margin);
    }
    let frame = |cells: &Cells, cell: usize| BallFrame::new(corner(cells, cell), cells.size, margin);
    let parts = map_parts(ranges(cells.len(), CHUNK), |range| {
        let listed = (lists.starts[range.end] - lists.starts[range.start]) as usize;
        let mut part = BuiltCells {
            words: Vec::with_capacity(range.len()),
            inner: Vec::new(),
            lists: BuiltLists::with_capacity::<T>(listed),
        };
        let mut list = Vec::new();
        for cell in range {
            list.clear();
            let (start, end) = (lists.starts[cell] as usize, lists.starts[cell + 1] as usize);
            list.extend_from_slice(&lists.shape_indices[start..end]);
            keep_one_of_the_same(&mut list, sorted);
            let inner = dense
                .level(cell)
                .and_then(|level| Some((level, inner_lists(cells, cell, &list, sorted, margin, level)?)));
            let word = match inner {
                Some((level, inner)) => {
                    let start = word::units(part.inner.len());
                    let inside = inner_cells(cells, cell, level);
                    for (cell, list) in inner.iter().enumerate() {
                        part.inner.push(part.lists.append(list, sorted, frame(&inside, cell)));
                    }
                    word::GRID | u32::from(level) << word::LEVEL_SHIFT | start
                }
                None => part.lists.append(&list, sorted, frame(cells, cell)),
            };
            part.words.push(word);
        }
        part
    });
    joined(cells, &parts)
}

/// Makes a grid from its words and lists.
fn grid(cells: &Cells, words: Vec<u32>, references: Vec<u32>, balls: Vec<u32>) -> Grid {
    let Cells { min, size: cell_size, counts: cell_counts } = *cells;
    Grid { min, cell_size, cell_counts, cells: words, references, balls }
}

/// Lists longer than this keep only one of several equal shapes.
const LONG: usize = 32;

/// Removes duplicates of shapes from a long list. The first, which has the smallest id, stays.
fn keep_one_of_the_same<T: Listed>(list: &mut Vec<u32>, sorted: &[T]) {
    if list.len() > LONG {
        let mut seen = std::collections::HashSet::with_capacity(list.len());
        list.retain(|shape_index| seen.insert(bytemuck::bytes_of(&sorted[*shape_index as usize])));
    }
}

/// Joins the words and the lists of all parts.
fn joined(cells: &Cells, parts: &[BuiltCells]) -> Grid {
    let first_level_len = word::in_whole_units(cells.len());
    let listed = parts.iter().map(|part| part.lists.references.len()).sum();
    let guards = parts.iter().map(|part| part.lists.balls.len()).sum();
    let inner_len: usize = parts.iter().map(|part| part.inner.len()).sum();
    let mut all_words = vec![word::EMPTY; first_level_len + inner_len];
    let (mut all_references, mut all_balls) = (vec![0; listed], vec![0; guards]);
    let (mut words, mut inner) = all_words.split_at_mut(first_level_len);
    let (mut references, mut balls) = (&mut all_references[..], &mut all_balls[..]);
    let (mut list_start, mut inner_start) = (0, word::units(first_level_len));
    let mut tasks = Vec::with_capacity(parts.len());
    for part in parts {
        let target = (
            cut(&mut words, part.words.len()),
            cut(&mut inner, part.inner.len()),
            cut(&mut references, part.lists.references.len()),
            cut(&mut balls, part.lists.balls.len()),
        );
        tasks.push((part, target, list_start, inner_start));
        list_start += part.lists.references.len() as u32;
        inner_start += word::units(part.inner.len());
    }
    for_each(tasks, |(part, (words, inner, references, balls), list_start, inner_start)| {
        let moved = |cell: &u32| match cell & word::KIND {
            word::LIST => cell + list_start,
            word::GRID => cell + inner_start,
            _ => *cell,
        };
        for (target, cell) in words.iter_mut().zip(&part.words) {
            *target = moved(cell);
        }
        for (target, cell) in inner.iter_mut().zip(&part.inner) {
            *target = moved(cell);
        }
        references.copy_from_slice(&part.lists.references);
        balls.copy_from_slice(&part.lists.balls);
    });
    grid(cells, all_words, all_references, all_balls)
}

/// Takes the first `len` elements off a slice.
fn cut<'a, T>(slice: &mut &'a mut [T], len: usize) -> &'a mut [T] {
    let (first, rest) = std::mem::take(slice).split_at_mut(len);
    *slice = rest;
    first
}

/// References, list after list, and a ball for each.
#[derive(Default)]
struct BuiltLists {
    references: Vec<u32>,
    balls: Vec<u32>,
}

impl BuiltLists {
    fn with_capacity<T: Listed>(listed: usize) -> Self {
        Self { references: Vec::with_capacity(listed), balls: Vec::with_capacity(guard_words::<T>(listed)) }
    }

    /// Appends the list of a cell with the given frame, and returns the cell's word.
    fn append<T: Listed>(&mut self, list: &[u32], shapes: &[T], frame: BallFrame) -> u32 {
        if list.is_empty() {
            return word::EMPTY;
        }
        let start = self.references.len();
        self.references.resize(start + elements::<T>(list.len()), 0);
        self.balls.resize(guard_words::<T>(self.references.len()), 0);
        let balls = &mut self.balls[guard_words::<T>(start)..];
        write_list(list, shapes, frame, &mut self.references[start..], balls);
        word::LIST | start as u32
    }
}

/// The number of words of the guards of a list.
const fn guard_words<T: Listed>(elements: usize) -> usize {
    elements * size_of::<T::Guard>() / size_of::<u32>()
}

/// Writes a list that is not empty, with its guards, and pads it with its last element.
fn write_list<T: Listed>(list: &[u32], shapes: &[T], frame: BallFrame, references: &mut [u32], balls: &mut [u32]) {
    references[..list.len()].copy_from_slice(list);
    references[list.len()..].fill(list[list.len() - 1]);
    let guards: &mut [T::Guard] = bytemuck::cast_slice_mut(balls);
    for (guard, shape_index) in guards.iter_mut().zip(list) {
        *guard = shapes[*shape_index as usize].guard(&frame);
    }
    let last = guards[list.len() - 1];
    guards[list.len()..].fill(last);
    for words in [references, balls] {
        if let Some(end) = words.last_mut() {
            *end |= LAST;
        }
    }
}

/// Makes a grid with one level. Each list is copied only once, straight to its place.
fn flat<T: Listed>(cells: &Cells, lists: &Lists, shapes: &[T], margin: f32) -> Grid {
    let Lists { shape_indices, starts } = lists;
    let elements = |cell: usize| elements::<T>((starts[cell + 1] - starts[cell]) as usize);
    let chunks = ranges(cells.len(), CHUNK);
    let counts = map_parts(chunks.clone(), |cells| cells.map(elements).sum::<usize>());
    let mut end = 0;
    let ends: Vec<usize> = counts
        .into_iter()
        .map(|count| {
            end += count;
            end
        })
        .collect();
    let (mut references, mut balls) = (vec![0; end], vec![0; guard_words::<T>(end)]);
    let mut words = vec![word::EMPTY; word::in_whole_units(cells.len())];
    let mut tasks = Vec::with_capacity(chunks.len());
    let targets = split_mut(&mut references, ends.iter().copied());
    let targets = targets.into_iter().zip(split_mut(&mut balls, ends.iter().map(|end| guard_words::<T>(*end))));
    let mut start = 0;
    for ((chunk, target), words) in chunks.into_iter().zip(targets).zip(words.chunks_mut(CHUNK)) {
        tasks.push((chunk, start, target, words));
        start += tasks.last().map_or(0, |task| task.2.0.len());
    }
    for_each(tasks, |(chunk, start, (references, balls), words)| {
        let mut at = 0;
        for (cell, word) in chunk.zip(words) {
            let list = &shape_indices[starts[cell] as usize..starts[cell + 1] as usize];
            if list.is_empty() {
                continue;
            }
            *word = word::LIST | (start + at) as u32;
            let place = at..at + elements(cell);
            at = place.end;
            let frame = BallFrame::new(corner(cells, cell), cells.size, margin);
            let balls = &mut balls[guard_words::<T>(place.start)..guard_words::<T>(place.end)];
            write_list(list, shapes, frame, &mut references[place], balls);
        }
    });
    grid(cells, words, references, balls)
}

/// The largest number of cells beyond the first that a step can cross.
const MAX_AHEAD: u8 = word::REACH as u8;

/// The fraction of empty cells below which skipping is not worthwhile.
const WORTH_IT: f32 = 0.25;

/// Writes into every empty word of the first level, for each of the eight octants of ray directions, how many cells
/// ahead along all three axes are empty as well, in three bits each.
///
/// Uses dynamic programming, as for the largest square of ones in a matrix. The empty cube that starts at a cell is one
/// larger than the smallest of those at its seven neighbours ahead. Everything outside the grid is empty.
fn mark_empty_surroundings(words: &mut [u32], counts: [u32; 3]) {
    let counts = counts.map(|count| count as usize);
    let len = counts.iter().product();
    let is_empty: Vec<bool> = words[..len].iter().map(|word| word & word::KIND == word::EMPTY).collect();
    let empty = is_empty.iter().filter(|is_empty| **is_empty).count();
    if (empty as f32) < WORTH_IT * len as f32 {
        return;
    }
    let octants = map(8, |octant| cubes_ahead(&is_empty, counts, octant));
    for (cell, word) in words[..len].iter_mut().enumerate() {
        if is_empty[cell] {
            let bits = |octant: usize| u32::from(octants[octant][cell]) << (word::REACH_BITS as usize * octant);
            *word = word::EMPTY | (0..8).map(bits).sum::<u32>();
        }
    }
}

/// The number of empty cells ahead of every empty cell, for one octant of ray directions. Bit i of the octant is set
/// for a ray that descends along axis i.
fn cubes_ahead(is_empty: &[bool], counts: [usize; 3], octant: usize) -> Vec<u8> {
    let [width, height, depth] = counts;
    // For each cell, the side of the empty cube that starts there.
    let mut sides = vec![0_u8; is_empty.len()];
    let in_order = |axis: usize, i: usize| {
        if octant >> axis & 1 == 1 { i } else { counts[axis] - 1 - i }
    };
    for k in 0..depth {
        for j in 0..height {
            for i in 0..width {
                let coordinates = [in_order(0, i), in_order(1, j), in_order(2, k)];
                let index = |[x, y, z]: [usize; 3]| (z * height + y) * width + x;
                if !is_empty[index(coordinates)] {
                    continue;
                }
                let mut side = MAX_AHEAD;
                for neighbour in 1..8_usize {
                    let ahead = [0, 1, 2].map(|axis| {
                        let moves = neighbour >> axis & 1 == 1;
                        match (moves, octant >> axis & 1) {
                            (false, _) => Some(coordinates[axis]),
                            (true, 1) => coordinates[axis].checked_sub(1),
                            (true, _) => Some(coordinates[axis] + 1).filter(|x| *x < counts[axis]),
                        }
                    });
                    if let [Some(x), Some(y), Some(z)] = ahead {
                        side = side.min(sides[index([x, y, z])]);
                    }
                }
                sides[index(coordinates)] = side + 1;
            }
        }
    }
    for side in &mut sides {
        *side = side.saturating_sub(1);
    }
    sides
}
