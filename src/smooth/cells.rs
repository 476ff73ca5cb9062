//! The cells, and how many of their sample points are inside shapes.

use glam::{DVec3, IVec3};

use super::pieces::{Axis, Pieces};
use crate::geometry::cone::ConeInFrame;
use crate::geometry::cone_crossing::crossings;
use crate::geometry::ray::Ray;
use crate::parallel;
use crate::scene::SharedShapes;

/// The most cells. They take a byte each.
const MOST: f64 = 32e6;

/// The number of empty cells on each side.
const AROUND: f64 = 4.0;

/// The largest side of cells, in terms of [`wanted_side`], up to which near spheres count one by one.
const MOST_GROWN: f64 = 1.6;

/// The factor by which cells are larger in scenes with cones.
const AMONG_CONES: f64 = 1.5;

/// Cubes of one size around all shapes.
#[derive(Debug)]
pub(super) struct Cells {
    /// The corner with the least coordinates.
    pub(super) origin: DVec3,
    pub(super) side: f64,
    /// The number of cells along each axis, which is even.
    pub(super) counts: [usize; 3],
    /// True if near spheres count one by one, which they do unless cells are much larger than spheres.
    pub(super) has_near: bool,
}

impl Cells {
    pub(super) fn new(shapes: &SharedShapes) -> Self {
        let bounds = shapes.bounds(DVec3::ZERO);
        let wanted = if bounds.is_some() { wanted_side(shapes) } else { 1.0 };
        // Sticks leave most cells empty, so that light passes many of them.
        let wanted = if shapes.cones.is_empty() { wanted } else { AMONG_CONES * wanted };
        let [low, size] = bounds.map_or([DVec3::ZERO; 2], |bounds| [bounds.min(), bounds.size()]);
        let counts_of = |side: f64| (size / (2.0 * side)).ceil() * 2.0 + 2.0 * AROUND;
        let mut side = wanted;
        while counts_of(side).element_product() > MOST {
            side *= 1.05;
        }
        let counts = counts_of(side).to_array().map(|count| count as usize);
        let has_near = side <= MOST_GROWN * wanted;
        Self { origin: low - AROUND * side, side, counts, has_near }
    }

    /// The position of a point, in cells.
    fn in_cells(&self, position: DVec3) -> DVec3 {
        (position - self.origin) / self.side
    }

    /// The number of sample points, of eight, inside shapes, for each cell. Each thread fills some layers.
    pub(super) fn fill(&self, shapes: &SharedShapes, pieces: &Pieces) -> Vec<u8> {
        let [x, y, z] = self.counts;
        let mut bits = vec![0; x * y * z];
        let layers = z.div_ceil(parallel::threads()).max(1);
        parallel::for_each(bits.chunks_mut(x * y * layers).enumerate().collect(), |(part, bits)| {
            let first = (part * layers) as i64;
            let samples = 2 * first..2 * (first + (bits.len() / (x * y)) as i64);
            for sphere in &shapes.spheres {
                self.fill_sphere(sphere, &samples, bits);
            }
            for (piece, ball) in pieces.with_balls(shapes) {
                self.fill_piece(&piece.cut(&shapes.cones[piece.cone as usize]), ball, &samples, bits);
            }
            bits.iter_mut().for_each(|bits: &mut u8| *bits = bits.count_ones() as u8);
        });
        bits
    }

    /// Sets the bits of the sample points inside a sphere, in some layers. The bit of a sample point in its cell has the
    /// index x + 2 y + 4 z.
    fn fill_sphere(&self, [x, y, z, radius]: &[f32; 4], layers: &std::ops::Range<i64>, bits: &mut [u8]) {
        // In units of the distance of sample points, of which the first is at 0.
        let [cx, cy, cz] = [x, y, z].map(|c| f64::from(*c));
        let center = 2.0 * self.in_cells(DVec3::new(cx, cy, cz)) - 0.5;
        let radius = 2.0 * f64::from(*radius) / self.side;
        let inside = |center: f64, reach: f64| -floor(reach - center)..=floor(center + reach);
        let (z0, z1) = inside(center.z, radius).into_inner();
        for z in z0.max(layers.start)..=z1.min(layers.end - 1) {
            let in_layer = radius * radius - (z as f64 - center.z).powi(2);
            for y in inside(center.y, in_layer.max(0.0).sqrt()) {
                let in_row = in_layer - (y as f64 - center.y).powi(2);
                if in_row < 0.0 {
                    continue;
                }
                self.fill_row(inside(center.x, in_row.sqrt()), [y, z], layers, bits);
            }
        }
    }

