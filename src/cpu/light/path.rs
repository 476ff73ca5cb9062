//! The path integrator: paths follow light backwards, from the camera to its sources.

use std::f64::consts::PI;

use glam::DVec3;

use super::bsdf::Bsdf;
use super::context::{LightSample, LightingContext, SampledLight, Surface};
use super::maps::{TangentFrame, rgb};
use super::sample::{Address, Sample};
use super::surface_ray::{Interaction, Occluders, SurfaceRay, is_occluded, nearest};
use crate::camera::sampling::unit;
use crate::geometry::ray::Ray;
use crate::light::LightKind;
use crate::render::{LightSampling, PathTracing};
use crate::scene::material::Material;

/// The purpose of each pair of random numbers at a surface.
#[derive(Clone, Copy)]
enum Purpose {
    Direction = 0,
    Choice = 1,
    Light = 2,
    Source = 3,
    Roulette = 4,
}

/// The way in which a ray was generated.
#[derive(Clone, Copy)]
enum Origin {
    /// Without a random choice of direction, or where light sampling cannot find what the ray hits.
    Only,
    /// By scattering at a point, with a density per steradian.
    Scattered { point: DVec3, density: f64 },
}

/// Computes the light along a ray from the camera.
pub(super) fn follow(
    context: &LightingContext<'_>,
    tracing: &PathTracing,
    surface_ray: SurfaceRay,
    address: Address,
) -> Sample {
    let mut path = Path {
        context,
        tracing,
        address,
        surface_ray,
        found: Sample::default(),
        throughput: DVec3::ONE,
        absorption: DVec3::ZERO,
        origin: Origin::Only,
        has_scattered: false,
    };
    for v in 0..=tracing.max_depth {
        if path.step(v).is_none() {
            break;
        }
    }
    path.found
}

struct Path<'a> {
    context: &'a LightingContext<'a>,
    tracing: &'a PathTracing,
    address: Address,
    surface_ray: SurfaceRay,
    found: Sample,
    throughput: DVec3,
    /// Absorption coefficient of the medium that the ray passes through, per unit length.
    absorption: DVec3,
    origin: Origin,
    has_scattered: bool,
}

