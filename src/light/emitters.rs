//! The emissive spheres of a scene, and the random choice of one by power.

use crate::image::color::{LinearRgb, luminance};
use crate::scene::material::{Material, SurfaceProperties};
use crate::scene::{Duplicates, Scene};

/// The emissive spheres of a scene, each with the probability of being chosen for light sampling.
///
/// Probabilities are multiples of 2⁻³², at least 2⁻³² each, and add up to 1, so that a device that computes with u32
/// chooses the same spheres with the same probabilities.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Emitters {
    ids: Vec<u32>,
    last: Vec<u32>,
}

/// A sphere that emits light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EmissiveSphere {
    /// Centre in the scene's frame, and radius.
    pub(crate) sphere: [f32; 4],
    pub(crate) color: LinearRgb,
    pub(crate) surface: SurfaceProperties,
}

impl EmissiveSphere {
    /// The spheres of `emitters`, in the same order.
    pub(crate) fn all(scene: &Scene, emitters: &Emitters) -> Vec<Self> {
        let emissive = |id: &u32| Self {
            sphere: scene.spheres()[*id as usize],
            color: scene.color(*id),
            surface: scene.surface(*id),
        };
        emitters.ids.iter().map(emissive).collect()
    }
}

impl Emitters {
    /// The spheres of a scene that emit light. Their weight is the luminance of their radiance times their opacity
    /// times the square of their radius. A sphere with the centre and radius of an earlier sphere is never visible, so
    /// it is left out.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let shines =
            |surface: &SurfaceProperties| matches!(surface.material, Material::Emissive { strength } if strength > 0.0);
        if !scene.appearance().surfaces().iter().any(shines) {
            return Self::default();
        }
        let mut weights: Vec<(u32, f64)> = (0..scene.len() as u32)
            .map(|id| {
                let radius = f64::from(scene.spheres()[id as usize][3]);
                let color = scene.color(id).to_array().map(f64::from);
                (id, brightness(color, &scene.surface(id)) * radius * radius)
            })
            .filter(|(_, weight)| *weight > 0.0)
            .collect();
        let duplicates = Duplicates::of(scene.spheres());
        weights.retain(|(id, _)| duplicates.first_of(*id) == *id);
        let total: f64 = weights.iter().map(|(_, weight)| weight).sum();
        // Each sphere gets 2⁻³² for certain, and a share of the rest in proportion to its weight.
        let others = (1_u64 << 32) - weights.len() as u64;
        let mut sum = 0.0;
        let last = weights.iter().enumerate().map(|(index, (_, weight))| {
            sum += weight;
            let shared = (sum / total * others as f64).floor() as u64;
            // One less than the number of picks up to here. That number is at least one.
            (index as u64 + shared.min(others)) as u32
        });
        let mut last: Vec<u32> = last.collect();
        if let Some(end) = last.last_mut() {
            *end = u32::MAX;
        }
        Self { ids: weights.iter().map(|(id, _)| *id).collect(), last }
    }

    /// Indices of the emissive spheres, in ascending order.
    #[must_use]
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// For each entry of [`Emitters::ids`], the largest u32 that picks it, which is 2³² times the cumulative
    /// probability, less one. The numbers ascend, and the last is 2³² − 1.
    #[must_use]
    pub fn last_picks(&self) -> &[u32] {
        &self.last
    }

    /// Whether no sphere emits light.
    pub(crate) fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Chooses an emissive sphere by a uniform random number. Returns the index in [`Emitters::ids`] of the first entry
    /// whose last pick is at least `u`, and its probability. `None` if there are no emitters.
    #[must_use]
    pub fn pick(&self, u: u32) -> Option<(usize, f64)> {
        let index = self.last.partition_point(|last| *last < u);
        (index < self.last.len()).then(|| (index, self.probability_at(index)))
    }

    /// The probability with which a sphere is picked. 0 for a sphere that emits no light.
    #[must_use]
    pub fn probability(&self, id: u32) -> f64 {
        self.ids.binary_search(&id).map_or(0.0, |index| self.probability_at(index))
    }

    fn probability_at(&self, index: usize) -> f64 {
        let before = if index == 0 { 0.0 } else { f64::from(self.last[index - 1]) + 1.0 };
        (f64::from(self.last[index]) + 1.0 - before) / 2_f64.powi(32)
    }
}

