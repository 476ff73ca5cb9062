//! Statistics of a scene's spheres, from one pass over them, and outliers. Outliers are a few spheres far away from all
//! others, which form the crowd.
//!
//! Outliers enlarge a scene's box and its margin. If a sphere is ten thousand times as far away as the crowd is large,
//! 2⁻¹⁷ of the diagonal is 8 % of the crowd. Rays that start near the crowd need less for its spheres, because errors
//! grow with the distance from a ray's origin to a centre (`slab.rs`). So a tree gives the crowd's spheres the margin
//! of the crowd's box, and widens boxes for rays from farther away (`widening` in `shaders/accel/wide_tree.wgsl`).
use glam::Vec3;

use crate::parallel::map_chunks;

/// Statistics of a scene's spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneStatistics {
    /// The number of spheres.
    pub count: usize,
    /// The corner of the spheres' bounding box with the smallest coordinates, in the scene's frame.
    pub min: Vec3,
    /// The corner of the bounding box with the largest coordinates, in the scene's frame.
    pub max: Vec3,
    /// The smallest radius.
    pub radius_min: f32,
    /// The largest radius.
    pub radius_max: f32,
    /// The mean radius.
    pub radius_mean: f32,
    /// The estimated number of different spheres whose centres lie in the densest cube, if the box is divided into
    /// equal cubes, 4096 along the longest side. 0 if the sample is too small for an estimate.
    pub densest: f32,
}

impl SceneStatistics {
    /// Computes the statistics of spheres (centre in the scene's frame, radius).
    #[must_use]
    pub fn of(spheres: &[[f32; 4]]) -> Self {
        type Part = (Vec3, Vec3, f32, f32, f64);
        let nothing: Part = (Vec3::MAX, Vec3::MIN, f32::MAX, 0.0, 0.0);
        let of_sphere = |&[x, y, z, r]: &[f32; 4]| -> Part {
            let center = Vec3::new(x, y, z);
            (center - r, center + r, r, r, f64::from(r))
        };
        let joined = |a: Part, b: Part| -> Part { (a.0.min(b.0), a.1.max(b.1), a.2.min(b.2), a.3.max(b.3), a.4 + b.4) };
        let parts = map_chunks(spheres, |_, spheres| spheres.iter().map(of_sphere).fold(nothing, joined));
        let all = parts.into_iter().fold(nothing, joined);
        let (min, max, radius_min, radius_max, sum) = all;
        if spheres.is_empty() {
            let (min, max) = (Vec3::ZERO, Vec3::ZERO);
            let (radius_min, radius_max, radius_mean) = (0.0, 0.0, 0.0);
            return Self { count: 0, min, max, radius_min, radius_max, radius_mean, densest: 0.0 };
        }
        let radius_mean = (sum / spheres.len() as f64) as f32;
        let densest = densest(spheres, min, max);
        Self { count: spheres.len(), min, max, radius_min, radius_max, radius_mean, densest }
    }

    /// An upper bound of the rounding errors of a ray that starts in the box, as a distance from a sphere's surface, on
    /// any device that rounds as WGSL allows. It is 2⁻¹⁷ of the box's diagonal. `slab.rs` adds up the errors.
    #[must_use]
    pub fn margin(&self) -> f32 {
        margin_of(self.min, self.max)
    }

    /// The box to which rays are moved before they are traced.
    pub(crate) fn inflated_bounds(&self) -> (Vec3, Vec3) {
        let margin = 2.0 * self.margin();
        (self.min - margin, self.max + margin)
    }
}

/// The margin as a fraction of the diagonal.
const MARGIN_PART: f32 = 1.0 / (1 << 17) as f32;

/// The margin of a scene with the given box, as [`SceneStatistics::margin`] explains.
pub(crate) fn margin_of(min: Vec3, max: Vec3) -> f32 {
    let diagonal = (max - min).length();
    // Coordinates are rounded before any arithmetic.
    let farthest = min.abs().max(max.abs()).max_element();
    (diagonal * MARGIN_PART).max(farthest * (1.0 / (1 << 22) as f32))
}

