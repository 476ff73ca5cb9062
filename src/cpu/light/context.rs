//! The lighting context: all data that is the same for every ray of a picture, in the scene's frame.

use glam::DVec3;

use super::color::rgb;
use super::sources::Sources;
use crate::camera::Camera;
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
    /// How rays find spheres.
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
    Sphere(u32),
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

/// An image of the sky, which is not black.
#[derive(Clone, Copy, Debug)]
pub(super) struct SkyImage<'a> {
    pub(super) environment: &'a Environment,
    pub(super) rotation: [f32; 2],
}

impl<'a> LightingContext<'a> {
    pub(super) fn new(
        search: Search<'a>,
        camera: &dyn Camera,
        settings: &'a RenderSettings,
    ) -> Self {
        let scene = search.scene();
        let origin = scene.origin();
        let lights = settings.lights.iter().filter_map(|light| light.in_world(camera));
        let lights = lights.map(|light| match light {
            LightKind::Point { position, intensity } => {
                LightKind::Point { position: position - origin, intensity }
            }
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
            SkyLight::Image { environment, strength, rotation }
                if *strength > 0.0 && environment.has_light() =>
            {
                let rotation = Environment::rotation(*rotation);
                Some(SkyImage { environment, rotation })
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
            Surface::Sphere(id) => rgb(self.scene.color(id)),
            Surface::Ground => self.ground.map_or(DVec3::ZERO, |ground| ground.color),
        }
    }

    pub(super) fn opacity(&self, surface: Surface) -> f64 {
        match surface {
            Surface::Sphere(id) => self.scene.surface(id).opacity.into(),
            Surface::Ground => 1.0,
        }
    }

    /// The radiance that a surface emits; `None` if it is not emissive.
    pub(super) fn emission(&self, surface: Surface) -> Option<DVec3> {
        let Surface::Sphere(id) = surface else { return None };
        match self.scene.surface(id).material {
            Material::Emissive { strength } => Some(self.color(surface) * f64::from(strength)),
            _ => None,
        }
    }

    /// The energy table of a sphere's material, starting `skip` entries after its beginning.
    pub(super) fn energy(&self, id: u32, skip: usize) -> &[f32] {
        let surface = self.scene.checked_appearance().surface_index(id) as usize;
        let start = self.energies.starts()[surface].map_or(0, |start| start as usize);
        self.energies.entries().get(start + skip..).unwrap_or_default()
    }

    pub(super) fn background(&self) -> DVec3 {
        rgb(self.settings.background)
    }
}
