//! Planning the structures of cones, and building grids of them. There are fewer of them than of spheres, so this is
//! simpler than `grid_build.rs`.

use glam::Vec3;

use super::cells::{CellVectors, Cells};
use super::grid::{Grid, GridBudget};
use super::grid_build::{assemble, coarser, first_level};
use super::grid_sort::{CHUNK, Lists};
use super::listed::{Listed, elements};
use super::plan::{AccelPlan, ConesPlan, LIST_LEN, MAX_BINDING_BYTES, PlannedBuffer, decide, node_bytes};
use super::statistics::{Crowd, SceneStatistics};
use super::structure::Structure;
use crate::geometry::cone::ConeInFrame;
use crate::parallel::{map_chunks, map_parts, ranges};

impl AccelPlan {
    /// The plan with the cones of the scene, for a device whose bindings hold up to `binding_bytes`.
    #[must_use]
    pub fn with_cones(self, cones: &[ConeInFrame], binding_bytes: u64) -> Self {
        const BYTES: usize = size_of::<ConeInFrame>();
        if cones.is_empty() {
            return self;
        }
        let (mut min, mut max) = box_of(cones);
        if self.statistics.count > 0 {
            (min, max) = (min.min(self.statistics.min), max.max(self.statistics.max));
        }
        let mut plan = self.within((min, max));
        let binding_bytes = binding_bytes.min(MAX_BINDING_BYTES);
        let fits = (binding_bytes as usize / BYTES).max(1);
        let balls: Vec<[f32; 4]> = cones.iter().map(ConeInFrame::ball).collect();
        // Middles that are close together say little: cones with one middle leave it in all directions.
        let statistics = SceneStatistics { densest: 0.0, ..SceneStatistics::of(&balls) };
        let crowd = Crowd::find(&balls, &statistics);
        let (structure, reason) = decide(&statistics, crowd.as_ref(), plan.choice, "cones and cylinders");
        if plan.statistics.count == 0 {
            plan.reason = reason;
        }
        let (structure, per_brick) = match structure {
            Structure::List => (Structure::List, fits.min(LIST_LEN)),
            Structure::Grid => (Structure::Grid, (fits / 2).max(1)),
            _ => (Structure::WideTree, fits),
        };
        let (count, largest) = (cones.len() as u64, cones.len().min(per_brick) as u64);
        let budget = cone_grid_budget(largest, binding_bytes);
        let bricks = cones.len().div_ceil(per_brick) as u64;
        let planned = |name, bytes, bytes_per_binding| PlannedBuffer { name, bytes, bytes_per_binding };
        plan.buffers.push(planned("cones", BYTES as u64 * count, BYTES as u64 * largest));
        plan.buffers.extend(match structure {
            Structure::Grid => {
                let (cells, listed) = (budget.cells as u64, budget.listed as u64);
                let ids = 4 * (largest + cells + listed);
                vec![
                    planned("ids, cells and references of cones", ids * bricks, ids),
                    planned("capsules", 8 * listed * bricks, 8 * listed),
                ]
            }
            _ => vec![
                planned("ids of cones", 4 * count, 4 * largest),
                planned("nodes of cones", node_bytes(structure, count), node_bytes(structure, largest)),
            ],
        });
        plan.cones = Some(ConesPlan { structure, brick_count: bricks as usize, per_brick: largest as usize, budget });
        plan
    }
}

/// The smallest and the largest coordinates of cones.
fn box_of(cones: &[ConeInFrame]) -> (Vec3, Vec3) {
    let parts = map_chunks(cones, |_, cones| {
        cones.iter().fold((Vec3::MAX, Vec3::MIN), |(min, max), cone| {
            let [low, high] = cone.corners().map(|corner| corner.as_vec3());
            (min.min(low), max.max(high))
        })
    });
    let joined = |a: (Vec3, Vec3), b: (Vec3, Vec3)| (a.0.min(b.0), a.1.max(b.1));
    parts.into_iter().fold((Vec3::MAX, Vec3::MIN), joined)
}

/// The limits for a grid of this many cones.
fn cone_grid_budget(count: u64, binding_bytes: u64) -> GridBudget {
    let cells = (count + (64 * count).min(1 << 16)).min(binding_bytes / 16).max(8);
    let most = 12 * count + (128 * count).min(1 << 18);
    // A capsule has eight bytes.
    let listed = most.min(binding_bytes / 8);
    let [listed, cells] = [listed, cells].map(|most| usize::try_from(most).unwrap_or(usize::MAX));
    GridBudget { listed, cells }
}

/// Builds a grid of cones. Returns it with the order of its cones, as indices of the given ones.
///
/// A cone is listed in the cells that come within `margin` of its surface.
pub(super) fn build_cone_grid(cones: &[ConeInFrame], margin: f32, budget: GridBudget) -> (Grid, Vec<u32>) {
    let (min, max) = box_of(cones);
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
