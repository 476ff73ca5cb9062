//! Live pictures: each frame has one ray to a lamp and a few rays of ambient light per pixel. The visible shares of
//! light are averaged over frames and over neighbouring pixels.

use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3};

use super::bsdf::Bsdf;
use super::context::{LightingContext, Surface};
use super::maps::{TangentFrame, luminance, rgb};
use super::sample::Address;
use super::sources::{arrival, arrival_of_middle};
use super::studio::{VisibleSurface, fading};
use super::surface_ray::{Interaction, Start, SurfaceRay, nearest};
use crate::camera::film::YAxis;
use crate::camera::{CameraKind, CameraVectors, View, sampling};
use crate::cpu::search::Search;
use crate::geometry::ray::Ray;
use crate::image::NO_ID;
use crate::light::LightKind;
use crate::render::{Integrator, RenderSettings, Studio};

/// The number of rays of ambient light for each pixel and frame.
const OCCLUSION_RAYS: u32 = 2;
/// The largest number of frames in an average, in general and for lamps that have just moved.
const MOST: u32 = 64;
const MOST_MOVING: u32 = 4;

/// Renders the frames of a live picture, one after another.
#[derive(Debug, Default)]
pub struct LiveReference {
    known: Vec<History>,
    before: Option<Before>,
    count: u32,
}

/// A frame of a live picture: one element for each pixel, row by row.
#[derive(Clone, Debug, Default)]
pub struct LiveFrame {
    /// Linear light, premultiplied by opacity.
    pub color: Vec<[f64; 3]>,
    /// Opacities.
    pub alpha: Vec<f64>,
    /// Distances along rays. Infinite for misses.
    pub depth: Vec<f64>,
    /// Ids of spheres. `NO_ID` for the ground and for misses.
    pub id: Vec<u32>,
}

#[derive(Debug)]
struct Before {
    kind: CameraKind,
    vectors: CameraVectors,
    lights: Vec<LightKind>,
}

/// The averages of light at a pixel over earlier frames.
#[derive(Clone, Copy, Debug)]
struct History {
    shares: DVec2,
    counts: [u32; 2],
    depth: f64,
    id: u32,
}

impl LiveReference {
    /// Renders the next frame of the same spheres. Only the camera and the lamps may differ between frames. Returns
    /// `None` if the integrator is not `studio`.
    pub fn frame(&mut self, search: Search<'_>, view: &View<'_>, settings: &RenderSettings) -> Option<LiveFrame> {
        let mut settings = settings.clone();
        let Integrator::Studio(studio) = &mut settings.integrator else { return None };
        if let Some(occlusion) = &mut studio.occlusion {
            occlusion.samples = OCCLUSION_RAYS;
        }
        let studio = studio.clone();
        let context = LightingContext::new(search, view.camera, &settings);
        let [width, height] = [view.film.width(), view.film.height()];
        let pixels = (0..height).flat_map(|row| (0..width).map(move |column| [column, row]));
        let found: Vec<LivePixel> =
            pixels.clone().map(|pixel| lit(&context, &studio, view, self.count, pixel)).collect();
        let has_moved = self.before.as_ref().is_some_and(|before| before.lights != context.lights);
        let most = [if has_moved { MOST_MOVING } else { MOST }, MOST];
        let origin = search.scene().origin();
        let with_history = |(pixel, seen): ([u32; 2], &LivePixel)| {
            let ray = view.ray_through_center(pixel);
            let point = ray.map(|ray| ray.at(seen.depth) - origin);
            let known = point.filter(|_| seen.depth.is_finite());
            let known = known.and_then(|point| self.found_before(view, pixel, point + origin, seen));
            let counts = known.map_or([1; 2], |old| [0, 1].map(|i| (old.counts[i] + 1).min(most[i])));
            let old = known.map_or(DVec2::ONE, |old| old.shares);
            let part = DVec2::new(1.0 / f64::from(counts[0]), 1.0 / f64::from(counts[1]));
            let shares = old + part * (DVec2::from(seen.shares) - old);
            History { shares, counts, depth: seen.depth, id: seen.id }
        };
        let known: Vec<History> = pixels.clone().zip(&found).map(with_history).collect();
        let mut frame = LiveFrame::default();
        for (pixel, seen) in pixels.zip(&found) {
            let shares = smoothed(view, pixel, &known, &found);
            let color = seen.steady.color + shares.x * seen.lamps.color + shares.y * seen.ambient.color;
            frame.color.push(color.max(DVec3::ZERO).to_array());
            let alpha = seen.steady.alpha + shares.x * seen.lamps.alpha + shares.y * seen.ambient.alpha;
            frame.alpha.push(alpha.clamp(0.0, 1.0));
            frame.depth.push(seen.depth);
            frame.id.push(seen.id);
        }
        let (kind, vectors) = (view.camera.kind(), view.camera.vectors());
        self.before = Some(Before { kind, vectors, lights: context.lights });
        self.known = known;
        self.count += 1;
        Some(frame)
    }

