//! The finished light that a conforming device may have in a picture: after noise is removed and lines are
//! drawn, which read the light and the hits of neighbours.

use glam::DVec3;

use crate::image::NO_ID;
use crate::image::color::luminance;
use crate::image::denoise::REACH;
use crate::image::outline::{self, Outline, Step};
use crate::parallel;
use crate::recording::pixel_at;
use crate::smooth::SmoothPicture;
use crate::verify::denoised::{LegalGuide, Light, filtered, near, product};
use crate::verify::hit::LegalHits;
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::forward::PixelLight;
use crate::verify::normals::LegalNormals;
use crate::verify::rounding::{DIVIDE, FLUSH, Interval, PAD, U, down, gamma, up};

/// The smallest albedo by which light is divided before noise is removed.
const LEAST_ALBEDO: f64 = 0.01_f32 as f64;

/// Light about which nothing is known.
const ANY_LIGHT: Interval = Interval { low: -1e30, high: 1e30 };

/// What the ray through the centre of a pixel hits, if there is a single legal answer.
#[derive(Clone, Copy, Debug)]
struct Spot {
    /// Id of the sphere; `NO_ID` for a miss.
    id: u32,
    depth: Interval,
    normal: DVec3,
    normal_error: f64,
}

impl LitCheck<'_> {
    /// The finished light of some pixels, by their indices, and their alpha; `None` for a pixel about which hardly
    /// anything is known.
    pub(crate) fn finished_light(
        &self,
        indices: &[usize],
        smooth: Option<&SmoothPicture<'_>>,
    ) -> Vec<Option<[Interval; 4]>> {
        let size = self.inputs.size;
        let count = size[0] as usize * size[1] as usize;
        let settings = &self.inputs.settings;
        let lines = settings.studio_parameters().and_then(|studio| studio.outline);
        let is_denoised = settings.sampling.denoise;
        // Light and hits are needed as far as they reach the pixels.
        let of_lines = lines.map_or(0, |lines| outline::reach(lines.width) as u32 + 2);
        let reach = if is_denoised { REACH.max(of_lines) } else { of_lines };
        let needed = near(size, indices.iter().copied(), reach);
        let needed = |pixel: [u32; 2]| needed[pixel[1] as usize * size[0] as usize + pixel[0] as usize];
        let spots = match is_denoised || lines.is_some() {
            true => self.all_pixels(count, |pixel| needed(pixel).then(|| self.spot(pixel)).flatten()),
            false => Vec::new(),
        };
        let mut light: Vec<Option<[Interval; 4]>> = if is_denoised {
            let lights = self.all_pixels(count, |pixel| needed(pixel).then(|| self.legal_pixel(pixel)).flatten());
            let quiet = without_noise(size, &lights, &spots, indices);
            let any_alpha = Interval { low: 0.0, high: 1.0 };
            let alpha = |index: usize| lights[index].as_ref().map_or(any_alpha, |light| light.alpha);
            indices.iter().map(|index| Some(with_alpha(quiet[*index], alpha(*index)))).collect()
        } else if let Some(smooth) = smooth {
            self.smooth_light(smooth, indices)
        } else {
            parallel::map(indices.len(), |at| {
                let light = self.legal_pixel(pixel_at(indices[at], size[0]));
                light.map(|light| with_alpha(light.color, light.alpha))
            })
        };
        if let Some(lines) = lines {
            let covered = covered(size, &spots, &lines);
            for (light, index) in light.iter_mut().zip(indices) {
                *light = light.map(|light| mixed(light, covered[*index], &lines));
            }
        }
        light
    }

    fn all_pixels<T: Send>(&self, count: usize, find: impl Fn([u32; 2]) -> T + Sync) -> Vec<T> {
        parallel::map(count, |index| find(pixel_at(index, self.inputs.size[0])))
    }

    fn spot(&self, pixel: [u32; 2]) -> Option<Spot> {
        let mut hits = LegalHits::default();
        let ray = self.model.ray(pixel).any(&self.model);
        let moved = self.moved(ray.line.origin);
        let ray = ray.moved(moved);
        ray.find(&self.checker.candidates, &mut hits);
        match (&hits.spheres[..], hits.miss) {
            ([], true) => Some(Spot { id: NO_ID, depth: Interval::ZERO, normal: DVec3::ZERO, normal_error: 0.0 }),
            ([hit], false) => {
                let ((None, Some(side)) | (Some(side), None)) = (hit.near, hit.far) else { return None };
                let normals = LegalNormals::new(&ray.line, self.checker.scene.shared_shapes().shape(hit.id), ray.slack);
                let (normal, normal_error) = normals.only()?;
                let Interval { low, high } = ray.depths(side);
                let depth = Interval { low: low - PAD * moved, high: high + PAD * moved };
                Some(Spot { id: hit.id, depth, normal, normal_error })
            }
            _ => None,
        }
    }
}