    /// Sets the bits of the sample points inside a piece of a cone, which is in a ball, in some layers.
    fn fill_piece(&self, piece: &ConeInFrame, ball: &[f32; 4], layers: &std::ops::Range<i64>, bits: &mut [u8]) {
        let [x, y, z, radius] = ball.map(f64::from);
        let center = 2.0 * self.in_cells(DVec3::new(x, y, z)) - 0.5;
        let radius = 2.0 * radius / self.side;
        let inside = |center: f64, reach: f64| -floor(reach - center)..=floor(center + reach);
        let (z0, z1) = inside(center.z, radius).into_inner();
        for z in z0.max(layers.start)..=z1.min(layers.end - 1) {
            for y in inside(center.y, radius) {
                let sample = DVec3::new(0.0, y as f64, z as f64);
                let origin = self.origin + 0.5 * self.side * (sample + 0.5);
                let Some([enters, leaves]) = crossings(&Ray { origin, direction: DVec3::X }, piece) else { continue };
                let [low, high] = [enters.t, leaves.t].map(|t| 2.0 * t / self.side);
                // Rounding may make a row longer than its ball.
                let (x0, x1) = inside(center.x, radius).into_inner();
                self.fill_row((-floor(-low)).max(x0)..=floor(high).min(x1), [y, z], layers, bits);
            }
        }
    }

    /// Sets the bits of some sample points of a row.
    fn fill_row(
        &self,
        samples: std::ops::RangeInclusive<i64>,
        [y, z]: [i64; 2],
        layers: &std::ops::Range<i64>,
        bits: &mut [u8],
    ) {
        let (x0, x1) = samples.into_inner();
        if x0 > x1 {
            return;
        }
        let row = (((z - layers.start) / 2) as usize * self.counts[1] + (y / 2) as usize) * self.counts[0];
        let shift = 2 * (y & 1) + 4 * (z & 1);
        for cell in x0.div_euclid(2)..=x1.div_euclid(2) {
            let first = u8::from(x0 <= 2 * cell && 2 * cell <= x1);
            let second = u8::from(x0 <= 2 * cell + 1 && 2 * cell < x1);
            bits[row + cell as usize] |= (first | second << 1) << shift;
        }
    }

    /// The number of cubes of 2×2×2 cells along each axis, and of vertices.
    pub(super) fn cube_counts(&self) -> [usize; 3] {
        self.counts.map(|count| count / 2)
    }

    /// The distance from a surface at which light of far spheres is looked up.
    fn lift(&self) -> f64 {
        self.side * if self.has_near { 0.8 } else { 0.4 }
    }

    /// The whole part of a place among cubes or vertices, of which there are `more` beyond it along each axis.
    fn within(&self, place: DVec3, more: i32) -> IVec3 {
        let counts = self.cube_counts();
        let place = place.to_array().map(floor);
        let within = |axis: usize| place[axis].clamp(0, counts[axis] as i64 - i64::from(more)) as i32;
        IVec3::new(within(0), within(1), within(2))
    }

    /// The vertex with the least coordinates around the place at which the light of far spheres is looked up for a point,
    /// and the place's distance from it along each axis, as a part of the distance of vertices.
    pub(super) fn tetrahedron(&self, position: DVec3, normal: DVec3) -> (IVec3, DVec3) {
        let place = (self.in_cells(position + self.lift() * normal) - 0.5) / 2.0;
        let first = self.within(place, 2);
        (first, (place - first.as_dvec3()).clamp(DVec3::ZERO, DVec3::ONE))
    }

