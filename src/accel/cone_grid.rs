//! Building grids of cones. There are fewer of them than of spheres, so this is simpler than `grid_build.rs`.

use glam::Vec3;

use super::cells::{CellVectors, Cells};
use super::grid::{Grid, GridBudget};
use super::grid_build::{assemble, coarser, first_level};
use super::grid_sort::{CHUNK, Lists};
use super::listed::{Listed, elements};
use crate::geometry::cone::ConeInFrame;
use crate::parallel::{map_parts, ranges};

/// Builds a grid of cones. Returns it with the order of its cones, as indices of the given ones.
///
/// A cone is listed in the cells that come within `margin` of its surface.
pub(super) fn build_cone_grid(cones: &[ConeInFrame], margin: f32, budget: GridBudget) -> (Grid, Vec<u32>) {
    let joined = |(min, max): (Vec3, Vec3), cone: &ConeInFrame| {
        let [low, high] = cone.corners().map(|corner| corner.as_vec3());
        (min.min(low), max.max(high))
    };
    let (min, max) = cones.iter().fold((Vec3::MAX, Vec3::MIN), joined);
    let (min, max) = (min - margin, max + margin);
    let mut cells = first_level(cones, (min, max), budget);
    let mut overlaps = overlaps(cones, &cells, margin);
    // Cones that are aligned with the cells may overlap more of them than cones at random.
    while listed(&overlaps, &cells) > budget.listed && cells.len() > 1 {
        cells = coarser(&cells, max);
        overlaps = self::overlaps(cones, &cells, margin);
    }
    let order = in_blocks(cones, &cells);
    let mut places = vec![0; order.len()];
    for (place, index) in (0..).zip(&order) {
        places[*index as usize] = place;
    }
    let sorted: Vec<ConeInFrame> = order.iter().map(|index| cones[*index as usize]).collect();
    let lists = lists(&overlaps, &places, cells.len());
    (assemble(&cells, margin, budget, &sorted, &lists), order)
}

/// The cells that cones overlap, cone by cone, and the end of each cone's.
struct Overlaps {
    cells: Vec<u32>,
    ends: Vec<usize>,
}

fn overlaps(cones: &[ConeInFrame], cells: &Cells, margin: f32) -> Vec<Overlaps> {
    map_parts(ranges(cones.len(), CHUNK), |range| {
        let mut part = Overlaps { cells: Vec::new(), ends: Vec::with_capacity(range.len()) };
        for cone in &cones[range] {
            cone.for_each_near(cells, margin, |cell| part.cells.push(cell as u32));
            part.ends.push(part.cells.len());
        }
        part
    })
}

/// The number of cones that overlap each cell.
fn counts(overlaps: &[Overlaps], cells: usize) -> Vec<u32> {
    let mut counts = vec![0; cells];
    for cell in overlaps.iter().flat_map(|part| &part.cells) {
        counts[*cell as usize] += 1;
    }
    counts
}

/// The number of elements of all lists together.
fn listed(overlaps: &[Overlaps], cells: &Cells) -> usize {
    counts(overlaps, cells.len()).iter().map(|count| elements::<ConeInFrame>(*count as usize)).sum()
}

/// The cones sorted by the cells of their middles, block by block, so that cones that are close in space are close in
/// memory.
fn in_blocks(cones: &[ConeInFrame], cells: &Cells) -> Vec<u32> {
    let vectors = CellVectors::of(cells);
    let block = |cone: &ConeInFrame| {
        let [start, end] = cone.ends();
        let [x, y, z] = (0.5 * (start + end)).as_vec3().to_array();
        vectors.index_in_blocks(&[x, y, z, 0.0])
    };
    let mut order: Vec<(usize, u32)> = cones.iter().map(block).zip(0..).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, index)| index).collect()
}

/// The lists of all cells. They hold the places of cones in the order of ids.
fn lists(overlaps: &[Overlaps], places: &[u32], cells: usize) -> Lists {
    let mut starts = counts(overlaps, cells);
    let mut end = 0;
    for count in &mut starts {
        end += *count;
        *count = end;
    }
    starts.push(end);
    let mut shape_indices = vec![0; end as usize];
    // From the last to the first, each start comes down from the end of its list.
    let mut index = places.len();
    for part in overlaps.iter().rev() {
        for (number, end) in part.ends.iter().enumerate().rev() {
            index -= 1;
            let start = if number == 0 { 0 } else { part.ends[number - 1] };
            for cell in &part.cells[start..*end] {
                let start = &mut starts[*cell as usize];
                *start -= 1;
                shape_indices[*start as usize] = places[index];
            }
        }
    }
    Lists { shape_indices, starts }
}