impl Path<'_> {
    fn pair(&self, v: u32, purpose: Purpose) -> [u32; 2] {
        self.address.pair(2 + 8 * v + purpose as u32)
    }

    /// Continues the path to its surface number `v`. Returns `None` if the path ends.
    fn step(&mut self, v: u32) -> Option<()> {
        let context = self.context;
        let Some(interaction) = nearest(context, &self.surface_ray) else {
            self.miss();
            return None;
        };
        if self.absorption != DVec3::ZERO {
            self.throughput *= (-self.absorption * interaction.distance).exp();
        }
        let [choice, pass] = self.pair(v, Purpose::Choice).map(unit);
        if pass >= context.opacity(interaction.surface) {
            self.pass(&interaction);
            return Some(());
        }
        if !self.has_scattered {
            self.found.alpha = 1.0;
            self.found.albedo = context.color(interaction.surface).min(DVec3::ONE);
        }
        if let Some(emission) = context.emission(interaction.surface) {
            let Surface::Shape(id) = interaction.surface else { return None };
            let weight = self.weight(|point| self.context.density_at_emitter(point, id));
            self.found.color += self.throughput * emission * weight;
            return None;
        }
        if v == self.tracing.max_depth {
            return None;
        }
        let frame = TangentFrame::around(interaction.normal);
        let out = frame.to_local(-self.surface_ray.ray.direction);
        let bsdf = Bsdf::of(context, &interaction, out)?;
        if bsdf.uses_light_sampling() {
            if !self.has_scattered {
                self.light_from_the_eye(&bsdf, out);
            }
            self.add_sampled_light(v, &interaction, &frame, &bsdf);
        }
        self.scatter(v, &interaction, &frame, &bsdf, choice)?;
        if v >= self.tracing.roulette_from {
            let chance = self.throughput.max_element().min(0.95);
            if unit(self.pair(v, Purpose::Roulette)[0]) >= chance {
                return None;
            }
            self.throughput /= chance;
        }
        Some(())
    }

    /// The weight of light that a scattered ray happens to hit. `density_from` returns the density with which light
    /// sampling at the point of scattering would have chosen the same direction, or `None` if it could not.
    fn weight(&self, density_from: impl FnOnce(DVec3) -> Option<f64>) -> f64 {
        let Origin::Scattered { point, density } = self.origin else { return 1.0 };
        let Some(light_density) = density_from(point) else { return 1.0 };
        match self.tracing.light_sampling {
            LightSampling::Chance => 1.0,
            LightSampling::Direct => 0.0,
            LightSampling::Multiple => density / (density + light_density),
        }
    }

    fn miss(&mut self) {
        let Self { context, has_scattered, .. } = *self;
        let is_background = !has_scattered && !context.settings.sky.is_visible;
        let radiance = if !has_scattered && context.settings.is_transparent {
            DVec3::ZERO
        } else if is_background {
            context.background()
        } else {
            let direction = self.surface_ray.ray.direction;
            let (sky, density) = context.sky(direction);
            let suns = context.sources.suns(direction);
            sky * self.weight(|_| density)
                + suns.map(|(sun, density)| sun * self.weight(|_| Some(density))).sum::<DVec3>()
        };
        self.found.color += self.throughput * radiance;
    }

    /// Passes through a surface as if it were not there.
    fn pass(&mut self, interaction: &Interaction) {
        self.surface_ray.ray.origin = interaction.point;
        self.surface_ray.start = interaction.other_side();
        self.origin = Origin::Only;
        if !interaction.is_outside && self.dielectric(interaction).is_some() {
            self.absorption = DVec3::ZERO;
        }
    }

    /// The absorption coefficient inside a sphere of glass. `None` for other surfaces.
    fn dielectric(&self, interaction: &Interaction) -> Option<DVec3> {
        let Surface::Shape(id) = interaction.surface else { return None };
        match self.context.scene.surface(id).material {
            Material::Dielectric { attenuation_distance, .. } => {
                let color = self.context.color(interaction.surface).max(DVec3::splat(1e-4));
                Some(attenuation_distance.map_or(DVec3::ZERO, |d| -color.ln() / f64::from(d)))
            }
            _ => None,
        }
    }

    fn light_from_the_eye(&mut self, bsdf: &Bsdf, out: DVec3) {
        let Some(response) = bsdf.response(out) else { return };
        for light in &self.context.lights {
            if let LightKind::Head { strength } = light {
                let light = PI * rgb(*strength) * response.value * out.z;
                self.found.color += self.throughput * light;
            }
        }
    }

    fn add_sampled_light(&mut self, v: u32, interaction: &Interaction, frame: &TangentFrame, bsdf: &Bsdf) {
        let (choice, u) = (self.pair(v, Purpose::Source), self.pair(v, Purpose::Light));
        let Some(sampled) = self.context.sample_light(interaction.point, choice, u) else { return };
        let LightSample { direction, distance, sphere, light } = sampled;
        let into = frame.to_local(direction);
        let Some(response) = bsdf.response(into) else { return };
        let light = match light {
            SampledLight::Lamp(strength) => PI * strength,
            SampledLight::Radiance(radiance, density) => match self.tracing.light_sampling {
                LightSampling::Multiple => radiance / (density + response.density),
                _ => radiance / density,
            },
        };
        let light = self.throughput * light * response.value * into.z;
        let ray = Ray { origin: interaction.point, direction };
        let surface_ray = SurfaceRay { ray, start: interaction.this_side() };
        if light != DVec3::ZERO && !is_occluded(self.context, &surface_ray, distance, Occluders::All, sphere) {
            self.found.color += light;
        }
    }

    fn scatter(
        &mut self,
        v: u32,
        interaction: &Interaction,
        frame: &TangentFrame,
        bsdf: &Bsdf,
        choice: f64,
    ) -> Option<()> {
        let scattered = bsdf.scatter(self.pair(v, Purpose::Direction), choice)?;
        self.throughput *= scattered.weight;
        if self.throughput == DVec3::ZERO {
            return None;
        }
        let crosses = scattered.direction.z < 0.0;
        if let Some(absorption) = self.dielectric(interaction).filter(|_| crosses) {
            self.absorption = if interaction.is_outside { absorption } else { DVec3::ZERO };
        }
        let point = interaction.point;
        let ray = Ray { origin: point, direction: frame.to_scene(scattered.direction) };
        let start = if crosses { interaction.other_side() } else { interaction.this_side() };
        self.surface_ray = SurfaceRay { ray, start };
        self.origin = scattered.density.map_or(Origin::Only, |density| Origin::Scattered { point, density });
        self.has_scattered = true;
        Some(())
    }
}
