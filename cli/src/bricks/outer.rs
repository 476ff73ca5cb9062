//! Finds the spheres that determine what a camera frames: those that extend farthest in some direction.
//!
//! A sphere is left out if each of the eight octants around its centre, borders included, has the centre of another
//! sphere that is at least as large. A direction n points into one of the octants. For the sphere there, each nₖcₖ and
//! |n|r is at least as large, also in floating-point numbers, which round monotonically. So the largest n·c + |n|r of
//! all spheres is that of the kept spheres, to the bit, and so is the camera.

use pinhole::glam::{BVec3, UVec3, Vec3};

/// Cells along a side of the box of many spheres. Most spheres are left out cell by cell.
const CELLS: u32 = 128;

/// The number of spheres above which this many cells are worth their time.
const MANY: u64 = 1 << 20;

/// The most kept spheres that are compared with another. The limit can only keep too many spheres, never too few.
const COMPARED: usize = 512;

/// Number of candidates that are gathered before some are left out.
const GATHERED: usize = 1 << 20;

/// The largest radius in each cell of a grid. It shows in which cells no sphere can extend farthest.
pub(super) struct Cells {
    low: Vec3,
    scale: Vec3,
    /// For each axis, whether all centres have the same coordinate.
    flat: BVec3,
    /// Number of cells along each side.
    side: u32,
    radii: Vec<f32>,
}

impl Cells {
    /// Creates empty cells for a box around the centres of `count` spheres.
    pub(super) fn new(low: Vec3, high: Vec3, count: u64) -> Self {
        let side = if count < MANY { CELLS / 16 } else { CELLS };
        let size = (high - low).max(Vec3::splat(f32::MIN_POSITIVE));
        let radii = vec![0.0; side.pow(3) as usize];
        Self { low, scale: side as f32 / size, flat: BVec3::TRUE, side, radii }
    }

    fn index(&self, cell: UVec3) -> usize {
        ((cell.z * self.side + cell.y) * self.side + cell.x) as usize
    }

    /// The cell of a centre. Cell indices never decrease with a coordinate.
    fn cell(&self, center: Vec3) -> UVec3 {
        let place = (center - self.low) * self.scale;
        // Casts of numbers that are too small or too large give the ends of the range.
        let side = |x: f32| (x as u32).min(self.side - 1);
        UVec3::new(side(place.x), side(place.y), side(place.z))
    }

    pub(super) fn add(&mut self, [x, y, z, radius]: [f32; 4]) {
        let cell = self.index(self.cell(Vec3::new(x, y, z)));
        self.radii[cell] = self.radii[cell].max(radius);
    }

    /// Sets the axes along which all centres have the same coordinate.
    pub(super) fn set_flat(&mut self, flat: BVec3) {
        self.flat = flat;
    }

    /// Finds the cells whose spheres may extend farthest in some direction.
    pub(super) fn outermost(&self) -> Outermost<'_> {
        let mut may = vec![false; self.radii.len()];
        for octant in Octant::all() {
            let beyond = self.largest_beyond(octant);
            for z in 0..self.side {
                for y in 0..self.side {
                    for x in 0..self.side {
                        let cell = UVec3::new(x, y, z);
                        let here = self.radii[self.index(cell)];
                        let next = octant.next(cell, self);
                        let there = next.map(|next| beyond[self.index(next)]);
                        may[self.index(cell)] |= here > there.unwrap_or(0.0);
                    }
                }
            }
        }
        Outermost { cells: self, may }
    }

    /// Returns for each cell the largest radius in it and in all cells that lie farther into an octant along all axes.
    fn largest_beyond(&self, octant: Octant) -> Vec<f32> {
        let mut largest = self.radii.clone();
        for axis in 0..3 {
            let along = |step: u32| if octant.0[axis] { self.side - 1 - step } else { step };
            for step in 1..self.side {
                for a in 0..self.side {
                    for b in 0..self.side {
                        let cell = |step: u32| {
                            let mut cell = UVec3::ZERO;
                            cell[axis] = along(step);
                            cell[(axis + 1) % 3] = a;
                            cell[(axis + 2) % 3] = b;
                            self.index(cell)
                        };
                        let before = largest[cell(step - 1)];
                        let here = &mut largest[cell(step)];
                        *here = here.max(before);
                    }
                }
            }
        }
        largest
    }
}

/// The directions with these signs along the axes; true for plus.
#[derive(Clone, Copy)]
struct Octant([bool; 3]);

impl Octant {
    fn all() -> impl Iterator<Item = Self> {
        (0..8_u8).map(|bits| Self([0, 1, 2].map(|axis| bits >> axis & 1 == 1)))
    }

    /// Returns the next cell farther into the octant; `None` beyond the last. Along a flat axis it is the same cell.
    fn next(self, mut cell: UVec3, cells: &Cells) -> Option<UVec3> {
        for axis in 0..3 {
            if cells.flat.test(axis) {
                continue;
            }
            let next = if self.0[axis] { cell[axis] + 1 } else { cell[axis].wrapping_sub(1) };
            if next >= cells.side {
                return None;
            }
            cell[axis] = next;
        }
        Some(cell)
    }

    /// Mirrors the centre so that the octant becomes that of positive signs. The radius stays.
    fn turned(self, sphere: [f32; 4]) -> [f32; 4] {
        let sign = |axis: usize| if self.0[axis] { sphere[axis] } else { -sphere[axis] };
        [sign(0), sign(1), sign(2), sphere[3]]
    }
}

/// The cells with spheres that may extend farthest.
pub(super) struct Outermost<'a> {
    cells: &'a Cells,
    may: Vec<bool>,
}

