//! The spots of a smooth picture: places on spheres that are lit, found from the ids that pixels show.

use glam::{DVec2, DVec3};

use crate::camera::film::Film;
use crate::camera::sampling::{pair, pixel_seed};
use crate::camera::{View, filter};
use crate::geometry::ray::Ray;
use crate::image::NO_ID;
use crate::render::RenderSettings;

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

/// The rays of the pixels of a film.
#[derive(Clone, Copy)]
pub(super) struct Rays {
    /// In the pixels of this film, the device finds ids.
    pub(super) film: Film,
    /// The first pixel of the film in that one.
    first: [u32; 2],
    /// The number of rows and columns of rays in each pixel. A single ray has more beside it at edges.
    pub(super) side: u32,
    /// The number of rays in a pixel that has several.
    pub(super) count: u32,
}

impl Rays {
    pub(super) fn new(film: &Film, settings: &RenderSettings) -> Self {
        // More rays change nothing that is seen, and spots are counted in a byte.
        let count = settings.sampling.samples.min(256);
        let odd = 2 * ((f64::from(count).sqrt() - 1.0) / 2.0).round() as u32 + 1;
        let side = settings.studio_parameters().filter(|studio| studio.is_dense).map_or(1, |_| odd.min(15));
        if let (Some(film), true) = (film.divided(side), side > 1) {
            return Self { film, first: [0; 2], side, count: side * side };
        }
        let around = with_neighbors(film);
        let first = [0, 1].map(|axis| film.origin()[axis] - around.origin()[axis]);
        Self { film: around, first, side: 1, count }
    }

    /// The number of ids from which a pixel follows.
    pub(super) fn ids(&self) -> u32 {
        if self.side > 1 { self.count } else { MOST as u32 }
    }

    /// The place of one of these ids, row by row; `None` if it is outside. The middle one is at the pixel's centre.
    pub(super) fn place(&self, [column, row]: [u32; 2], at: u32) -> Option<[u32; 2]> {
        let [x, y] = self.first;
        if self.side > 1 {
            return Some([column * self.side + at % self.side, row * self.side + at / self.side]);
        }
        let place = [(x + column + at % 3).checked_sub(1)?, (y + row + at / 3).checked_sub(1)?];
        (place[0] < self.film.width() && place[1] < self.film.height()).then_some(place)
    }
}

/// Finds the spots of a picture.
pub(super) struct Finder<'a> {
    spheres: &'a [[f32; 4]],
    origin: DVec3,
    view: View<'a>,
    rays: Rays,
    /// The fixed places of rays in pixels that have several, counted from the centre.
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

impl Hits {
    fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.position += other.position;
        self.direction += other.direction;
        self.distance += other.distance;
    }
}

/// The most spheres that a pixel and its neighbours show.
const MOST: usize = 9;

impl<'a> Finder<'a> {
    pub(super) fn new(
        spheres: &'a [[f32; 4]],
        origin: DVec3,
        view: &View<'a>,
        rays: Rays,
        settings: &RenderSettings,
    ) -> Self {
        let sampling = &settings.sampling;
        let table = sampling.filter.offset_table();
        let seed = pixel_seed([0, 0], sampling.seed);
        let offset = |k| match rays.side {
            1 => DVec2::from(pair(seed, k, 0).map(|u| filter::offset(&table, u))),
            side => DVec2::from([k % side, k / side].map(|at| (f64::from(at) + 0.5) / f64::from(side) - 0.5)),
        };
        // A single ray is at the centre.
        let offsets = (0..rays.count).filter(|_| rays.count > 1).map(offset).collect();
        let with_widths = settings.studio_parameters().is_some_and(|studio| studio.shadows);
        Self { spheres, origin, view: *view, rays, offsets, with_widths }
    }

    /// The spots of a row.
    pub(super) fn row(&self, ids: &[u32], row: u32) -> Row {
        let width = self.rays.film.width() as usize;
        let mut found = Row::default();
        let mut shown = vec![NO_ID; self.rays.ids() as usize];
        let middle = shown.len() / 2;
        for column in 0..self.view.film.width() {
            let id = |at: usize| {
                let place = self.rays.place([column, row], at as u32)?;
                Some(ids[place[1] as usize * width + place[0] as usize])
            };
            let own = id(middle).unwrap_or(NO_ID);
            shown.iter_mut().enumerate().for_each(|(at, shown)| *shown = id(at).unwrap_or(own));
            self.pixel([column, row], &shown, &mut found);
        }
        found
    }

    /// Appends the spots of a pixel from the ids that its rays and those around them found.
    pub(super) fn pixel(&self, pixel: [u32; 2], ids: &[u32], found: &mut Row) {
        let own = ids[ids.len() / 2];
        let before = found.all.len();
        if self.offsets.is_empty() || ids.iter().all(|id| *id == own) {
            found.all.extend(self.at_center(pixel, own));
        } else if self.rays.side > 1 {
            self.at_rays(pixel, ids, &mut found.all);
        } else {
            let (mut shown, mut count) = ([own; MOST], 1);
            for id in ids {
                if !shown[..count].contains(id) {
                    shown[count] = *id;
                    count += 1;
                }
            }
            self.at_edge(pixel, &shown[..count], &mut found.all);
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
        Some(self.spot(pixel, &self.hit(pixel, DVec2::ZERO, id)?, 1))
    }

    /// The hit of a ray on a sphere that a device found.
    fn hit(&self, pixel: [u32; 2], offset: DVec2, id: u32) -> Option<Hits> {
        let ray = self.ray(pixel, offset).filter(|_| id != NO_ID)?;
        let (center, radius) = sphere(self.spheres, id);
        // A ray that a device finds to hit may miss by rounding.
        let foot = (center - ray.origin).dot(ray.direction);
        let distance = distance(&ray, center, radius).unwrap_or(foot);
        Some(Hits { id, count: 1, position: ray.at(distance), direction: ray.direction, distance })
    }

    /// The spots of a pixel whose rays found these ids.
    fn at_rays(&self, pixel: [u32; 2], ids: &[u32], spots: &mut Vec<Spot>) {
        let mut all: Vec<Hits> = Vec::with_capacity(ids.len());
        for (offset, id) in self.offsets.iter().zip(ids) {
            let Some(hit) = self.hit(pixel, *offset, *id) else { continue };
            match all.iter_mut().find(|hits| hits.id == *id) {
                Some(hits) => hits.add(&hit),
                None => all.push(hit),
            }
        }
        spots.extend(all.iter().map(|hits| self.spot(pixel, hits, self.rays.count)));
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
                    let hit = Hits { count: 1, position: ray.at(t), direction: ray.direction, distance: t, ..hits[k] };
                    hits[k].add(&hit);
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

/// The pixels of a film and, if it is a part of another one, those around it.
fn with_neighbors(film: &Film) -> Film {
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