/// The numbers by which the light of a pixel is divided, which are its albedo, except where that is black.
fn divisors(PixelLight { color, albedo, .. }: &PixelLight) -> [Interval; 3] {
    let has_color = albedo.iter().any(|c| c.low >= LEAST_ALBEDO);
    let may_have_color = albedo.iter().any(|c| c.high >= LEAST_ALBEDO);
    [0, 1, 2].map(|channel| {
        let (albedo, color) = (albedo[channel], color[channel]);
        let own =
            (albedo.high >= LEAST_ALBEDO).then_some(Interval { low: albedo.low.max(LEAST_ALBEDO), high: albedo.high });
        let is_dark = albedo.low < LEAST_ALBEDO;
        let least = (is_dark && may_have_color && color.low < LEAST_ALBEDO)
            .then_some(Interval { low: LEAST_ALBEDO, high: LEAST_ALBEDO });
        let one = (is_dark && (!has_color || color.high >= LEAST_ALBEDO)).then_some(Interval { low: 1.0, high: 1.0 });
        let all = [own, least, one].into_iter().flatten().reduce(Interval::union);
        all.unwrap_or(Interval { low: LEAST_ALBEDO, high: 1.0 })
    })
}

/// The light of some pixels, by their indices, after noise was removed. Other elements mean nothing.
fn without_noise(
    size: [u32; 2],
    lights: &[Option<PixelLight>],
    spots: &[Option<Spot>],
    indices: &[usize],
) -> Vec<[Interval; 3]> {
    let (mut guides, mut divided) = (Vec::with_capacity(spots.len()), Vec::with_capacity(spots.len()));
    for (light, spot) in lights.iter().zip(spots) {
        let unknown = PixelLight {
            color: [ANY_LIGHT; 3],
            alpha: Interval { low: 0.0, high: 1.0 },
            albedo: [Interval { low: 0.0, high: 1.0 + 4.0 * U }; 3],
            variance: Interval { low: 0.0, ..ANY_LIGHT },
        };
        let light = light.as_ref().unwrap_or(&unknown);
        let albedo = divisors(light);
        let off = PAD * (DIVIDE + 2.0 * U);
        let quotient = |i: usize| {
            let (light, albedo) = (light.color[i], albedo[i]);
            let low = light.low / if light.low < 0.0 { albedo.low } else { albedo.high };
            let high = light.high / if light.high < 0.0 { albedo.high } else { albedo.low };
            Interval { low: low - off * low.abs() - FLUSH, high: high + off * high.abs() + FLUSH }
        };
        let [least, most] = [albedo.map(|c| c.low), albedo.map(|c| c.high)].map(luminance);
        let relative = PAD * (gamma(10) + DIVIDE);
        let variance = Interval {
            low: light.variance.low / (most * most) * (1.0 - relative),
            high: light.variance.high / (least * least) * (1.0 + relative) + FLUSH,
        };
        divided.push([quotient(0), quotient(1), quotient(2), variance] as Light);
        let depth = spot.map_or(Interval::ZERO, |spot| spot.depth);
        let middle = 0.5 * (depth.low + depth.high);
        let DVec3 { x, y, z } = spot.map_or(DVec3::ZERO, |spot| spot.normal);
        guides.push(LegalGuide {
            shape: [x, y, z, middle],
            errors: [spot.map_or(0.0, |spot| spot.normal_error), PAD * (depth.high - middle) + U * middle],
            is_miss: spot.map(|spot| spot.id == NO_ID),
            albedo,
        });
    }
    let quiet = filtered(&guides, size, divided, &indices.iter().copied());
    let color = |(light, guide): (&Light, &LegalGuide)| [0, 1, 2].map(|i| product(light[i], guide.albedo[i]));
    quiet.iter().zip(&guides).map(color).collect()
}

/// The least and the greatest strength of the line between two pixels; `None` if it is not known whether there is one.
fn strengths(a: Option<Spot>, b: Option<Spot>, outline: &Outline) -> Option<[f64; 2]> {
    let (a, b) = (a?, b?);
    if a.id == b.id {
        return Some([0.0; 2]);
    }
    if a.id == NO_ID || b.id == NO_ID {
        return Some([1.0; 2]);
    }
    let cosine = a.normal.dot(b.normal);
    let error = 1.01 * (a.normal_error + b.normal_error) + 8.0 * U;
    let sharp = f64::from(outline.angle.cos());
    if cosine + error < sharp {
        return Some([1.0; 2]);
    }
    let jump = Interval {
        low: (a.depth.low - b.depth.high).max(b.depth.low - a.depth.high).max(0.0),
        high: (a.depth.high - b.depth.low).max(b.depth.high - a.depth.low),
    };
    let least =
        [a.depth.low.min(b.depth.low), a.depth.high.min(b.depth.high)].map(|depth| f64::from(outline.depth) * depth);
    let relative = 16.0 * U;
    let strength = |jump: f64, least: f64| {
        if jump > least { ((jump - least) / (f64::from(outline::FADE) * least)).clamp(0.0, 1.0) } else { 0.0 }
    };
    let low = strength(jump.low * (1.0 - relative), least[1] * (1.0 + relative)) * (1.0 - relative);
    let high = (strength(jump.high * (1.0 + relative), least[0] * (1.0 - relative)) * (1.0 + relative)).min(1.0);
    if low <= 0.0 && high > 0.0 {
        return None;
    }
    let may_be_sharp = cosine - error < sharp;
    match (may_be_sharp, low > 0.0) {
        (true, true) => Some([low, 1.0]),
        (true, false) => None,
        (false, _) => Some([low, high]),
    }
}

