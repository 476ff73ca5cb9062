//! Where paths seek light, and how densely.

use glam::DVec3;

use super::context::{LightingContext, rgb};
use super::lamp::{self, Arrival};
use super::maps::{TangentFrame, cone, cone_density, cone_of_sphere, versine};
use super::surface_ray::Surface;
use crate::camera::sampling::unit;
use crate::light::LightKind;
use crate::render::LightSampling;

/// One of the things that light is sought at, each with the same probability.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// A light that chance never meets.
    Lamp(LightKind),
    /// A disk at infinity.
    Sun(Sun),
    /// All emissive spheres.
    Emitters,
    /// The sky's image.
    Sky,
}

/// A light at infinity that chance may meet.
#[derive(Clone, Copy, Debug)]
struct Sun {
    toward: DVec3,
    /// 1 less the cosine of its angular radius.
    k: f64,
    radiance: DVec3,
}

/// Everything that lights a scene, for one way of seeking it.
#[derive(Debug, Default)]
pub(super) struct Sources {
    sought: Vec<Source>,
    suns: Vec<Sun>,
}

/// Light that is sought.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sought {
    pub(super) direction: DVec3,
    /// How far away the light is.
    pub(super) distance: f64,
    /// The emissive sphere at which it is sought.
    pub(super) sphere: Option<u32>,
    pub(super) light: SoughtLight,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum SoughtLight {
    /// What a white surface that faces it sends back, over the probability that it was sought.
    Lamp(DVec3),
    /// Radiance, and the density per steradian by which it was sought.
    Radiance(DVec3, f64),
}

impl Sources {
    /// In the order in which one of them is chosen.
    pub(super) fn new(
        lights: &[LightKind],
        has_emitters: bool,
        has_sky: bool,
        sampling: LightSampling,
    ) -> Self {
        let seeks_all = sampling != LightSampling::Chance;
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
                    sources.sought.extend(seeks_all.then_some(Source::Sun(sun)));
                }
                lamp => sources.sought.push(Source::Lamp(lamp)),
            }
        }
        sources.sought.extend((seeks_all && has_emitters).then_some(Source::Emitters));
        sources.sought.extend((seeks_all && has_sky).then_some(Source::Sky));
        sources
    }

    fn count(&self) -> f64 {
        self.sought.len() as f64
    }

    fn density_at_sun(&self, k: f64) -> f64 {
        cone_density(k) / self.count()
    }

    /// The radiance of each sun that is met in a direction, and the density by which it is sought.
    pub(super) fn suns(&self, direction: DVec3) -> impl Iterator<Item = (DVec3, f64)> {
        // |d − t|² is 2 − 2 cos, and loses nothing where the two are close.
        let is_met = move |sun: &&Sun| (direction - sun.toward).length_squared() <= 2.0 * sun.k;
        self.suns.iter().filter(is_met).map(|sun| (sun.radiance, self.density_at_sun(sun.k)))
    }
}

impl LightingContext<'_> {
    /// Light from a source of chance, seen from a point.
    pub(super) fn seek(&self, point: DVec3, choice: [u32; 2], u: [u32; 2]) -> Option<Sought> {
        let sources = &self.sources;
        let last = sources.sought.len().checked_sub(1)?;
        let index = ((unit(choice[0]) * sources.count()) as usize).min(last);
        match sources.sought[index] {
            Source::Lamp(lamp) => {
                let Arrival { direction, strength, distance } = lamp::arrival(&lamp, point, u)?;
                let light = SoughtLight::Lamp(strength * sources.count());
                Some(Sought { direction, distance, sphere: None, light })
            }
            Source::Sun(sun) => Some(Sought {
                direction: TangentFrame::around(sun.toward).to_scene(cone(u, sun.k)),
                distance: f64::INFINITY,
                sphere: None,
                light: SoughtLight::Radiance(sun.radiance, sources.density_at_sun(sun.k)),
            }),
            Source::Emitters => self.seek_emitter(point, choice[1], u),
            Source::Sky => {
                let image = self.sky_image?;
                let (direction, density) = image.environment.sample(u, image.rotation);
                let radiance = self.settings.sky.light.radiance(direction);
                Some(Sought {
                    direction,
                    distance: f64::INFINITY,
                    sphere: None,
                    light: SoughtLight::Radiance(radiance, density / sources.count()),
                })
            }
        }
    }

    fn seek_emitter(&self, point: DVec3, choice: u32, u: [u32; 2]) -> Option<Sought> {
        let (index, _) = self.emitters.pick(choice)?;
        let id = self.emitters.ids()[index];
        let (center, radius) = self.sphere(id);
        let to_center = center - point;
        let distance = to_center.length();
        let k = cone_of_sphere(radius, distance)?;
        let direction = TangentFrame::around(to_center / distance).to_scene(cone(u, k));
        let surface = Surface::Sphere(id);
        // The wall that is nearer, as often as it is there; chance finds what shines through it.
        let radiance = self.emission(surface)? * self.opacity(surface);
        let density = self.density_at_emitter(point, id)?;
        Some(Sought {
            direction,
            distance: lamp::distance_to_sphere(to_center, radius, direction, true),
            sphere: Some(id),
            light: SoughtLight::Radiance(radiance, density),
        })
    }

    /// The density by which an emissive sphere is sought from a point, in each of its directions; `None` from inside.
    pub(super) fn density_at_emitter(&self, point: DVec3, id: u32) -> Option<f64> {
        let (center, radius) = self.sphere(id);
        let k = cone_of_sphere(radius, (center - point).length())?;
        Some(self.emitters.probability(id) * cone_density(k) / self.sources.count())
    }

    /// The sky's radiance, and the density by which it is sought; `None` if only chance finds it.
    pub(super) fn sky(&self, direction: DVec3) -> (DVec3, Option<f64>) {
        let density = self.sky_image.map(|image| {
            image.environment.density(direction, image.rotation) / self.sources.count()
        });
        (self.settings.sky.light.radiance(direction), density)
    }
}