/// Estimates [`SceneStatistics::densest`] from a sample. Several sampled spheres must be in one cube.
fn densest(spheres: &[[f32; 4]], min: Vec3, max: Vec3) -> f32 {
    const SAMPLES: usize = 1 << 16;
    const SEVERAL: usize = 8;
    const CUBES: f32 = 4096.0;
    let cubes_per_length = CUBES / (max - min).max_element();
    let stride = spheres.len().div_ceil(SAMPLES).max(1);
    let mut sample: Vec<_> = spheres
        .iter()
        .step_by(stride)
        .map(|sphere| {
            let center = Vec3::new(sphere[0], sphere[1], sphere[2]);
            let cube = ((center - min) * cubes_per_length).to_array().map(|x| x as u16);
            (cube, sphere.map(f32::to_bits))
        })
        .collect();
    sample.sort_unstable();
    // A list keeps only one of several equal spheres, so duplicates do not count.
    sample.dedup();
    let most = sample.chunk_by(|a, b| a.0 == b.0).map(<[_]>::len).max().unwrap_or(0);
    if most < SEVERAL { 0.0 } else { (most * stride) as f32 }
}

/// The number of spheres per outlier is at least `ONE_IN`, and there are at most [`MOST`] outliers.
const ONE_IN: usize = 1000;
const MOST: usize = 4096;

/// The diagonal of the scene's box is at least this many times that of the crowd's box.
const SEVERAL_TIMES: f32 = 8.0;

/// The number of margins along a side of the smallest cell that is worth its lists.
const CELL_MARGINS: f32 = 8.0;

/// The size of the sample from which the place of the crowd is estimated.
const SAMPLES: usize = 1 << 14;

/// At each end of each axis, one in this many sampled spheres is left out: more than there are outliers.
const LEFT_OUT: usize = 100;

/// The box of the remaining sampled spheres is widened on each side by this many of its longest sides.
const SIDES: f32 = 2.0;

/// All spheres of a scene except a few outliers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crowd {
    /// The number of spheres that are not in the crowd.
    pub outliers: usize,
    /// The corner of the box of the crowd's spheres with the smallest coordinates, in the scene's frame.
    pub min: Vec3,
    /// The corner of that box with the largest coordinates.
    pub max: Vec3,
}

impl Crowd {
    /// Finds the crowd in a scene. `None` if there are no outliers.
    pub(super) fn find(spheres: &[[f32; 4]], statistics: &SceneStatistics) -> Option<Self> {
        let most = (spheres.len() / ONE_IN).min(MOST);
        if most == 0 {
            return None;
        }
        let (low, high) = widened_middle(spheres);
        if low.cmple(statistics.min).all() && high.cmpge(statistics.max).all() {
            return None;
        }
        let parts = map_chunks(spheres, |_, spheres| {
            let nothing = Self { outliers: 0, min: Vec3::MAX, max: Vec3::MIN };
            spheres.iter().fold(nothing, |crowd, sphere| {
                let (min, max) = corners(sphere);
                if low.cmple(min).all() && high.cmpge(max).all() {
                    Self { min: crowd.min.min(min), max: crowd.max.max(max), ..crowd }
                } else {
                    Self { outliers: crowd.outliers + 1, ..crowd }
                }
            })
        });
        let crowd = parts.into_iter().reduce(|a, b| Self {
            outliers: a.outliers + b.outliers,
            min: a.min.min(b.min),
            max: a.max.max(b.max),
        })?;
        let whole = (statistics.max - statistics.min).length();
        let is_small = (crowd.max - crowd.min).length() * SEVERAL_TIMES <= whole;
        ((1..=most).contains(&crowd.outliers) && is_small).then_some(crowd)
    }

    /// Whether the scene's margin, which a grid uses for all spheres, is too large beside the distance between
    /// neighbours in the crowd.
    pub(super) fn is_lost_in_margin(&self, statistics: &SceneStatistics) -> bool {
        // About the distance between neighbours, which is also about the size of a cell.
        let spacing = (self.max - self.min).max_element() / (statistics.count as f32).cbrt();
        statistics.margin() * CELL_MARGINS > spacing
    }

    /// Whether a sphere is in the box of the crowd.
    pub(super) fn contains(&self, sphere: &[f32; 4]) -> bool {
        let (min, max) = corners(sphere);
        self.min.cmple(min).all() && self.max.cmpge(max).all()
    }

    /// The margin of the crowd's spheres for rays that start in the crowd's box.
    pub(crate) fn margin(&self) -> f32 {
        margin_of(self.min, self.max)
    }
}

fn corners(&[x, y, z, radius]: &[f32; 4]) -> (Vec3, Vec3) {
    let center = Vec3::new(x, y, z);
    (center - radius, center + radius)
}

