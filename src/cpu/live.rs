//! Live pictures: visible shares of light are averaged over frames and over neighbouring pixels.

use glam::{DMat3, DVec2, DVec3};

use super::light::live::{LiveLight, LivePixel};
use super::search::Search;
use crate::camera::film::YAxis;
use crate::camera::{CameraKind, CameraVectors, View};
use crate::light::LightKind;
use crate::render::{Integrator, RenderSettings};

/// Number of rays of ambient light for each pixel and frame.
const OCCLUSION_RAYS: u32 = 2;
/// Maximum number of frames in an average, and that of lamps which have just moved.
const MOST: u32 = 64;
const MOST_MOVING: u32 = 4;

/// The frames of a live picture, one after another.
#[derive(Debug, Default)]
pub struct LiveReference {
    known: Vec<Known>,
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
    /// Distances along rays; infinite for misses.
    pub depth: Vec<f64>,
    /// Ids of spheres; `NO_ID` for the ground and for misses.
    pub id: Vec<u32>,
}

#[derive(Debug)]
struct Before {
    kind: CameraKind,
    vectors: CameraVectors,
    lights: Vec<LightKind>,
}

/// What is known of the light at a pixel.
#[derive(Clone, Copy, Debug)]
struct Known {
    shares: DVec2,
    counts: [u32; 2],
    depth: f64,
    id: u32,
}

impl LiveReference {
    /// Renders the next frame of the same spheres. Only the camera and the lamps may differ between frames. `None` if the
    /// integrator is not `studio`.
    pub fn frame(
        &mut self,
        search: Search<'_>,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Option<LiveFrame> {
        let mut settings = settings.clone();
        let Integrator::Studio(studio) = &mut settings.integrator else { return None };
        if let Some(occlusion) = &mut studio.occlusion {
            occlusion.samples = OCCLUSION_RAYS;
        }
        let studio = studio.clone();
        let light = LiveLight::new(search, view, (&settings, &studio), self.count);
        let [width, height] = [view.film.width(), view.film.height()];
        let pixels = (0..height).flat_map(|row| (0..width).map(move |column| [column, row]));
        let found: Vec<LivePixel> = pixels.clone().map(|pixel| light.pixel(pixel)).collect();
        let has_moved = self.before.as_ref().is_some_and(|before| before.lights != light.lights());
        let most = [if has_moved { MOST_MOVING } else { MOST }, MOST];
        let origin = search.scene().origin();
        let with_history = |(pixel, seen): ([u32; 2], &LivePixel)| {
            let ray = view.ray_through_center(pixel);
            let point = ray.map(|ray| ray.at(seen.depth) - origin);
            let known = point.filter(|_| seen.depth.is_finite());
            let known =
                known.and_then(|point| self.found_before(view, pixel, point + origin, seen));
            let counts =
                known.map_or([1; 2], |old| [0, 1].map(|i| (old.counts[i] + 1).min(most[i])));
            let old = known.map_or(DVec2::ONE, |old| old.shares);
            let part = DVec2::new(1.0 / f64::from(counts[0]), 1.0 / f64::from(counts[1]));
            let shares = old + part * (DVec2::from(seen.shares) - old);
            Known { shares, counts, depth: seen.depth, id: seen.id }
        };
        let known: Vec<Known> = pixels.clone().zip(&found).map(with_history).collect();
        let mut frame = LiveFrame::default();
        for (pixel, seen) in pixels.zip(&found) {
            let shares = smoothed(view, pixel, &known, &found);
            let of = |lamps: f64, ambient: f64, steady: f64| {
                steady + shares.x * lamps + shares.y * ambient
            };
            let color =
                seen.steady.color + shares.x * seen.lamps.color + shares.y * seen.ambient.color;
            frame.color.push(color.max(DVec3::ZERO).to_array());
            let alpha = of(seen.lamps.alpha, seen.ambient.alpha, seen.steady.alpha);
            frame.alpha.push(alpha.clamp(0.0, 1.0));
            frame.depth.push(seen.depth);
            frame.id.push(seen.id);
        }
        let (kind, vectors) = (view.camera.kind(), view.camera.vectors());
        self.before = Some(Before { kind, vectors, lights: light.lights().to_vec() });
        self.known = known;
        self.count += 1;
        Some(frame)
    }

    /// What the frame before knew of a point in world space.
    fn found_before(
        &self,
        view: &View<'_>,
        pixel: [u32; 2],
        point: DVec3,
        seen: &LivePixel,
    ) -> Option<Known> {
        let before = self.before.as_ref()?;
        let now = view.camera.vectors();
        let is_parallel = view.camera.kind() == CameraKind::Orthographic;
        let (place, distance) = if before.vectors == now {
            (pixel.map(|number| f64::from(number) + 0.5), seen.depth)
        } else {
            let is_linear = [CameraKind::Pinhole, CameraKind::ThinLens, CameraKind::Orthographic];
            if before.kind != view.camera.kind() || !is_linear.contains(&before.kind) {
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

/// The place in pixels, as column and row, of a relative location on the film.
fn place_of(view: &View<'_>, location: DVec2) -> [f64; 2] {
    let down = match view.film.y_axis() {
        YAxis::Up => -location.y,
        YAxis::Down => location.y,
    };
    let part = |of: f64, side: u32| (of + 1.0) / 2.0 * f64::from(side);
    [part(location.x, view.film.width()), part(down, view.film.height())]
}

/// Index of the pixel at a column and row, if it is in the picture.
fn pixel_number(view: &View<'_>, [column, row]: [f64; 2]) -> Option<usize> {
    let (width, height) = (f64::from(view.film.width()), f64::from(view.film.height()));
    let is_inside = column >= 0.0 && row >= 0.0 && column < width && row < height;
    is_inside.then_some((row * width + column) as usize)
}

/// Height of a pixel at a distance.
fn footprint(view: &View<'_>, distance: f64) -> f64 {
    let CameraVectors { up, forward, .. } = view.camera.vectors();
    let height = 2.0 * up.length() / f64::from(view.film.height());
    match view.camera.kind() {
        CameraKind::Orthographic => height,
        _ => height / forward.length() * distance,
    }
}

/// The mean of the shares of a pixel and of neighbours that show the same surface.
fn smoothed(view: &View<'_>, [x, y]: [u32; 2], known: &[Known], found: &[LivePixel]) -> DVec2 {
    let index = (y * view.film.width() + x) as usize;
    let own = known[index];
    let part =
        DVec2::from(own.counts.map(|count| (1.25 - f64::from(count) / 16.0).clamp(0.0, 1.0)));
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