/// Tells whether the first is nearer than the second, or is all that is hit; `None` if it is not known.
fn is_nearer(a: Option<Spot>, b: Option<Spot>) -> Option<bool> {
    let (a, b) = (a?, b?);
    match (a.id == NO_ID, b.id == NO_ID) {
        (true, _) => Some(false),
        (_, true) => Some(true),
        _ if a.depth.high < b.depth.low => Some(true),
        _ if b.depth.high < a.depth.low => Some(false),
        _ => None,
    }
}

/// The least and the greatest fraction of each pixel that lines cover: 0 and 1 near an edge of which nothing is known.
fn covered(size: [u32; 2], spots: &[Option<Spot>], outline: &Outline) -> Vec<[f64; 2]> {
    let [width, height] = size.map(|side| side as usize);
    let between = |a: usize, b: usize| strengths(spots[a], spots[b], outline);
    let of_edge = |a: usize, b: usize| {
        let full = between(a, b)?;
        if full[1] <= 0.0 {
            return Some(full);
        }
        // What is not known is taken for an end of the thing, and for what hides it.
        let left = [Step::Off, Step::Behind].map(|unknown| {
            let step = |from: usize, to: usize| match (between(from, to), is_nearer(spots[from], spots[to])) {
                (Some([_, high]), _) if high <= 0.0 => Step::Within,
                (Some(_), Some(true)) => Step::Off,
                (Some(_), Some(false)) => Step::Behind,
                _ => unknown,
            };
            let extent = |edge| outline::extent([width, height], edge, outline.width, step);
            let extent = match (is_nearer(spots[a], spots[b]), unknown) {
                (Some(true), _) => extent([a, b]),
                (Some(false), _) => extent([b, a]),
                (None, Step::Off) => extent([a, b]).min(extent([b, a])),
                (None, _) => extent([a, b]).max(extent([b, a])),
            };
            f64::from(outline::left_along(extent, outline.width))
        });
        Some([full[0] * left[0] * (1.0 - 4.0 * U), full[1] * left[1] * (1.0 + 4.0 * U)])
    };
    let share = |which: usize| {
        let outward = [down, up][which];
        outline::coverage_by([width, height], outline.width, |a, b| {
            outward(of_edge(a, b).map_or(0.0, |both| both[which]))
        })
    };
    let (low, high) = (share(0), share(1));
    let off = 8.0 * U;
    let mut covered: Vec<[f64; 2]> = low
        .iter()
        .zip(&high)
        .map(|(low, high)| [f64::from(*low) * (1.0 - off), (f64::from(*high) * (1.0 + off)).min(1.0)])
        .collect();
    let halo = outline::halo(outline.width) + 1;
    for index in 0..spots.len() {
        let [i, j] = [index % width, index / width];
        let is_open = |other: usize| of_edge(index, other).is_none();
        if (i + 1 < width && is_open(index + 1)) || (j + 1 < height && is_open(index + width)) {
            for row in j.saturating_sub(halo)..(j + halo + 1).min(height) {
                covered[row * width + i.saturating_sub(halo)..row * width + (i + halo + 1).min(width)].fill([0.0, 1.0]);
            }
        }
    }
    covered
}

fn with_alpha([r, g, b]: [Interval; 3], alpha: Interval) -> [Interval; 4] {
    [r, g, b, alpha]
}

/// Light over which a line is drawn, and its alpha.
fn mixed(light: [Interval; 4], share: [f64; 2], outline: &Outline) -> [Interval; 4] {
    let [r, g, b] = outline.color.to_array().map(f64::from);
    let line = [r, g, b, 1.0];
    [0, 1, 2, 3].map(|channel| {
        let over = |light: f64, share: f64| light + share * (line[channel] - light);
        let Interval { low, high } = light[channel];
        let least = over(low, share[0]).min(over(low, share[1]));
        let most = over(high, share[0]).max(over(high, share[1]));
        let error = 4.0 * U * (high.abs() + low.abs() + line[channel]) + FLUSH;
        Interval { low: least - error, high: most + error }
    })
}
