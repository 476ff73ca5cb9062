//! The lighting context: all data that is the same for every ray of a picture, in the scene's frame. Also the light
//! sampling of the path integrator: samples of light sources, and the densities of directions.

use glam::DVec3;

use super::maps::{TangentFrame, cone, cone_density, cone_of_sphere, rgb};
use super::sources::{Arrival, Source, Sources, arrival, distance_to_sphere};
use crate::camera::Camera;
use crate::camera::sampling::unit as fraction;
use crate::cpu::search::Search;
use crate::geometry::math::unit;
use crate::light::emitters::Emitters;
use crate::light::energy::EnergyTables;
use crate::light::environment::Environment;
use crate::light::{LightKind, SkyLight};
use crate::render::{Integrator, RenderSettings};
use crate::scene::Scene;
use crate::scene::material::Material;

#[derive(Debug)]
pub(super) struct LightingContext<'a> {
    /// The way in which rays find spheres.
    pub(super) search: Search<'a>,
    pub(super) scene: &'a Scene,
    pub(super) settings: &'a RenderSettings,
    pub(super) ground: Option<Plane>,
    /// Lights of the settings in input order.
    pub(super) lights: Vec<LightKind>,
    pub(super) emitters: Emitters,
    pub(super) sky_image: Option<SkyImage<'a>>,
    pub(super) sources: Sources,
    energies: EnergyTables,
}

/// A surface that a ray can hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Surface {
    /// The sphere with this index.
    Shape(u32),
    /// The ground.
    Ground,
}

/// The ground plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) point: DVec3,
    /// Unit normal.
    pub(super) normal: DVec3,
    pub(super) color: DVec3,
    pub(super) is_shadow_catcher: bool,
}

/// An image of the sky that is not black.
#[derive(Clone, Copy, Debug)]
pub(super) struct SkyImage<'a> {
    pub(super) environment: &'a Environment,
    pub(super) rotation: [f32; 2],
}

impl<'a> LightingContext<'a> {
    pub(super) fn new(search: Search<'a>, camera: &dyn Camera, settings: &'a RenderSettings) -> Self {
        let scene = search.scene();
        let origin = scene.origin();
        let vectors = camera.vectors();
        let lights = settings.lights.iter().filter_map(|light| light.in_view(&vectors));
        let lights = lights.map(|light| match light {
            LightKind::Point { position, intensity } => LightKind::Point { position: position - origin, intensity },
            LightKind::Sphere { center, radius, radiance } => {
                LightKind::Sphere { center: center - origin, radius, radiance }
            }
            anywhere => anywhere,
        });
        let ground = settings.ground.and_then(|ground| {
            Some(Plane {
                point: ground.point - origin,
                normal: unit(ground.normal)?,
                color: rgb(ground.color),
                is_shadow_catcher: ground.is_shadow_catcher,
            })
        });
        let sky_image = match &settings.sky.light {
            light @ SkyLight::Image { environment, rotation, .. } if light.has_lit_image() => {
                Some(SkyImage { environment, rotation: Environment::rotation(*rotation) })
            }
            _ => None,
        };
        let (lights, emitters): (Vec<_>, _) = (lights.collect(), Emitters::of(scene));
        let sources = match &settings.integrator {
            Integrator::Primary(_) | Integrator::Studio(_) => Sources::default(),
            Integrator::Path(tracing) => {
                let (has_emitters, has_sky) = (!emitters.is_empty(), sky_image.is_some());
                Sources::new(&lights, has_emitters, has_sky, tracing.light_sampling)
            }
        };
        Self {
            search,
            scene,
            settings,
            ground,
            lights,
            emitters,
            sky_image,
            sources,
            energies: EnergyTables::of(scene.appearance().surfaces()),
        }
    }

    /// Centre and radius of a sphere in the scene's frame.
    pub(super) fn sphere(&self, id: u32) -> (DVec3, f64) {
        let [x, y, z, radius] = self.scene.spheres()[id as usize].map(f64::from);
        (DVec3::new(x, y, z), radius)
    }

