//! The spots of a smooth picture: places on spheres that are lit, found from the ids that pixels show.

use glam::{DVec2, DVec3};

use crate::camera::film::Film;
use crate::camera::sampling::{pair, pixel_seed};
use crate::camera::{View, filter};
use crate::geometry::ray::Ray;
use crate::image::NO_ID;
use crate::render::{RenderSettings, Sampling};

/// A place on a sphere that a pixel shows, in the scene's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) position: DVec3,
    /// Unit normal on the side of the camera.
    pub(super) normal: DVec3,
    /// Unit vector towards the camera.
    pub(super) out: DVec3,
    /// Distance from the start of the camera's ray.
    pub(super) distance: f64,
    /// Width of the pixel at that distance.
    pub(super) width: f64,
    pub(super) id: u32,
    /// The part of the pixel that shows the sphere.
    pub(super) share: f32,
}

/// The spots of some pixels.
#[derive(Default)]
pub(super) struct Row {
    /// The spots, pixel by pixel.
    pub(super) all: Vec<Spot>,
    /// The number of spots of each pixel.
    pub(super) counts: Vec<u8>,
}

/// Finds the spots of a picture.
pub(super) struct Finder<'a> {
    spheres: &'a [[f32; 4]],
    origin: DVec3,
    view: View<'a>,
    /// The pixels with ids.
    around: Film,
    /// The fixed places of rays in pixels at edges, counted from the centre.
    offsets: Vec<DVec2>,
    /// True if spots have the width of their pixels, which shadows need.
    with_widths: bool,
}

/// The hits of a pixel's rays on one sphere.
#[derive(Clone, Copy)]
struct Hits {
    id: u32,
    count: u32,
    /// Sums over the hits.
    position: DVec3,
    direction: DVec3,
    distance: f64,
}

/// The most spheres that a pixel and its neighbours show.
const MOST: usize = 9;

impl<'a> Finder<'a> {
    pub(super) fn new(spheres: &'a [[f32; 4]], origin: DVec3, view: &View<'a>, settings: &RenderSettings) -> Self {
        let sampling = &settings.sampling;
        let table = sampling.filter.offset_table();
        let seed = pixel_seed([0, 0], sampling.seed);
        let offset = |k| DVec2::from(pair(seed, k, 0).map(|u| filter::offset(&table, u)));
        // A single ray is at the centre.
        let offsets = (0..rays(sampling)).filter(|_| sampling.samples > 1).map(offset).collect();
        let with_widths = settings.studio_parameters().is_some_and(|studio| studio.shadows);
        Self { spheres, origin, view: *view, around: with_neighbors(&view.film), offsets, with_widths }
    }

    /// The spots of a row.
    pub(super) fn row(&self, ids: &[u32], row: u32) -> Row {
        let film = &self.view.film;
        let mut found = Row::default();
        let width = self.around.width() as usize;
        for column in 0..film.width() {
            let pixel = [column, row];
            let place = [0, 1].map(|axis| (film.in_whole(pixel)[axis] - self.around.origin()[axis]) as usize);
            let near = |axis: usize, side: u32| place[axis].saturating_sub(1)..(place[axis] + 2).min(side as usize);
            let rows = near(1, self.around.height());
            let ids_near = rows.flat_map(|y| ids[y * width..][near(0, self.around.width())].iter().copied());
            self.pixel(pixel, ids[place[1] * width + place[0]], ids_near, &mut found);
        }
        found
    }

    /// Appends the spots of a pixel that shows the sphere `own`, with neighbours that show `near`, row by row. These may
    /// have `own` among them.
    pub(super) fn pixel(&self, pixel: [u32; 2], own: u32, near: impl Iterator<Item = u32>, found: &mut Row) {
        let (mut shown, mut count) = ([own; MOST], 1);
        for id in near {
            if id != own && !shown[..count].contains(&id) {
                shown[count] = id;
                count += 1;
            }
        }
        let before = found.all.len();
        if count > 1 && !self.offsets.is_empty() {
            self.at_edge(pixel, &shown[..count], &mut found.all);
        } else {
            found.all.extend(self.at_center(pixel, own));
        }
        found.counts.push((found.all.len() - before) as u8);
    }

    /// The ray of the camera through a place in a pixel, in the scene's frame.
    fn ray(&self, pixel: [u32; 2], offset: DVec2) -> Option<Ray> {
        let View { camera, film } = &self.view;
        // Computed in the whole film, so that parts round as the whole does.
        let place = film.in_whole(pixel);
        let [column, row] = [0, 1].map(|axis| f64::from(place[axis]) + 0.5 + offset[axis]);
        let location = film.whole().relative_location(column, row);
        let ray = camera.sees(location).then(|| camera.ray_in_world(location))?;
        Some(Ray { origin: ray.origin - self.origin, ..ray })
    }

    /// The width of a pixel at a distance from the camera, or 0 without need or if the camera does not see its sides.
    fn width(&self, pixel: [u32; 2], distance: f64) -> f64 {
        if !self.with_widths {
            return 0.0;
        }
        match [-0.5, 0.5].map(|x| self.ray(pixel, DVec2::new(x, 0.0))) {
            [Some(left), Some(right)] => (right.at(distance) - left.at(distance)).length(),
            _ => 0.0,
        }
    }