/// The spheres that may extend farthest in some direction.
#[derive(Default)]
pub(super) struct Outer {
    spheres: Vec<[f32; 4]>,
    /// Number of spheres after the last reduction.
    reduced: usize,
}

impl Outer {
    pub(super) fn add(&mut self, outermost: &Outermost<'_>, sphere: [f32; 4]) {
        let [x, y, z, _] = sphere;
        if outermost.may[outermost.cells.index(outermost.cells.cell(Vec3::new(x, y, z)))] {
            self.spheres.push(sphere);
            if self.spheres.len() >= 2 * self.reduced + GATHERED {
                self.reduce();
            }
        }
    }

    /// Returns the kept spheres.
    pub(super) fn into_spheres(mut self) -> Vec<[f32; 4]> {
        self.reduce();
        self.spheres
    }

    fn reduce(&mut self) {
        let mut keeps = vec![false; self.spheres.len()];
        for octant in Octant::all() {
            for kept in farthest(&self.spheres, octant) {
                keeps[kept] = true;
            }
        }
        let mut keeps = keeps.into_iter();
        self.spheres.retain(|_| keeps.next().unwrap_or(true));
        self.reduced = self.spheres.len();
    }
}

/// Returns the indices of the spheres that no other exceeds in an octant. One of several equal spheres is included.
fn farthest(spheres: &[[f32; 4]], octant: Octant) -> Vec<usize> {
    let turned: Vec<[f32; 4]> = spheres.iter().map(|sphere| octant.turned(*sphere)).collect();
    let sum = |at: usize| turned[at].iter().map(|x| f64::from(*x)).sum::<f64>();
    let mut order: Vec<(f64, usize)> = (0..turned.len()).map(|at| (sum(at), at)).collect();
    // A sphere that exceeds another has no smaller sum, so it comes first, unless rounding made the sums equal.
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (mut compared, mut kept): (Vec<[f32; 4]>, Vec<usize>) = (Vec::new(), Vec::new());
    for (_, at) in order {
        let exceeds = |other: &[f32; 4]| (0..4).all(|i| other[i] >= turned[at][i]);
        if let Some(first) = compared.iter().position(exceeds) {
            // A sphere that has exceeded many will probably exceed more.
            compared.swap(first, first / 2);
            continue;
        }
        if compared.len() < COMPARED {
            compared.push(turned[at]);
        }
        kept.push(at);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use pinhole::LinearRgb;
    use pinhole::glam::DVec3;
    use pinhole::scene::Scene;

    /// Spheres by their numbers.
    type Kind<'a> = &'a dyn Fn(u32) -> [f32; 4];

    fn outer_of(spheres: &[[f32; 4]], count: u64) -> Vec<[f32; 4]> {
        let center = |s: &[f32; 4]| Vec3::new(s[0], s[1], s[2]);
        let low = spheres.iter().map(center).fold(Vec3::MAX, Vec3::min);
        let high = spheres.iter().map(center).fold(Vec3::MIN, Vec3::max);
        let mut cells = Cells::new(low, high, count);
        spheres.iter().for_each(|sphere| cells.add(*sphere));
        cells.set_flat(low.cmpeq(high));
        let outermost = cells.outermost();
        let mut outer = Outer::default();
        spheres.iter().for_each(|sphere| outer.add(&outermost, *sphere));
        outer.into_spheres()
    }

    /// A pseudo-random number between 0 and 1.
    fn random(seed: u32, number: u32) -> f32 {
        let x = (seed * 7919 + number).wrapping_mul(0x9e37_79b9);
        let x = (x ^ (x >> 15)).wrapping_mul(0x85eb_ca6b);
        (x ^ (x >> 13)) as f32 / u32::MAX as f32
    }

    #[test]
    fn the_spheres_that_are_kept_reach_as_far_as_all_to_the_bit() {
        let cube = |i: u32| [random(i, 0), random(i, 1), random(i, 2), 0.01];
        let radii = |i: u32| [random(i, 0), random(i, 1), random(i, 2), 0.2 * random(i, 3) + 0.01];
        let ball = |i: u32| {
            let p = DVec3::new(random(i, 0).into(), random(i, 1).into(), random(i, 2).into()) - 0.5;
            let p = p.normalize_or_zero() * f64::from(random(i, 3)).cbrt() * 70.0;
            [p.x as f32, p.y as f32, p.z as f32, 0.5]
        };
        let lattice = |i: u32| [(i % 20) as f32, (i / 20 % 20) as f32, (i / 400) as f32, 0.5];
        let flat = |i: u32| [random(i, 0), -3.0, random(i, 1), 0.1];
        let kinds: [(Kind<'_>, usize); 5] =
            [(&cube, 3000), (&radii, 6000), (&ball, 9000), (&lattice, 8), (&flat, 1000)];
        for (kind, (sphere, most)) in kinds.into_iter().enumerate() {
            let all: Vec<[f32; 4]> = (0..20_000).map(sphere).collect();
            let outer = outer_of(&all, if kind == 1 { MANY } else { 0 }); // Small cells take seconds.
            assert!(outer.len() <= most, "{kind}: {}", outer.len());
            let scene = Scene::from_f32(all, LinearRgb::WHITE).unwrap();
            let kept = Scene::from_f32(outer, LinearRgb::WHITE).unwrap();
            assert_eq!(scene.bounds(), kept.bounds(), "{kind}");
            for seed in 0..200 {
                let n = [0, 1, 2].map(|axis| f64::from(random(seed, 10 + axis)) - 0.5);
                let n = [DVec3::from(n), DVec3::AXES[seed as usize % 3]];
                let [found, expected] = [&kept, &scene].map(|scene| scene.subject().supports(n).map(f64::to_bits));
                assert_eq!(found, expected, "{kind} {n:?}");
            }
        }
    }
}
