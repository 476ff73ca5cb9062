//! Statistics of a scene's spheres, from one pass over them.

use glam::Vec3;

use crate::parallel::map_chunks;

/// Statistics of a scene's spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneStatistics {
    /// The number of spheres.
    pub count: usize,
    /// The corner of the spheres' bounding box with the smallest coordinates, in the scene's frame.
    pub min: Vec3,
    /// The corner with the largest coordinates.
    pub max: Vec3,
    /// The smallest radius.
    pub radius_min: f32,
    /// The largest radius.
    pub radius_max: f32,
    /// The mean radius.
    pub radius_mean: f32,
    /// The estimated number of different spheres whose centres lie in the densest cube, if the box is divided into
    /// equal cubes, 4096 along the longest side. Estimated from a sample; 0 if the sample is too small for an estimate.
    pub densest: f32,
}

impl SceneStatistics {
    /// Computes the statistics of spheres (centre in the scene's frame, radius).
    #[must_use]
    pub fn of(spheres: &[[f32; 4]]) -> Self {
        let parts = map_chunks(spheres, |_, spheres| {
            let nothing = (Vec3::MAX, Vec3::MIN, f32::MAX, 0.0_f32, 0.0_f64);
            spheres.iter().fold(nothing, |(min, max, least, most, sum), &[x, y, z, r]| {
                let center = Vec3::new(x, y, z);
                (
                    min.min(center - r),
                    max.max(center + r),
                    least.min(r),
                    most.max(r),
                    sum + f64::from(r),
                )
            })
        });
        if parts.is_empty() {
            let (min, max) = (Vec3::ZERO, Vec3::ZERO);
            let (radius_min, radius_max, radius_mean) = (0.0, 0.0, 0.0);
            return Self { count: 0, min, max, radius_min, radius_max, radius_mean, densest: 0.0 };
        }
        let mut all = (Vec3::MAX, Vec3::MIN, f32::MAX, 0.0_f32, 0.0_f64);
        for part in parts {
            all.0 = all.0.min(part.0);
            all.1 = all.1.max(part.1);
            all.2 = all.2.min(part.2);
            all.3 = all.3.max(part.3);
            all.4 += part.4;
        }
        let (min, max, radius_min, radius_max, sum) = all;
        let radius_mean = (sum / spheres.len() as f64) as f32;
        let densest = densest(spheres, min, max);
        Self { count: spheres.len(), min, max, radius_min, radius_max, radius_mean, densest }
    }

    /// More than the largest error of the f32 arithmetic of a ray that starts in the box, as a distance from a sphere's
    /// surface, on any device that rounds as WGSL allows: 2⁻¹⁷ of the box's diagonal. `slab.rs` adds up the errors.
    #[must_use]
    pub fn margin(&self) -> f32 {
        margin_of(self.min, self.max)
    }

    /// The box to which rays are moved before they are traced.
    #[must_use]
    pub fn inflated_bounds(&self) -> (Vec3, Vec3) {
        let margin = 2.0 * self.margin();
        (self.min - margin, self.max + margin)
    }
}

/// The margin as a part of a diagonal.
const MARGIN_PART: f32 = 1.0 / (1 << 17) as f32;

/// The margin of a scene with this box, as [`SceneStatistics::margin`] explains it.
pub(crate) fn margin_of(min: Vec3, max: Vec3) -> f32 {
    let diagonal = (max - min).length();
    // Coordinates have a rounding error before any arithmetic.
    let farthest = min.abs().max(max.abs()).max_element();
    (diagonal * MARGIN_PART).max(farthest * (1.0 / (1 << 22) as f32))
}

/// Estimates [`SceneStatistics::densest`] from a sample, of which several spheres must be in one cube.
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
    // A list keeps only one of several equal spheres.
    sample.dedup();
    let most = sample.chunk_by(|a, b| a.0 == b.0).map(<[_]>::len).max().unwrap_or(0);
    if most < SEVERAL { 0.0 } else { (most * stride) as f32 }
}