/// The box of most spheres of a sample, widened on each side by several times its size.
fn widened_middle(spheres: &[[f32; 4]]) -> (Vec3, Vec3) {
    let stride = spheres.len().div_ceil(SAMPLES).max(1);
    let sample: Vec<(Vec3, Vec3)> = spheres.iter().step_by(stride).map(corners).collect();
    let left_out = sample.len() / LEFT_OUT;
    let (mut low, mut high) = (Vec3::ZERO, Vec3::ZERO);
    let mut values: Vec<f32> = Vec::with_capacity(sample.len());
    let mut ranked = |rank: usize, of: &dyn Fn(&(Vec3, Vec3)) -> f32| {
        values.clear();
        values.extend(sample.iter().map(of));
        if rank < values.len() { *values.select_nth_unstable_by(rank, f32::total_cmp).1 } else { 0.0 }
    };
    for axis in 0..3 {
        low[axis] = ranked(left_out, &|(min, _)| min[axis]);
        high[axis] = ranked(sample.len().saturating_sub(left_out + 1), &|(_, max)| max[axis]);
    }
    let around = SIDES * (high - low).max_element();
    (low - around, high + around)
}

/// The margin of each sphere of a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Margins {
    /// The margin of spheres that are not in the crowd's box.
    pub(super) all: f32,
    pub(crate) crowd: Option<Crowd>,
}

impl Margins {
    /// One margin for all spheres.
    pub(super) const fn one(margin: f32) -> Self {
        Self { all: margin, crowd: None }
    }

    /// The margin of a sphere.
    pub(super) fn of(&self, sphere: &[f32; 4]) -> f32 {
        match &self.crowd {
            Some(crowd) if crowd.contains(sphere) => crowd.margin(),
            _ => self.all,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(spheres: &[[f32; 4]]) -> Option<Crowd> {
        Crowd::find(spheres, &SceneStatistics::of(spheres))
    }

    fn crowd(count: usize) -> Vec<[f32; 4]> {
        let mut rng = fastrand::Rng::with_seed(1);
        (0..count).map(|_| [rng.f32(), rng.f32(), rng.f32(), 0.01]).collect()
    }

    /// Outliers are far away along one axis or all, the first or the last spheres, alike or not.
    #[test]
    fn few_spheres_far_away_are_outliers() {
        let inside = crowd(20_000);
        assert_eq!(found(&inside), None);
        for count in [1, 2, 20] {
            for far in [60.0, 1e4, 1e6, -1e12] {
                for place in [[far, 0.5, 0.5], [0.5, 0.5, far], [far, -far, far]] {
                    for spread in [0.0, 0.1] {
                        let outlier = |i: usize| {
                            let [x, y, z] = place.map(|x| x + spread * x * i as f32);
                            [x, y, z, 0.01]
                        };
                        let far: Vec<_> = (0..count).map(outlier).collect();
                        for all in [[&inside[..], &far[..]], [&far[..], &inside[..]]] {
                            let all = all.concat();
                            let crowd = found(&all).unwrap();
                            assert_eq!(crowd.outliers, count, "{place:?}");
                            let statistics = SceneStatistics::of(&inside);
                            assert_eq!((crowd.min, crowd.max), (statistics.min, statistics.max));
                            assert!(inside.iter().all(|sphere| crowd.contains(sphere)));
                            assert!(!far.iter().any(|sphere| crowd.contains(sphere)));
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn many_spheres_and_near_ones_are_no_outliers() {
        let inside = crowd(20_000);
        let with = |count: usize, sphere: [f32; 4]| [&inside[..], &vec![sphere; count]].concat();
        assert!(found(&with(20, [1e4, 0.0, 0.0, 1.0])).is_some());
        assert_eq!(found(&with(21, [1e4, 0.0, 0.0, 1.0])), None);
        assert_eq!(found(&with(1, [5.0, 0.0, 0.0, 0.01])), None);
        assert_eq!(found(&[]), None);
        assert_eq!(found(&[[0.0, 0.0, 0.0, 1.0], [1e4, 0.0, 0.0, 1.0]]), None);
    }

    /// A crowd of equal spheres has the size of one sphere. A large sphere around it is an outlier, too.
    #[test]
    fn equal_spheres_and_large_ones() {
        let equal = vec![[3.0, 2.0, 1.0, 0.5]; 2_000];
        assert_eq!(found(&equal), None);
        let with = |sphere: [f32; 4]| [&equal[..], &[sphere]].concat();
        assert_eq!(found(&with([1e3, 0.0, 0.0, 0.5])).map(|crowd| crowd.outliers), Some(1));
        assert_eq!(found(&with([3.0, 2.0, 1.0, 1e3])).map(|crowd| crowd.outliers), Some(1));
        let twice = [&equal[..], &vec![[1e3, 0.0, 0.0, 0.5]; 2_000]].concat();
        assert_eq!(found(&twice), None);
    }
}