    /// The number of the cube of a point.
    pub(super) fn cube_of(&self, position: DVec3) -> u32 {
        index(self.cube_counts(), self.within(self.in_cells(position) / 2.0, 1))
    }

    /// The cell of a vertex.
    pub(super) fn vertex(&self, number: u32) -> IVec3 {
        let [x, y, _] = self.cube_counts().map(|count| count as u32);
        2 * IVec3::new((number % x) as i32, (number / x % y) as i32, (number / x / y) as i32)
    }

    /// The middle of a cube.
    pub(super) fn middle(&self, number: u32) -> DVec3 {
        self.origin + self.side * (self.vertex(number) + IVec3::ONE).as_dvec3()
    }
}

/// The index of a cell in a grid.
pub(super) fn index(counts: [usize; 3], cell: IVec3) -> u32 {
    let [x, y, z] = cell.to_array().map(|c| c as usize);
    ((z * counts[1] + y) * counts[0] + x) as u32
}

/// The largest whole number that is not larger. It is quicker than a call of the standard library's function, which old
/// processors need.
pub(super) fn floor(x: f64) -> i64 {
    let whole = x as i64;
    whole - i64::from(whole as f64 > x)
}

/// The vertices of the tetrahedron around a place between eight vertices, with their barycentric weights: the way from
/// the first corner to the last one along the axes, the largest part first.
pub(super) fn corners(first: IVec3, parts: DVec3) -> [(IVec3, f64); 4] {
    let [x, y, z] = parts.to_array();
    let [longest, shortest] = if x >= y {
        [if x >= z { 0 } else { 2 }, if y < z { 1 } else { 2 }]
    } else {
        [if y >= z { 1 } else { 2 }, if x < z { 0 } else { 2 }]
    };
    let [a, b, c] = [longest, 3 - longest - shortest, shortest].map(|axis| parts[axis]);
    let last = first + IVec3::ONE;
    [(first, 1.0 - a), (first + IVec3::AXES[longest], a - b), (last - IVec3::AXES[shortest], b - c), (last, c)]
}

/// The side that cells should have: the mean radius, weighted by surface, but at most 1.5 times the radius below which
/// lies a quarter of all surface, so that small spheres beside large ones still cover several sample points.
fn wanted_side(shapes: &SharedShapes) -> f64 {
    /// Radii whose leading bits are the same are together. The order of positive numbers is that of their bits.
    const SHIFT: u32 = 18;
    const COUNT: usize = 1 << (32 - SHIFT);
    let parts = parallel::map_chunks(&shapes.spheres, |_, spheres| {
        let mut sums = vec![[0.0; 2]; COUNT];
        for [.., radius] in spheres {
            let (sum, radius) = (&mut sums[(radius.to_bits() >> SHIFT) as usize], f64::from(*radius));
            *sum = [sum[0] + radius.powi(2), sum[1] + radius.powi(3)];
        }
        sums
    });
    let mut sums = vec![[0.0; 2]; COUNT];
    for part in parts {
        sums.iter_mut().zip(part).for_each(|(sum, part)| *sum = [sum[0] + part[0], sum[1] + part[1]]);
    }
    // Of a cone, the side counts, divided by 4π as for spheres.
    for cone in &shapes.cones {
        let (axis, [first, second]) = (Axis::of(cone), cone.radii());
        let radius = 0.5 * (first + second);
        let surface = 0.5 * radius * axis.length;
        let sum = &mut sums[((radius as f32).to_bits() >> SHIFT) as usize];
        *sum = [sum[0] + surface, sum[1] + surface * radius];
    }
    let [surface, volume] = [0, 1].map(|k| sums.iter().map(|sum| sum[k]).sum::<f64>());
    let mut below = 0.0;
    let quarter = sums.iter().find(|[surface_here, _]| {
        below += surface_here;
        below >= 0.25 * surface
    });
    (volume / surface).min(1.5 * quarter.map_or(f64::MAX, |[surface, volume]| volume / surface))
}