    /// The spot that the ray through a pixel's centre hits.
    fn at_center(&self, pixel: [u32; 2], id: u32) -> Option<Spot> {
        let ray = self.ray(pixel, DVec2::ZERO).filter(|_| id != NO_ID)?;
        let (center, radius) = sphere(self.spheres, id);
        // A ray that a device finds to hit may miss by rounding.
        let foot = (center - ray.origin).dot(ray.direction);
        let distance = distance(&ray, center, radius).unwrap_or(foot);
        let direction = ray.direction;
        Some(self.spot(pixel, &Hits { id, count: 1, position: ray.at(distance), direction, distance }, 1))
    }

    /// The spots that rays at the fixed places hit in a pixel at an edge, among the spheres `shown`.
    fn at_edge(&self, pixel: [u32; 2], shown: &[u32], spots: &mut Vec<Spot>) {
        let mut hits =
            [Hits { id: NO_ID, count: 0, position: DVec3::ZERO, direction: DVec3::ZERO, distance: 0.0 }; MOST];
        let mut places = [None; MOST];
        for (place, id) in places.iter_mut().zip(shown) {
            *place = (*id != NO_ID).then(|| sphere(self.spheres, *id));
        }
        let mut missing = 0;
        for offset in &self.offsets {
            let ray = self.ray(pixel, *offset);
            let mut nearest: Option<(f64, usize)> = None;
            if let Some(ray) = &ray {
                for (k, sphere) in places[..shown.len()].iter().enumerate() {
                    let Some((center, radius)) = *sphere else { continue };
                    let Some(t) = distance(ray, center, radius) else { continue };
                    if nearest.is_none_or(|(before, of)| (t, shown[k]) < (before, shown[of])) {
                        nearest = Some((t, k));
                    }
                }
            }
            match (nearest, ray) {
                (Some((t, k)), Some(ray)) => {
                    let of = &mut hits[k];
                    of.count += 1;
                    of.position += ray.at(t);
                    of.direction += ray.direction;
                    of.distance += t;
                }
                // Nothing is known of what else the ray hits, unless the background is seen beside it.
                _ if shown.contains(&NO_ID) => missing += 1,
                _ => {}
            }
        }
        let all = missing + hits.iter().map(|hits| hits.count).sum::<u32>();
        if all == 0 {
            spots.extend(self.at_center(pixel, shown[0]));
        }
        for (id, hits) in shown.iter().zip(hits).filter(|(_, hits)| hits.count > 0) {
            spots.push(self.spot(pixel, &Hits { id: *id, ..hits }, all));
        }
    }

    /// The spot in the middle of hits on one sphere, of `all` hits.
    fn spot(&self, pixel: [u32; 2], hits: &Hits, all: u32) -> Spot {
        let Hits { id, count, position, direction, distance } = *hits;
        let (center, radius) = sphere(self.spheres, id);
        let mean = position / f64::from(count);
        let out = -direction.normalize_or(DVec3::Z);
        let outward = (mean - center).normalize_or(out);
        // Seen from inside, the normal points inwards.
        let normal = if outward.dot(out) < -1e-3 { -outward } else { outward };
        let distance = distance / f64::from(count);
        Spot {
            position: center + radius * outward,
            normal,
            out,
            distance,
            width: self.width(pixel, distance),
            id,
            share: count as f32 / all as f32,
        }
    }
}

/// Centre and radius of a sphere.
pub(super) fn sphere(spheres: &[[f32; 4]], id: u32) -> (DVec3, f64) {
    let [x, y, z, radius] = spheres[id as usize].map(f64::from);
    (DVec3::new(x, y, z), radius)
}

/// The number of rays in a pixel at an edge. More than 256 change nothing that is seen.
pub(super) fn rays(sampling: &Sampling) -> u32 {
    sampling.samples.min(256)
}

/// The pixels of a film and, if it is a part of another one, those around it.
pub(super) fn with_neighbors(film: &Film) -> Film {
    let whole = film.whole();
    let (first, size) = (film.origin(), [film.width(), film.height()]);
    let last = [0, 1].map(|axis| (first[axis] + size[axis] + 1).min([whole.width(), whole.height()][axis]));
    let first = first.map(|first| first.saturating_sub(1));
    whole.part(first, [last[0] - first[0], last[1] - first[1]]).unwrap_or(*film)
}

/// The distance to the first point of a sphere in front of a ray's origin.
fn distance(ray: &Ray, center: DVec3, radius: f64) -> Option<f64> {
    let to_center = center - ray.origin;
    let foot = to_center.dot(ray.direction);
    let half_chord = (radius * radius - (to_center - foot * ray.direction).length_squared()).sqrt();
    // Not a number for a miss.
    let near = foot - half_chord;
    let t = if near > 0.0 { near } else { foot + half_chord };
    (t > 0.0).then_some(t)
}
