//! What a scene's spheres are like, from one pass over them.

use glam::Vec3;

use crate::parallel::map_chunks;

/// Sizes and places of spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneStatistics {
    /// How many there are.
    pub count: usize,
    /// The corner of their box, in the scene's frame, with the smallest coordinates.
    pub min: Vec3,
    /// The opposite corner.
    pub max: Vec3,
    /// The smallest radius.
    pub radius_min: f32,
    /// The largest radius.
    pub radius_max: f32,
    /// The mean radius.
    pub radius_mean: f32,
    /// How many different spheres are expected to have their centres in the densest of the equal cubes that
    /// the box is divided into, 4096 along the longest side; from a sample, and 0 where that is too coarse to
    /// tell.
    pub densest: f32,
}

impl SceneStatistics {
    /// Of spheres in the scene's frame: centre and radius.
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

    /// How far from a sphere's surface the f32 arithmetic of a ray that starts in the box can stray: 2⁻¹⁸
    /// of the box's diagonal.
    ///
    /// No vector from a ray's origin to a centre is longer than the diagonal D. With u = 2⁻²³ for one
    /// rounding, because WGSL lets either neighbour be the result, the foot point of the sphere test is off
    /// by less than 9 u D, and the positions of planes and cells by less than 6 u D; 2⁻¹⁸ D is 32 u D.
    #[must_use]
    pub fn margin(&self) -> f32 {
        const PART: f32 = 1.0 / (1 << 18) as f32;
        let diagonal = (self.max - self.min).length();
        // A coordinate is rounded to f32 before anything else is.
        let farthest = self.min.abs().max(self.max.abs()).max_element();
        (diagonal * PART).max(farthest * (1.0 / (1 << 22) as f32))
    }

    /// The box that rays are moved to before they are traced.
    #[must_use]
    pub fn inflated_bounds(&self) -> (Vec3, Vec3) {
        let margin = 2.0 * self.margin();
        (self.min - margin, self.max + margin)
    }
}

/// From a sample, in which the densest cube must have several.
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
    // Of spheres that are the same, a list keeps one.
    sample.dedup();
    let most = sample.chunk_by(|a, b| a.0 == b.0).map(<[_]>::len).max().unwrap_or(0);
    if most < SEVERAL { 0.0 } else { (most * stride) as f32 }
}
