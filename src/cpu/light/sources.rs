//! The light sources among which the path integrator chooses.

use glam::DVec3;

use super::color::rgb;
use super::lamp;
use super::maps::{cone_density, versine};
use crate::light::LightKind;
use crate::render::LightSampling;

/// A light source that can be sampled. Each has the same probability.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// A light that scattered rays cannot hit.
    Lamp(LightKind),
    /// A disk at infinity.
    Sun(Sun),
    /// All emissive spheres together.
    Emitters,
    /// The image of the sky.
    Sky,
}

/// A light at infinity that scattered rays can hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sun {
    pub(super) toward: DVec3,
    /// 1 minus the cosine of its angular radius.
    pub(super) k: f64,
    pub(super) radiance: DVec3,
}

/// All light sources of a scene, for one method of light sampling.
#[derive(Debug, Default)]
pub(super) struct Sources {
    pub(super) sampled: Vec<Source>,
    suns: Vec<Sun>,
}

impl Sources {
    /// Collects the light sources, in the order in which random numbers choose them.
    pub(super) fn new(
        lights: &[LightKind],
        has_emitters: bool,
        has_sky: bool,
        sampling: LightSampling,
    ) -> Self {
        let samples_all = sampling != LightSampling::Chance;
        let mut sources = Self::default();
        for light in lights {
            match *light {
                LightKind::Head { .. } => {}
                LightKind::Directional { toward, strength, angular_radius }
                    if angular_radius > 0.0 =>
                {
                    let k = versine(angular_radius);
                    let radiance = rgb(strength) * lamp::sun_radiance(angular_radius);
                    let sun = Sun { toward, k, radiance };
                    sources.suns.push(sun);
                    sources.sampled.extend(samples_all.then_some(Source::Sun(sun)));
                }
                lamp => sources.sampled.push(Source::Lamp(lamp)),
            }
        }
        sources.sampled.extend((samples_all && has_emitters).then_some(Source::Emitters));
        sources.sampled.extend((samples_all && has_sky).then_some(Source::Sky));
        sources
    }

    pub(super) fn count(&self) -> f64 {
        self.sampled.len() as f64
    }

    pub(super) fn density_at_sun(&self, k: f64) -> f64 {
        cone_density(k) / self.count()
    }

    /// The radiance of each sun in a direction, and the density with which light sampling chooses the direction.
    pub(super) fn suns(&self, direction: DVec3) -> impl Iterator<Item = (DVec3, f64)> {
        // |d − t|² is 2 − 2 cos, which does not cancel if the two directions are close.
        let is_hit = move |sun: &&Sun| (direction - sun.toward).length_squared() <= 2.0 * sun.k;
        self.suns.iter().filter(is_hit).map(|sun| (sun.radiance, self.density_at_sun(sun.k)))
    }
}
