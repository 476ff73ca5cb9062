//! What a pixel of a live picture shows, with one ray to a lamp and a few of ambient light.

use std::f64::consts::PI;

use glam::DVec3;

use super::bsdf::Bsdf;
use super::color::{luminance, rgb};
use super::context::{LightingContext, Surface};
use super::lamp;
use super::maps::{self, TangentFrame};
use super::sample::Address;
use super::surface_ray::{Hiding, Interaction, Start, SurfaceRay, is_occluded, nearest};
use crate::camera::View;
use crate::camera::sampling;
use crate::cpu::search::Search;
use crate::geometry::ray::Ray;
use crate::image::NO_ID;
use crate::light::LightKind;
use crate::render::{RenderSettings, Studio};

/// A colour, premultiplied by opacity, and the opacity.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::cpu) struct Shade {
    pub(in crate::cpu) color: DVec3,
    pub(in crate::cpu) alpha: f64,
}

/// What a pixel shows: `steady`, plus `lamps` and `ambient` times their visible shares.
#[derive(Clone, Copy, Debug)]
pub(in crate::cpu) struct LivePixel {
    pub(in crate::cpu) steady: Shade,
    pub(in crate::cpu) lamps: Shade,
    pub(in crate::cpu) ambient: Shade,
    /// The visible shares of lamps and of ambient light, from one ray and from a few.
    pub(in crate::cpu) shares: [f64; 2],
    pub(in crate::cpu) normal: DVec3,
    /// Distance along the ray; infinite for a miss.
    pub(in crate::cpu) depth: f64,
    pub(in crate::cpu) id: u32,
}

/// Lights the surfaces of a frame.
pub(in crate::cpu) struct LiveLight<'a> {
    context: LightingContext<'a>,
    studio: &'a Studio,
    view: View<'a>,
    number: u32,
}

impl<'a> LiveLight<'a> {
    /// `number` is that of the frame, and determines the random numbers.
    pub(in crate::cpu) fn new(
        search: Search<'a>,
        view: &View<'a>,
        (settings, studio): (&'a RenderSettings, &'a Studio),
        number: u32,
    ) -> Self {
        Self {
            context: LightingContext::new(search, view.camera, settings),
            studio,
            view: *view,
            number,
        }
    }

    /// The lights of the settings, in the scene's frame.
    pub(in crate::cpu) fn lights(&self) -> &[LightKind] {
        &self.context.lights
    }

    pub(in crate::cpu) fn pixel(&self, pixel: [u32; 2]) -> LivePixel {
        let Self { context, studio, view, number } = self;
        let is_transparent = context.settings.is_transparent;
        let behind = if is_transparent { DVec3::ZERO } else { context.background() };
        let steady = Shade { color: behind, alpha: 0.0 };
        let nothing = LivePixel {
            steady,
            lamps: Shade::default(),
            ambient: Shade::default(),
            shares: [1.0; 2],
            normal: DVec3::ZERO,
            depth: f64::INFINITY,
            id: NO_ID,
        };
        let Some(ray) = view.ray_through_center(pixel) else { return nothing };
        let ray = Ray { origin: ray.origin - context.scene.origin(), ..ray };
        let Some(seen) = nearest(context, &SurfaceRay { ray, start: Start::Free }) else {
            return nothing;
        };
        let address = Address::new(pixel, *number, context.settings.sampling.seed);
        let lit = LitSurface { context, studio, seen, direction: ray.direction, address };
        let id = match seen.surface {
            Surface::Sphere(id) => id,
            Surface::Ground => NO_ID,
        };
        let found = LivePixel { normal: seen.normal, depth: seen.distance, id, ..nothing };
        match context.ground {
            Some(plane) if plane.is_shadow_catcher && seen.surface == Surface::Ground => {
                lit.caught(found, behind)
            }
            _ => lit.shaded(found),
        }
    }
}

struct LitSurface<'a> {
    context: &'a LightingContext<'a>,
    studio: &'a Studio,
    seen: Interaction,
    /// Direction of the camera's ray.
    direction: DVec3,
    address: Address,
}

