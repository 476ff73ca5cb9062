//! The light that passes through the cells along some directions.

use std::f64::consts::PI;

use glam::{DVec3, IVec3};

use crate::smooth::cells::{Cells, index};

/// The number of directions in which openness is computed.
pub(super) const DIRECTIONS: usize = 32;

/// The sum of weighted counts from which on no light passes.
const OPAQUE: usize = 512;

/// The sum of weighted counts along which light becomes less by the factor e. A full cell adds 128.
const THICKNESS: f64 = 128.0;

/// Unit vectors that are spread evenly over the sphere: a Fibonacci lattice (R. Swinbank and R. J. Purser, "Fibonacci
/// grids", 2006).
pub(super) fn directions() -> [DVec3; DIRECTIONS] {
    std::array::from_fn(|k| {
        let z = 1.0 - (2 * k + 1) as f64 / DIRECTIONS as f64;
        let (sin, cos) = (PI * (3.0 - 5.0_f64.sqrt()) * k as f64).sin_cos();
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * cos, across * sin, z)
    })
}

/// The cells along the rays from a vertex.
#[derive(Debug)]
pub(super) struct Rays {
    rays: [Ray; DIRECTIONS],
    /// The share of light that passes, of 255, for each sum of weighted counts.
    passing: Vec<u8>,
}

#[derive(Debug)]
struct Ray {
    /// For each step the distance of its cell from that of the vertex, in the list of cells, and its weight.
    steps: Vec<(i32, u32)>,
    /// For each axis, whether cells come forward along it, and for each number of cells that are left before the grid's
    /// side, the number of steps that stay within.
    within: [(bool, Vec<usize>); 3],
}

impl Rays {
    pub(super) fn new(cells: &Cells, radius: f64) -> Self {
        let least = (-(OPAQUE as f64) / THICKNESS).exp();
        let share = |sum: usize| (((-(sum as f64) / THICKNESS).exp() - least) / (1.0 - least) * 255.0).round() as u8;
        let rays = directions().map(|direction| Ray::new(cells, direction, radius));
        Self { rays, passing: (0..=OPAQUE).map(share).collect() }
    }

    /// The share of light, of 255, that passes along each direction from the middle of a cell. `filled` has the counts of
    /// all cells.
    pub(super) fn from(&self, cells: &Cells, filled: &[u8], vertex: IVec3) -> [u8; DIRECTIONS] {
        std::array::from_fn(|k| self.passing[self.rays[k].sum(cells, filled, vertex)])
    }
}

impl Ray {
    fn new(cells: &Cells, direction: DVec3, radius: f64) -> Self {
        let [x, y, _] = cells.counts.map(|count| count as i32);
        let longest = cells.counts.iter().sum::<usize>() as f64;
        let length = (radius / cells.side).min(longest);
        let steps = (0..length.ceil() as usize).map(|j| {
            let part = (length - j as f64).min(1.0);
            let at = j as f64 + 0.5 * part;
            // Near spheres fade out from one to two sides away.
            let fade = if cells.has_near { (at - 1.0).clamp(0.0, 1.0) } else { 1.0 };
            ((at * direction + 0.5).floor().as_ivec3(), (16.0 * part * fade).round() as u32)
        });
        let steps: Vec<_> = steps.skip_while(|(_, weight)| *weight == 0).collect();
        let within = [0, 1, 2].map(|axis| {
            let reach = |(cell, _): &(IVec3, u32)| cell[axis].unsigned_abs() as usize;
            let most = (0..=cells.counts[axis]).map(|left| steps.partition_point(|step| reach(step) <= left));
            (direction[axis] > 0.0, most.collect())
        });
        let distance = |cell: IVec3| (cell.z * y + cell.y) * x + cell.x;
        Self { steps: steps.into_iter().map(|(cell, weight)| (distance(cell), weight)).collect(), within }
    }

    /// The sum of weighted counts along the ray from a cell, up to [`OPAQUE`].
    fn sum(&self, cells: &Cells, filled: &[u8], vertex: IVec3) -> usize {
        let start = index(cells.counts, vertex) as i32;
        let steps = [0, 1, 2].map(|axis| {
            let (is_forward, within) = &self.within[axis];
            let last = cells.counts[axis] as i32 - 1;
            within[if *is_forward { last - vertex[axis] } else { vertex[axis] } as usize]
        });
        let mut sum = 0;
        for (distance, weight) in &self.steps[..steps.into_iter().min().unwrap_or(0)] {
            sum += weight * u32::from(filled[(start + distance) as usize]);
            if sum >= OPAQUE as u32 {
                return OPAQUE;
            }
        }
        sum as usize
    }
}
