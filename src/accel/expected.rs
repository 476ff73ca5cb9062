//! What rays are expected to do in structures that have not been built: rays are marched through a coarse picture of the
//! scene's density, and each length of them costs what cells or nodes of the local size cost.

use std::f64::consts::PI;

use glam::DVec3;

use super::count::Counts;
use super::expected_cost::{
    GridShape, LengthCost, in_grid, in_tree, is_skipping, is_worth_nesting,
};
use super::statistics::SceneStatistics;

/// The largest number of spheres that the density is made from.
const SAMPLES: usize = 1 << 18;

/// The number of sampled spheres for each region of the scene's box.
const PER_REGION: f64 = 8.0;

/// The number of marched rays.
const RAYS: u32 = 512;

/// The largest number of regions that say whether a grid has a second level, and whether it skips empty cells.
const ASKED: usize = 1 << 12;

/// What a ray is expected to do in each structure, as a mean over rays that meet the scene's box from all sides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Expected {
    /// In a grid of references.
    pub references: Counts,
    /// In a grid with balls.
    pub balls: Counts,
    /// In an 8-wide tree.
    pub tree: Counts,
}

/// A cube of the scene: the spheres whose centres lie in it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Region {
    /// The number of spheres for each unit of volume.
    pub(super) density: f64,
    /// Means of the radii, their squares and their cubes.
    pub(super) radii: [f64; 3],
}

/// The scene's box in equal regions.
struct Regions {
    /// The side of a region in the scene's units. All other lengths are in units of it.
    side: f64,
    extent: DVec3,
    counts: [usize; 3],
    regions: Vec<Region>,
}

impl Expected {
    /// Estimates for spheres and the shapes of the two grids: of references, and with balls.
    pub(super) fn of(
        spheres: &[[f32; 4]],
        statistics: &SceneStatistics,
        [references, balls]: [GridShape; 2],
    ) -> Self {
        let regions = Regions::of(spheres, statistics);
        let longest = regions.extent.max_element();
        let grid = |shape: GridShape| {
            let shape = GridShape { size: shape.size / regions.side, ..shape };
            let stride = regions.regions.len().div_ceil(ASKED);
            let some: Vec<Region> = regions.regions.iter().step_by(stride).copied().collect();
            let nests = is_worth_nesting(&some, &shape);
            let skips = is_skipping(&some, &shape);
            regions.march(|region| in_grid(region, &shape, nests, skips))
        };
        Self {
            references: grid(references),
            balls: grid(balls),
            tree: regions.march(|region| in_tree(region, longest)),
        }
    }
}

impl Regions {
    fn of(spheres: &[[f32; 4]], statistics: &SceneStatistics) -> Self {
        let (min, max) = (statistics.min.as_dvec3(), statistics.max.as_dvec3());
        let longest = (max - min).max_element().max(f64::MIN_POSITIVE);
        // Prevents a volume of zero for flat scenes.
        let extent = (max - min).max(DVec3::splat(longest * 1e-3));
        let stride = spheres.len().div_ceil(SAMPLES).max(1);
        let samples = spheres.len().div_ceil(stride) as f64;
        let wanted = (samples / PER_REGION).max(1.0);
        // Relative to the longest side, so that products do not leave the range of f64.
        let relative = extent / longest;
        let side = longest * (relative.x * relative.y * relative.z / wanted).cbrt();
        let counts = (extent / side).to_array().map(|count| (count.ceil() as usize).max(1));
        let mut sums = vec![[0.0_f64; 4]; counts.iter().product()];
        for [x, y, z, radius] in spheres.iter().step_by(stride) {
            let at = (DVec3::new((*x).into(), (*y).into(), (*z).into()) - min) / side;
            let r = f64::from(*radius) / side;
            let sum = &mut sums[index(counts, at)];
            for (sum, add) in sum.iter_mut().zip([1.0, r, r * r, r * r * r]) {
                *sum += add;
            }
        }
        let region = |[count, a, b, c]: &[f64; 4]| Region {
            density: count * stride as f64,
            radii: [a, b, c].map(|sum| if *count > 0.0 { sum / count } else { 0.0 }),
        };
        let regions = sums.iter().map(region).collect();
        Self { side, extent: extent / side, counts, regions }
    }

    /// Marches rays through the regions, in units of the regions' side: how far each goes is a matter of chance.
    fn march(&self, cost: impl Fn(&Region) -> LengthCost) -> Counts {
        const STEP: f64 = 0.5;
        let mut costs = vec![None; self.regions.len()];
        let (mut all, mut weights) = (Counts::default(), 0.0);
        for i in 0..RAYS {
            let (within, direction) = quasi_random(i);
            let at = within * self.extent;
            let to_sides = [DVec3::ZERO, self.extent].map(|side| (side - at) / direction);
            let enters = to_sides[0].min(to_sides[1]).max_element();
            let leaves = to_sides[0].max(to_sides[1]).min_element();
            // Points are more often on long rays than on short ones; all rays count alike.
            let weight = 1.0 / (leaves - enters).max(1e-9);
            weights += weight;
            // The share of rays that have not hit anything yet.
            let mut alive = 1.0;
            let mut t = enters;
            while t < leaves && alive > 1e-3 {
                let step = STEP.min(leaves - t);
                let region = index(self.counts, at + (t + 0.5 * step) * direction);
                let cost = *costs[region].get_or_insert_with(|| cost(&self.regions[region]));
                let Region { density, radii } = self.regions[region];
                let thickness = density * PI * radii[1] * step;
                let hits = alive * (1.0 - (-thickness).exp());
                let mean = if thickness > 1e-9 { hits / thickness * step } else { alive * step };
                // A sphere is hit two thirds of its radius before the foot of its centre, on average.
                let before = if radii[1] > 0.0 { 2.0 / 3.0 * radii[2] / radii[1] } else { 0.0 };
                let length = (mean - hits * before).max(0.0);
                all = all
                    .plus(cost.of_length.times(weight * length))
                    .plus(cost.of_hit.times(weight * hits));
                alive -= hits;
                t += step;
            }
        }
        all.times(1.0 / weights)
    }
}

fn index(counts: [usize; 3], at: DVec3) -> usize {
    // A cast saturates, so that negative values become 0.
    let [x, y, z] = at.to_array().map(|x| x as usize);
    let [width, height, depth] = counts;
    (z.min(depth - 1) * height + y.min(height - 1)) * width + x.min(width - 1)
}

/// A point of the unit cube and a direction: the additive sequence of Roberts (2018) in five dimensions.
fn quasi_random(i: u32) -> (DVec3, DVec3) {
    // The root of x⁶ = x + 1.
    const ROOT: f64 = 1.134_724_138_401_519_5;
    let mut step = 1.0;
    let [a, b, c, d, e] = std::array::from_fn(|_| {
        step /= ROOT;
        (0.5 + step * f64::from(i + 1)).fract()
    });
    let z = 2.0 * d - 1.0;
    let (sin, cos) = (2.0 * PI * e).sin_cos();
    let across = (1.0 - z * z).sqrt();
    (DVec3::new(a, b, c), DVec3::new(across * cos, across * sin, z))
}
