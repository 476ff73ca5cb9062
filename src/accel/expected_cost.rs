//! What a length of a ray costs where spheres have a density and radii, in cells and in nodes. Lengths are in units of
//! the regions' side.

use std::f64::consts::PI;

use super::ball::QUANTA;
use super::count::Counts;
use super::expected::Region;
use super::grid::ListLayout;
use super::grid_build::STEP_COST;
use super::{grid_dense, grid_empty};

/// The number of empty cells that a ray crosses in one step, about.
const SKIPPED: f64 = 3.0;

/// The number of cells that a ray crosses for each cell's side of its length: the mean of |x| + |y| + |z| of directions.
const CROSSED: f64 = 1.5;

/// The number of spheres of a leaf and of a node with leaves alone, about.
const IN_LEAF: f64 = 2.5;
const IN_NODE: f64 = 16.0;

/// How many more nodes, and spheres of leaves, rays meet than come before their hits: children are not visited in the
/// exact order of their distances, and the leaves of a node are tested together. Fitted to counts of R1M, R10M and L1M.
const MORE_NODES: f64 = 1.4;
const MORE_LEAVES: f64 = 1.2;

/// The first level of a grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct GridShape {
    pub(super) size: f64,
    pub(super) layout: ListLayout,
}

/// What a ray does for each unit of its length, and in addition where it hits a sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct LengthCost {
    pub(super) of_length: Counts,
    pub(super) of_hit: Counts,
}

/// The mean number of cells that a sphere of the region overlaps, like `mean_overlapped_cells`.
fn overlapped(region: &Region, size: f64) -> f64 {
    let [a, b, c] = region.radii;
    let inside = (b.sqrt() / size - 0.866).max(0.0);
    let ball = 4.0 / 3.0 * PI;
    let all = 1.0 + 6.0 * a / size + 3.0 * PI * b / (size * size) + ball * c / size.powi(3);
    (all - ball * inside.powi(3)).max(1.0)
}

/// The expected length of a cell's list.
fn listed(region: &Region, size: f64) -> f64 {
    region.density * size.powi(3) * overlapped(region, size)
}

/// The level of the grids inside cells, 0 if lists are better, and what that saves for each cell; as in `grid_dense.rs`.
fn best_level(region: &Region, size: f64) -> (i32, f64) {
    let step = f64::from(STEP_COST);
    let whole = step + listed(region, size);
    if whole - step < f64::from(grid_dense::CROWDED) {
        return (0, 0.0);
    }
    let cost = |level: i32| {
        let side = 2_f64.powi(level);
        side * (step + listed(region, size / side))
    };
    let best = (1..=i32::from(grid_dense::MAX_LEVEL))
        .map(|level| (level, cost(level)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    best.filter(|(_, cost)| *cost < f64::from(grid_dense::GAIN) * whole)
        .map_or((0, 0.0), |(level, cost)| (level, whole - cost))
}

/// Whether grids inside crowded cells save enough, as in `grid_dense.rs`.
pub(super) fn is_worth_nesting(regions: &[Region], shape: &GridShape) -> bool {
    let saved: f64 = regions.iter().map(|region| best_level(region, shape.size).1).sum();
    let step = f64::from(STEP_COST);
    let all: f64 = regions.iter().map(|region| step + listed(region, shape.size)).sum();
    saved >= f64::from(grid_dense::WORTH_IT) * all
}

/// Whether so many cells are empty that a walk skips them.
pub(super) fn is_skipping(regions: &[Region], shape: &GridShape) -> bool {
    let empty: f64 = regions.iter().map(|region| (-listed(region, shape.size)).exp()).sum();
    empty >= f64::from(grid_empty::WORTH_IT) * regions.len() as f64
}

/// The cost in a grid, whose crowded cells may have grids inside, and in which empty cells may be skipped.
pub(super) fn in_grid(region: &Region, shape: &GridShape, nests: bool, skips: bool) -> LengthCost {
    let level = if nests { best_level(region, shape.size).0 } else { 0 };
    let size = shape.size / 2_f64.powi(level);
    let list = listed(region, size);
    // A part of a ray in a cell is as long as this on average.
    let part = size / CROSSED;
    let (elements, spheres) = match shape.layout {
        ListLayout::Referenced => (list, list),
        ListLayout::Balls => {
            let elements = list + 1.5 * (1.0 - (-list).exp());
            // Balls are rounded up, by about half a diagonal of a quantum.
            let [a, b, c] = region.radii;
            let q = 0.9 * size / f64::from(QUANTA);
            let squared = b + 2.0 * q * a + q * q;
            let cubed = c + 3.0 * q * b + 3.0 * q * q * a + q * q * q;
            let met = region.density * (PI * squared * part + 4.0 / 3.0 * PI * cubed);
            (elements, met.min(elements))
        }
    };
    let outer = if level > 0 { CROSSED / shape.size } else { 0.0 };
    let is_empty = skips && level == 0 && list <= 0.0;
    let crossed = if is_empty { CROSSED / (SKIPPED * size) } else { CROSSED / size };
    let of_hit = Counts { steps: if level > 0 { 2.0 } else { 1.0 }, elements, spheres };
    let of_length = Counts { steps: crossed + outer, ..of_hit.times(crossed) };
    LengthCost { of_length, of_hit }
}

/// The cost in a tree: of boxes around as many spheres as nodes of each level have, a ray crosses those before its hit,
/// and the hit is in as many as overlap there.
pub(super) fn in_tree(region: &Region, longest: f64) -> LengthCost {
    let Region { density, radii: [radius, ..] } = *region;
    let nothing = Counts::default();
    if density <= 0.0 {
        return LengthCost { of_length: nothing, of_hit: nothing };
    }
    // Crossed boxes for each unit of length, and boxes around a point.
    let boxes = |count: f64| {
        let side = (count / density).cbrt();
        let tight = side * (count - 1.0) / (count + 1.0) + 2.0 * radius;
        (CROSSED * tight * tight / side.powi(3), (tight / side).powi(3))
    };
    let (mut crossed, mut around) = (0.0, 0.0);
    let mut count = IN_NODE;
    while (count / density).cbrt() < longest {
        let (some, here) = boxes(count);
        crossed += some;
        around += here;
        count *= 8.0;
    }
    let (leaves_crossed, leaves_around) = boxes(IN_LEAF);
    let cost = |nodes: f64, leaves: f64| Counts {
        steps: MORE_NODES * nodes,
        elements: 0.0,
        spheres: MORE_LEAVES * IN_LEAF * leaves,
    };
    LengthCost { of_length: cost(crossed, leaves_crossed), of_hit: cost(around, leaves_around) }
}
