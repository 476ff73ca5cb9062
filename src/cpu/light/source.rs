//! Light sampling of the path integrator: the choice of a light source, and the densities of directions.

use glam::DVec3;

use super::context::{LightingContext, rgb};
use super::lamp::{self, Arrival};
use super::maps::{TangentFrame, cone, cone_density, cone_of_sphere, versine};
use super::surface_ray::Surface;
use crate::camera::sampling::unit;
use crate::light::LightKind;
use crate::render::LightSampling;

/// A light source that can be sampled. Each has the same probability.
#[derive(Clone, Copy, Debug)]
enum Source {
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
struct Sun {
    toward: DVec3,
    /// 1 minus the cosine of its angular radius.
    k: f64,
    radiance: DVec3,
}

/// All light sources of a scene, for one method of light sampling.
#[derive(Debug, Default)]
pub(super) struct Sources {
    sampled: Vec<Source>,
    suns: Vec<Sun>,
}

/// A sample of a light source, seen from a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightSample {
    pub(super) direction: DVec3,
    /// Distance to the light.
    pub(super) distance: f64,
    /// The emissive sphere that was sampled, if any.
    pub(super) sphere: Option<u32>,
    pub(super) light: SampledLight,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum SampledLight {
    /// For a light that scattered rays cannot hit: radiance that a white surface facing it would reflect, divided by
    /// the probability of the choice.
    Lamp(DVec3),
    /// Radiance, and the density per steradian with which the direction was sampled.
    Radiance(DVec3, f64),
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

    fn count(&self) -> f64 {
        self.sampled.len() as f64
    }

    fn density_at_sun(&self, k: f64) -> f64 {
        cone_density(k) / self.count()
    }

    /// The radiance of each sun in a direction, and the density with which light sampling chooses the direction.
    pub(super) fn suns(&self, direction: DVec3) -> impl Iterator<Item = (DVec3, f64)> {
        // |d − t|² is 2 − 2 cos, which does not cancel if the two directions are close.
        let is_hit = move |sun: &&Sun| (direction - sun.toward).length_squared() <= 2.0 * sun.k;
        self.suns.iter().filter(is_hit).map(|sun| (sun.radiance, self.density_at_sun(sun.k)))
    }
}

impl LightingContext<'_> {
    /// A sample of a randomly chosen light source, seen from a point.
    pub(super) fn sample_light(
        &self,
        point: DVec3,
        choice: [u32; 2],
        u: [u32; 2],
    ) -> Option<LightSample> {
        let sources = &self.sources;
        let last = sources.sampled.len().checked_sub(1)?;
        let index = ((unit(choice[0]) * sources.count()) as usize).min(last);
        match sources.sampled[index] {
            Source::Lamp(lamp) => {
                let Arrival { direction, strength, distance } = lamp::arrival(&lamp, point, u)?;
                let light = SampledLight::Lamp(strength * sources.count());
                Some(LightSample { direction, distance, sphere: None, light })
            }
            Source::Sun(sun) => Some(LightSample {
                direction: TangentFrame::around(sun.toward).to_scene(cone(u, sun.k)),
                distance: f64::INFINITY,
                sphere: None,
                light: SampledLight::Radiance(sun.radiance, sources.density_at_sun(sun.k)),
            }),
            Source::Emitters => self.sample_emitter(point, choice[1], u),
            Source::Sky => {
                let image = self.sky_image?;
                let (direction, density) = image.environment.sample(u, image.rotation);
                let radiance = self.settings.sky.light.radiance(direction);
                Some(LightSample {
                    direction,
                    distance: f64::INFINITY,
                    sphere: None,
                    light: SampledLight::Radiance(radiance, density / sources.count()),
                })
            }
        }
    }

    fn sample_emitter(&self, point: DVec3, choice: u32, u: [u32; 2]) -> Option<LightSample> {
        let (index, _) = self.emitters.pick(choice)?;
        let id = self.emitters.ids()[index];
        let (center, radius) = self.sphere(id);
        let to_center = center - point;
        let distance = to_center.length();
        let k = cone_of_sphere(radius, distance)?;
        let direction = TangentFrame::around(to_center / distance).to_scene(cone(u, k));
        let surface = Surface::Sphere(id);
        // The near side of the sphere, weighted by its opacity; scattered rays find the light of the far side.
        let radiance = self.emission(surface)? * self.opacity(surface);
        let density = self.density_at_emitter(point, id)?;
        Some(LightSample {
            direction,
            distance: lamp::distance_to_sphere(to_center, radius, direction, true),
            sphere: Some(id),
            light: SampledLight::Radiance(radiance, density),
        })
    }

    /// The density with which light sampling at a point chooses each direction towards an emissive sphere; `None` from
    /// inside.
    pub(super) fn density_at_emitter(&self, point: DVec3, id: u32) -> Option<f64> {
        let (center, radius) = self.sphere(id);
        let k = cone_of_sphere(radius, (center - point).length())?;
        Some(self.emitters.probability(id) * cone_density(k) / self.sources.count())
    }

    /// The radiance of the sky, and the density with which light sampling chooses the direction; `None` if it does not
    /// sample the sky.
    pub(super) fn sky(&self, direction: DVec3) -> (DVec3, Option<f64>) {
        let density = self.sky_image.map(|image| {
            image.environment.density(direction, image.rotation) / self.sources.count()
        });
        (self.settings.sky.light.radiance(direction), density)
    }
}
