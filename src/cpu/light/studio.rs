//! The studio integrator, in which light reaches visible surfaces directly from lights.

use std::f64::consts::PI;

use glam::DVec3;

use super::bsdf::Bsdf;
use super::context::{LightingContext, Plane, Surface};
use super::maps::{self, TangentFrame, luminance, rgb};
use super::sample::{Address, Sample};
use super::sources::{Arrival, arrival, arrival_of_middle};
use super::surface_ray::{Interaction, Occluders, SurfaceRay, is_occluded, nearest};
use crate::geometry::ray::Ray;
use crate::light::LightKind;
use crate::render::Studio;

/// Computes the light along a ray from the camera.
pub(super) fn follow(
    context: &LightingContext<'_>,
    studio: &Studio,
    mut surface_ray: SurfaceRay,
    address: Address,
) -> Sample {
    let mut found = Sample::default();
    let mut clear = 1.0;
    let mut depth = 0.0;
    for m in 0..studio.max_surfaces {
        let Some(interaction) = nearest(context, &surface_ray) else { break };
        depth += interaction.distance;
        let view = VisibleSurface { context, studio, interaction, direction: surface_ray.ray.direction, address, m };
        if let Some(plane) = context.ground.filter(|g| g.is_shadow_catcher)
            && interaction.surface == Surface::Ground
        {
            let shadow = view.shadow(&plane);
            found.alpha += clear * shadow;
            clear *= 1.0 - shadow;
            break;
        }
        if m == 0 {
            found.albedo = context.color(interaction.surface).min(DVec3::ONE);
        }
        let opacity = context.opacity(interaction.surface);
        let weight = clear * opacity;
        clear *= 1.0 - opacity;
        found.alpha += weight;
        let (fade, fade_color) = fading(studio, depth);
        found.color += weight * (fade * fade_color + (1.0 - fade) * view.color());
        if clear == 0.0 {
            break;
        }
        let ray = Ray { origin: interaction.point, ..surface_ray.ray };
        surface_ray = SurfaceRay { ray, start: interaction.other_side() };
    }
    if !context.settings.is_transparent {
        found.color += clear * context.background();
    }
    found
}

/// The fraction of a colour at a distance that depth cueing replaces, and the colour that replaces it.
pub(super) fn fading(studio: &Studio, distance: f64) -> (f64, DVec3) {
    studio.depth_cue.map_or((0.0, DVec3::ZERO), |cue| {
        (((distance - cue.near) / (cue.far - cue.near)).clamp(0.0, 1.0), rgb(cue.color))
    })
}

/// A visible surface.
pub(super) struct VisibleSurface<'a> {
    pub(super) context: &'a LightingContext<'a>,
    pub(super) studio: &'a Studio,
    pub(super) interaction: Interaction,
    /// Direction of the ray that hits the surface.
    pub(super) direction: DVec3,
    pub(super) address: Address,
    /// The number of surfaces in front of this one.
    pub(super) m: u32,
}

impl VisibleSurface<'_> {
    fn color(&self) -> DVec3 {
        let Self { context, studio, interaction, .. } = self;
        if let Some(emission) = context.emission(interaction.surface) {
            return emission;
        }
        let ambient = rgb(studio.ambient) * (1.0 - self.ambient_occlusion());
        let frame = TangentFrame::around(interaction.normal);
        let out = frame.to_local(-self.direction);
        let mut color = context.color(interaction.surface) * ambient;
        let Some(bsdf) = Bsdf::in_studio(context, interaction, out) else { return color };
        for (l, light) in context.lights.iter().enumerate() {
            if let LightKind::Head { strength } = light {
                if let Some(response) = bsdf.response(out) {
                    color += PI * rgb(*strength) * response.value * out.z;
                }
                continue;
            }
            let u = self.address.pair(2 + 4096 * self.m + l as u32);
            let Some(arrival) = arrival(light, interaction.point, u) else { continue };
            let into = frame.to_local(arrival.direction);
            let Some(response) = bsdf.response(into) else { continue };
            let light = PI * arrival.strength * response.value * into.z;
            if light != DVec3::ZERO && !self.has_shadow(&arrival) {
                color += light;
            }
        }
        color
    }

    /// The fraction of ambient light that is occluded.
    pub(super) fn ambient_occlusion(&self) -> f64 {
        let Some(occlusion) = &self.studio.occlusion else { return 0.0 };
        let frame = TangentFrame::around(self.interaction.normal);
        let count = occlusion.samples;
        let t_max = occlusion.radius.unwrap_or(f64::INFINITY);
        let is_hidden = |j: &u32| {
            let dimension = 2 + 4096 * self.m + 4095;
            let u = self.address.part(*j, count).pair(dimension);
            self.is_hidden(frame.to_scene(maps::cosine(u)), t_max)
        };
        (0..count).filter(is_hidden).count() as f64 / f64::from(count)
    }

    fn has_shadow(&self, arrival: &Arrival) -> bool {
        self.studio.shadows && self.is_hidden(arrival.direction, arrival.distance)
    }

    pub(super) fn is_hidden(&self, direction: DVec3, t_max: f64) -> bool {
        let ray = Ray { origin: self.interaction.point, direction };
        let surface_ray = SurfaceRay { ray, start: self.interaction.this_side() };
        is_occluded(self.context, &surface_ray, t_max, Occluders::Opaque, None)
    }

    /// The fraction of light that shadows take from the ground. Each light is weighted by the light from its middle.
    fn shadow(&self, plane: &Plane) -> f64 {
        let mut whole = luminance(rgb(self.studio.ambient));
        let mut missing = whole * self.ambient_occlusion();
        for (l, light) in self.context.lights.iter().enumerate() {
            let point = self.interaction.point;
            let Some(middle) = arrival_of_middle(light, point) else { continue };
            let cosine = middle.direction.dot(plane.normal).max(0.0);
            let weight = luminance(middle.strength) * cosine;
            whole += weight;
            let u = self.address.pair(2 + 4096 * self.m + l as u32);
            let Some(arrival) = arrival(light, point, u) else { continue };
            let is_above = arrival.direction.dot(plane.normal) > 0.0;
            if weight > 0.0 && is_above && self.has_shadow(&arrival) {
                missing += weight;
            }
        }
        if whole > 0.0 { missing / whole } else { 0.0 }
    }
}