    /// The history of the previous frame at a point in world space.
    fn found_before(&self, view: &View<'_>, pixel: [u32; 2], point: DVec3, seen: &LivePixel) -> Option<History> {
        let before = self.before.as_ref()?;
        let now = view.camera.vectors();
        let is_parallel = view.camera.kind() == CameraKind::Orthographic;
        let (place, distance) = if before.vectors == now {
            (pixel.map(|number| f64::from(number) + 0.5), seen.depth)
        } else {
            if before.kind != view.camera.kind() || !before.kind.is_linear() {
                return None;
            }
            let CameraVectors { origin, right, up, forward, .. } = before.vectors;
            let from_eye = point - origin;
            // Multiples of right, up and forward.
            let parts = DMat3::from_cols(right, up, forward).inverse() * from_eye;
            let scale = if is_parallel { 1.0 } else { parts.z };
            let distance = if is_parallel { parts.z } else { from_eye.length() };
            if parts.z <= 0.0 {
                return None;
            }
            (place_of(view, DVec2::new(parts.x, parts.y) / scale), distance)
        };
        let at = pixel_number(view, place.map(f64::floor))?;
        let old = *self.known.get(at)?;
        let limit = 8.0 * footprint(view, distance) + 1e-5 * distance;
        (old.id == seen.id && (old.depth - distance).abs() <= limit).then_some(old)
    }
}

/// The column and row, in pixels, of a relative location on the film.
fn place_of(view: &View<'_>, location: DVec2) -> [f64; 2] {
    let down = match view.film.y_axis() {
        YAxis::Up => -location.y,
        YAxis::Down => location.y,
    };
    let part = |of: f64, side: u32| (of + 1.0) / 2.0 * f64::from(side);
    [part(location.x, view.film.width()), part(down, view.film.height())]
}

/// The index of the pixel at a column and row, if it is in the picture.
fn pixel_number(view: &View<'_>, [column, row]: [f64; 2]) -> Option<usize> {
    let (width, height) = (f64::from(view.film.width()), f64::from(view.film.height()));
    let is_inside = column >= 0.0 && row >= 0.0 && column < width && row < height;
    is_inside.then_some((row * width + column) as usize)
}

/// The height of a pixel at a distance.
fn footprint(view: &View<'_>, distance: f64) -> f64 {
    let CameraVectors { up, forward, .. } = view.camera.vectors();
    let height = 2.0 * up.length() / f64::from(view.film.height());
    match view.camera.kind() {
        CameraKind::Orthographic => height,
        _ => height / forward.length() * distance,
    }
}

/// The mean of the shares of a pixel and of those neighbours that show the same surface.
fn smoothed(view: &View<'_>, [x, y]: [u32; 2], known: &[History], found: &[LivePixel]) -> DVec2 {
    let index = (y * view.film.width() + x) as usize;
    let own = known[index];
    let part = DVec2::from(own.counts.map(|count| (1.25 - f64::from(count) / 16.0).clamp(0.0, 1.0)));
    let (mut sum, mut total) = (own.shares, DVec2::ONE);
    for (across, down) in (-1..=1).flat_map(|down| (-1..=1).map(move |across| (across, down))) {
        let at = [f64::from(x) + 2.0 * f64::from(across), f64::from(y) + 2.0 * f64::from(down)];
        let Some(there) = pixel_number(view, at).filter(|there| *there != index) else { continue };
        let other = known[there];
        let limit = 12.0 * footprint(view, own.depth) + 1e-5 * own.depth;
        if (own.depth - other.depth).abs() <= limit {
            let cosine = found[index].normal.dot(found[there].normal);
            let weight = part * (4.0 * cosine - 3.0).clamp(0.0, 1.0);
            sum += weight * other.shares;
            total += weight;
        }
    }
    sum / total
}

/// A colour, premultiplied by opacity, and the opacity.
#[derive(Clone, Copy, Debug, Default)]
struct Shade {
    color: DVec3,
    alpha: f64,
}

/// The light of a pixel: `steady`, plus `lamps` and `ambient` times their visible shares.
#[derive(Clone, Copy, Debug, Default)]
struct LivePixel {
    steady: Shade,
    lamps: Shade,
    ambient: Shade,
    /// The visible shares of lamps and of ambient light, from one ray and from a few rays.
    shares: [f64; 2],
    normal: DVec3,
    /// The distance along the ray. Infinite for a miss.
    depth: f64,
    id: u32,
}