    pub(super) fn color(&self, surface: Surface) -> DVec3 {
        match surface {
            Surface::Shape(id) => rgb(self.scene.color(id)),
            Surface::Ground => self.ground.map_or(DVec3::ZERO, |ground| ground.color),
        }
    }

    pub(super) fn opacity(&self, surface: Surface) -> f64 {
        match surface {
            Surface::Shape(id) => self.scene.surface(id).opacity.into(),
            Surface::Ground => 1.0,
        }
    }

    /// The radiance that a surface emits. `None` if it is not emissive.
    pub(super) fn emission(&self, surface: Surface) -> Option<DVec3> {
        let Surface::Shape(id) = surface else { return None };
        match self.scene.surface(id).material {
            Material::Emissive { strength } => Some(self.color(surface) * f64::from(strength)),
            _ => None,
        }
    }

    /// The entries of the energy table of a sphere's material, without the first `skip` ones.
    pub(super) fn energy(&self, id: u32, skip: usize) -> &[f32] {
        let surface = self.scene.checked_appearance().surface_index(id) as usize;
        let start = self.energies.starts[surface].map_or(0, |start| start as usize);
        self.energies.entries.get(start + skip..).unwrap_or_default()
    }

    pub(super) fn background(&self) -> DVec3 {
        rgb(self.settings.background)
    }
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
    /// For a light that scattered rays cannot hit, the radiance that a white surface facing it would reflect, divided
    /// by the probability of the choice.
    Lamp(DVec3),
    /// For other lights, radiance, and the density per steradian with which the direction was sampled.
    Radiance(DVec3, f64),
}

impl LightingContext<'_> {
    /// Samples a randomly chosen light source, seen from a point.
    pub(super) fn sample_light(&self, point: DVec3, choice: [u32; 2], u: [u32; 2]) -> Option<LightSample> {
        let sources = &self.sources;
        let last = sources.sampled.len().checked_sub(1)?;
        let index = ((fraction(choice[0]) * sources.count()) as usize).min(last);
        let at_infinity = |direction, radiance, density| {
            let light = SampledLight::Radiance(radiance, density);
            Some(LightSample { direction, distance: f64::INFINITY, sphere: None, light })
        };
        match sources.sampled[index] {
            Source::Lamp(lamp) => {
                let Arrival { direction, strength, distance } = arrival(&lamp, point, u)?;
                let light = SampledLight::Lamp(strength * sources.count());
                Some(LightSample { direction, distance, sphere: None, light })
            }
            Source::Sun(sun) => {
                let direction = TangentFrame::around(sun.toward).to_scene(cone(u, sun.k));
                at_infinity(direction, sun.radiance, sources.density_at_sun(sun.k))
            }
            Source::Emitters => self.sample_emitter(point, choice[1], u),
            Source::Sky => {
                let image = self.sky_image?;
                let (direction, density) = image.environment.sample(u, image.rotation);
                at_infinity(direction, self.settings.sky.light.radiance(direction), density / sources.count())
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
        let surface = Surface::Shape(id);
        // The near side of the sphere, weighted by its opacity. Scattered rays find the light of the far side.
        let radiance = self.emission(surface)? * self.opacity(surface);
        let density = self.density_at_emitter(point, id)?;
        Some(LightSample {
            direction,
            distance: distance_to_sphere(to_center, radius, direction, true),
            sphere: Some(id),
            light: SampledLight::Radiance(radiance, density),
        })
    }

    /// The density with which light sampling at a point chooses each direction towards an emissive sphere. `None` from
    /// inside the sphere.
    pub(super) fn density_at_emitter(&self, point: DVec3, id: u32) -> Option<f64> {
        let (center, radius) = self.sphere(id);
        let k = cone_of_sphere(radius, (center - point).length())?;
        Some(self.emitters.probability(id) * cone_density(k) / self.sources.count())
    }

    /// The radiance of the sky, and the density with which light sampling chooses the direction. The density is `None`
    /// if light sampling does not sample the sky.
    pub(super) fn sky(&self, direction: DVec3) -> (DVec3, Option<f64>) {
        let density =
            self.sky_image.map(|image| image.environment.density(direction, image.rotation) / self.sources.count());
        (self.settings.sky.light.radiance(direction), density)
    }
}