impl LitSurface<'_> {
    fn shaded(&self, mut found: LivePixel) -> LivePixel {
        let Self { context, studio, seen, .. } = self;
        let (fade, fade_color) = studio.depth_cue.map_or((0.0, DVec3::ZERO), |cue| {
            (((seen.distance - cue.near) / (cue.far - cue.near)).clamp(0.0, 1.0), rgb(cue.color))
        });
        let weight = 1.0 - fade;
        found.steady = Shade { color: fade * fade_color, alpha: 1.0 };
        if let Some(emission) = context.emission(seen.surface) {
            found.steady.color += weight * emission;
            return found;
        }
        let open = weight * context.color(seen.surface) * rgb(studio.ambient);
        match studio.occlusion {
            None => found.steady.color += open,
            Some(_) => found.ambient.color = open,
        }
        found.shares[1] = self.open_share();
        let frame = TangentFrame::around(seen.normal);
        let out = frame.to_local(-self.direction);
        let Some(bsdf) = Bsdf::in_studio(context, seen, out) else { return found };
        let mut weights = Vec::new();
        for light in &context.lights {
            let (into, strength) = match light {
                LightKind::Head { strength } => (out, rgb(*strength)),
                _ => match lamp::arrival_of_middle(light, seen.point) {
                    Some(middle) => (frame.to_local(middle.direction), middle.strength),
                    None => (DVec3::NEG_Z, DVec3::ZERO),
                },
            };
            let response = bsdf.response(into).map_or(DVec3::ZERO, |response| response.value);
            let color = weight * PI * strength * response * into.z.max(0.0);
            let is_head = matches!(light, LightKind::Head { .. });
            let is_cast = into.z > 0.0 && !is_head && studio.has_shadows;
            let to = if is_cast { &mut found.lamps } else { &mut found.steady };
            to.color += color;
            weights.push(if is_cast { luminance(color) } else { 0.0 });
        }
        found.shares[0] = self.lamps_share(&weights);
        found
    }

    /// A ground on which only shadows are seen: what would be missing if all lamps were hidden, and all ambient light.
    fn caught(&self, mut found: LivePixel, behind: DVec3) -> LivePixel {
        let Self { context, studio, seen, .. } = self;
        let ambient = luminance(rgb(studio.ambient));
        let middle = |light| {
            let middle = lamp::arrival_of_middle(light, seen.point)?;
            Some(luminance(middle.strength) * middle.direction.dot(seen.normal).max(0.0))
        };
        let lights: Vec<f64> =
            context.lights.iter().map(|light| middle(light).unwrap_or(0.0)).collect();
        let whole = ambient + lights.iter().sum::<f64>();
        let share = |light: f64| if whole > 0.0 { light / whole } else { 0.0 };
        let without = |alpha: f64| Shade { color: behind * -alpha, alpha };
        let cast = if studio.has_shadows { lights } else { Vec::new() };
        let lamps = without(share(cast.iter().sum()));
        let ambient = without(if studio.occlusion.is_some() { share(ambient) } else { 0.0 });
        found.steady.color += lamps.color + ambient.color;
        found.steady.alpha += lamps.alpha + ambient.alpha;
        found.lamps = Shade { color: -lamps.color, alpha: -lamps.alpha };
        found.ambient = Shade { color: -ambient.color, alpha: -ambient.alpha };
        found.shares = [self.lamps_share(&cast), self.open_share()];
        found
    }

    /// Whether one lamp, chosen by these weights, is visible.
    fn lamps_share(&self, weights: &[f64]) -> f64 {
        let mut u = sampling::unit(self.address.pair(2 + 4094)[0]);
        let (mut total, mut chosen) = (0.0, None);
        for (light, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
            total += weight;
            let share = weight / total;
            if u < share {
                chosen = Some(light);
                u /= share;
            } else {
                u = (u - share) / (1.0 - share);
            }
        }
        let Some(light) = chosen else { return 1.0 };
        let u = self.address.pair(2 + light as u32);
        let arrival = lamp::arrival(&self.context.lights[light], self.seen.point, u);
        let is_seen = arrival.is_some_and(|arrival| {
            arrival.direction.dot(self.seen.normal) > 0.0
                && !self.is_hidden(arrival.direction, arrival.distance)
        });
        f64::from(u8::from(is_seen))
    }

    fn open_share(&self) -> f64 {
        let Some(occlusion) = self.studio.occlusion else { return 1.0 };
        let frame = TangentFrame::around(self.seen.normal);
        let is_open = |j: &u32| {
            let u = self.address.part(*j, occlusion.samples).pair(2 + 4095);
            let reach = occlusion.radius.unwrap_or(f64::INFINITY);
            !self.is_hidden(frame.to_scene(maps::cosine(u)), reach)
        };
        (0..occlusion.samples).filter(is_open).count() as f64 / f64::from(occlusion.samples)
    }

    fn is_hidden(&self, direction: DVec3, t_max: f64) -> bool {
        let ray = Ray { origin: self.seen.point, direction };
        let surface_ray = SurfaceRay { ray, start: self.seen.this_side() };
        is_occluded(self.context, &surface_ray, t_max, Hiding::Opaque, None)
    }
}