/// Lights the surface that a pixel shows. The number of the frame determines the random numbers.
fn lit(context: &LightingContext<'_>, studio: &Studio, view: &View<'_>, number: u32, pixel: [u32; 2]) -> LivePixel {
    let is_transparent = context.settings.is_transparent;
    let behind = if is_transparent { DVec3::ZERO } else { context.background() };
    let steady = Shade { color: behind, alpha: 0.0 };
    let nothing = LivePixel { steady, shares: [1.0; 2], depth: f64::INFINITY, id: NO_ID, ..LivePixel::default() };
    let Some(ray) = view.ray_through_center(pixel) else { return nothing };
    let ray = Ray { origin: ray.origin - context.scene.origin(), ..ray };
    let Some(interaction) = nearest(context, &SurfaceRay { ray, start: Start::Free }) else {
        return nothing;
    };
    let address = Address::new(pixel, number, context.settings.sampling.seed);
    let direction = ray.direction;
    let seen = VisibleSurface { context, studio, interaction, direction, address, m: 0 };
    let id = match interaction.surface {
        Surface::Shape(id) => id,
        Surface::Ground => NO_ID,
    };
    let Interaction { normal, distance: depth, .. } = interaction;
    let found = LivePixel { normal, depth, id, ..nothing };
    match context.ground {
        Some(plane) if plane.is_shadow_catcher && interaction.surface == Surface::Ground => seen.caught(found, behind),
        _ => seen.shaded(found),
    }
}

impl VisibleSurface<'_> {
    fn shaded(&self, mut found: LivePixel) -> LivePixel {
        let Self { context, studio, interaction, .. } = self;
        let (fade, fade_color) = fading(studio, interaction.distance);
        let weight = 1.0 - fade;
        found.steady = Shade { color: fade * fade_color, alpha: 1.0 };
        if let Some(emission) = context.emission(interaction.surface) {
            found.steady.color += weight * emission;
            return found;
        }
        let open = weight * context.color(interaction.surface) * rgb(studio.ambient);
        match studio.occlusion {
            None => found.steady.color += open,
            Some(_) => found.ambient.color = open,
        }
        found.shares[1] = 1.0 - self.ambient_occlusion();
        let frame = TangentFrame::around(interaction.normal);
        let out = frame.to_local(-self.direction);
        let Some(bsdf) = Bsdf::in_studio(context, interaction, out) else { return found };
        let mut weights = Vec::new();
        for light in &context.lights {
            let (into, strength) = match light {
                LightKind::Head { strength } => (out, rgb(*strength)),
                _ => match arrival_of_middle(light, interaction.point) {
                    Some(middle) => (frame.to_local(middle.direction), middle.strength),
                    None => (DVec3::NEG_Z, DVec3::ZERO),
                },
            };
            let response = bsdf.response(into).map_or(DVec3::ZERO, |response| response.value);
            let color = weight * PI * strength * response * into.z.max(0.0);
            let is_head = matches!(light, LightKind::Head { .. });
            let is_cast = into.z > 0.0 && !is_head && studio.shadows;
            let to = if is_cast { &mut found.lamps } else { &mut found.steady };
            to.color += color;
            weights.push(if is_cast { luminance(color) } else { 0.0 });
        }
        found.shares[0] = self.lamps_share(&weights);
        found
    }

    /// Shades a ground that shows only shadows: the light that would be missing without lamps and ambient light.
    fn caught(&self, mut found: LivePixel, behind: DVec3) -> LivePixel {
        let Self { context, studio, interaction, .. } = self;
        let ambient = luminance(rgb(studio.ambient));
        let middle = |light| {
            let middle = arrival_of_middle(light, interaction.point)?;
            Some(luminance(middle.strength) * middle.direction.dot(interaction.normal).max(0.0))
        };
        let lights: Vec<f64> = context.lights.iter().map(|light| middle(light).unwrap_or(0.0)).collect();
        let whole = ambient + lights.iter().sum::<f64>();
        let share = |light: f64| if whole > 0.0 { light / whole } else { 0.0 };
        let without = |alpha: f64| Shade { color: behind * -alpha, alpha };
        let cast = if studio.shadows { lights } else { Vec::new() };
        let lamps = without(share(cast.iter().sum()));
        let ambient = without(if studio.occlusion.is_some() { share(ambient) } else { 0.0 });
        found.steady.color += lamps.color + ambient.color;
        found.steady.alpha += lamps.alpha + ambient.alpha;
        found.lamps = Shade { color: -lamps.color, alpha: -lamps.alpha };
        found.ambient = Shade { color: -ambient.color, alpha: -ambient.alpha };
        found.shares = [self.lamps_share(&cast), 1.0 - self.ambient_occlusion()];
        found
    }

    /// Whether one lamp, chosen at random with these weights, is visible.
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
        let arrival = arrival(&self.context.lights[light], self.interaction.point, u);
        let is_seen = arrival.is_some_and(|arrival| {
            arrival.direction.dot(self.interaction.normal) > 0.0 && !self.is_hidden(arrival.direction, arrival.distance)
        });
        f64::from(u8::from(is_seen))
    }
}
