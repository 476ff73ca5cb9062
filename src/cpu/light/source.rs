//! Light sampling of the path integrator: a sample of a light source, and the densities of directions.

use glam::DVec3;

use super::context::{LightingContext, Surface};
use super::lamp::{self, Arrival};
use super::maps::{TangentFrame, cone, cone_density, cone_of_sphere};
use super::sources::Source;
use crate::camera::sampling::unit;

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