fn brightness(color: [f64; 3], surface: &SurfaceProperties) -> f64 {
    match surface.material {
        Material::Emissive { strength } => luminance(color) * f64::from(strength) * f64::from(surface.opacity),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::sphere::Sphere;

    fn lamp(radius: f64, strength: f32) -> Sphere {
        Sphere::new([0.0; 3], radius, LinearRgb::WHITE).with_material(Material::Emissive { strength })
    }

    #[test]
    fn probabilities_follow_power() {
        let matt = Sphere::new([0.0; 3], 1.0, LinearRgb::WHITE);
        let dark = lamp(1.0, 1.0).with_opacity(0.0);
        let mut spheres = [matt, lamp(1.0, 3.0), lamp(1.0, 0.0), lamp(2.0, 1.0), dark, lamp(1.0, 1.0)];
        for (x, sphere) in spheres.iter_mut().enumerate() {
            sphere.center[0] = x as f64;
        }
        let emitters = Emitters::of(&Scene::new(&spheres).unwrap());
        assert_eq!(emitters.ids(), [1, 3, 5]);
        for (id, eighths) in [(0, 0.0), (1, 3.0), (2, 0.0), (3, 4.0), (4, 0.0), (5, 1.0), (9, 0.0)] {
            let found = emitters.probability(id);
            assert!((found - eighths / 8.0).abs() < 1e-9, "{id}: {found}");
        }
        assert_eq!(emitters.last_picks()[2], u32::MAX);
    }

    /// All 2³² numbers pick a sphere, and the share of each sphere equals its probability.
    #[test]
    fn every_number_picks_and_the_faintest_is_picked() {
        let spheres = [lamp(1e-9, 1e-9), lamp(1e9, 1e6), lamp(2e-9, 1e-9), lamp(1.0, 1e-3)];
        let emitters = Emitters::of(&Scene::new(&spheres).unwrap());
        let mut first = 0_u64;
        for (index, id) in emitters.ids().iter().enumerate() {
            let last = u64::from(emitters.last_picks()[index]);
            let probability = (last + 1 - first) as f64 / 2_f64.powi(32);
            assert!(last >= first, "{id}");
            for u in [first, last] {
                assert_eq!(emitters.pick(u as u32), Some((index, probability)));
            }
            assert_eq!(Some((index, emitters.probability(*id))), emitters.pick(first as u32));
            first = last + 1;
        }
        assert_eq!(first, 1 << 32);
    }

    /// An emissive sphere with the centre and radius of an earlier sphere is never visible.
    #[test]
    fn what_is_never_met_is_not_picked() {
        let matt = Sphere::new([-0.0; 3], 2.0, LinearRgb::WHITE);
        let twice = [lamp(1.0, 1.0), matt, lamp(1.0, 1.0), lamp(2.0, 1.0), lamp(3.0, 1.0), matt];
        assert_eq!(Emitters::of(&Scene::new(&twice).unwrap()).ids(), [0, 4]);
        let first = [lamp(2.0, 1.0), matt];
        assert_eq!(Emitters::of(&Scene::new(&first).unwrap()).ids(), [0]);
    }

    #[test]
    fn one_takes_all_and_none_takes_nothing() {
        let one = Emitters::of(&Scene::new(&[lamp(1.0, 1.0)]).unwrap());
        assert_eq!([0, u32::MAX].map(|u| one.pick(u)), [Some((0, 1.0)); 2]);
        let none = Emitters::of(&Scene::new(&[lamp(1.0, 0.0)]).unwrap());
        assert!(none.is_empty() && none.pick(0).is_none());
    }
}
