//! The spots of a smooth picture: places on shapes that are lit, found from the ids that pixels show.

use glam::{DVec2, DVec3};

use crate::camera::film::Film;
use crate::camera::sampling::{pair, pixel_seed};
use crate::camera::{View, filter};
use crate::geometry::cone::ConeInFrame;
use crate::geometry::cone_crossing::{crossings, intersect};
use crate::geometry::math::wide;
use crate::geometry::ray::Ray;
use crate::image::NO_ID;
use crate::render::RenderSettings;
use crate::scene::{Shape, SharedShapes};

/// A place on a shape that a pixel shows, in the scene's frame.
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
    /// The part of the pixel that shows the shape.
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
        let side = settings
            .studio_parameters()
            .filter(|studio| studio.is_dense && !studio.added_light)
            .map_or(1, |_| odd.min(15));
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
    shapes: &'a SharedShapes,
    origin: DVec3,
    view: View<'a>,
    rays: Rays,
    /// The fixed places of rays in pixels that have several, counted from the centre.
    offsets: Vec<DVec2>,
    /// True if spots have the width of their pixels, which shadows need.
    with_widths: bool,
}

/// The hits of a pixel's rays on one shape.
#[derive(Clone, Copy)]
struct Hits {
    id: u32,
    count: u32,
    /// Sums over the hits.
    position: DVec3,
    direction: DVec3,
    distance: f64,
    /// The sum of the normals, which point out of the shape. Zero for spheres, whose normals follow from positions.
    normal: DVec3,
}

impl Hits {
    fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.position += other.position;
        self.direction += other.direction;
        self.distance += other.distance;
        self.normal += other.normal;
    }
}

/// The most shapes that a pixel and its neighbours show.
const MOST: usize = 9;

impl<'a> Finder<'a> {
    pub(super) fn new(
        shapes: &'a SharedShapes,
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
        Self { shapes, origin, view: *view, rays, offsets, with_widths }
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
        if self.offsets.is_empty() || ids.iter().all(|id| *id == own) && !self.turns(pixel, own) {
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

    /// The hit of a ray on a shape that a device found.
    fn hit(&self, pixel: [u32; 2], offset: DVec2, id: u32) -> Option<Hits> {
        let ray = self.ray(pixel, offset).filter(|_| id != NO_ID)?;
        let shape = self.shapes.shape(id);
        // A ray that a device finds to hit may miss by rounding.
        let (distance, normal) = crossing(&ray, &shape).unwrap_or_else(|| nearest_to(&ray, &shape));
        Some(Hits { id, count: 1, position: ray.at(distance), direction: ray.direction, distance, normal })
    }

    /// Returns true if the normal of a cone turns so much within a pixel that it needs several rays, as at a rim.
    fn turns(&self, pixel: [u32; 2], id: u32) -> bool {
        let Some(shape @ Shape::Cone(_)) = (id != NO_ID).then(|| self.shapes.shape(id)) else { return false };
        let normal = |offset: DVec2| Some(crossing(&self.ray(pixel, offset)?, &shape)?.1);
        let Some(middle) = normal(DVec2::ZERO) else { return false };
        let corners = [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]].map(DVec2::from);
        corners.into_iter().any(|corner| normal(corner).is_none_or(|normal| normal.dot(middle) < LEAST_ALIKE))
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
        let [position, direction, normal] = [DVec3::ZERO; 3];
        let mut hits = [Hits { id: NO_ID, count: 0, position, direction, distance: 0.0, normal }; MOST];
        let mut places = [None; MOST];
        for (place, id) in places.iter_mut().zip(shown) {
            *place = (*id != NO_ID).then(|| self.shapes.shape(*id));
        }
        // Through an open end, a ray sees the inside of a cone only if nothing is there that is not among those shown, such as
        // the next piece of a tube. So the ray through the centre must see an inside, too.
        let is_inside = |ray: &Ray, normal: DVec3| normal.dot(ray.direction) > 0.0;
        let shows_inside = || {
            let middle = self.ray(pixel, DVec2::ZERO).zip(places[0]);
            middle.is_some_and(|(ray, shape)| crossing(&ray, &shape).is_some_and(|(_, normal)| is_inside(&ray, normal)))
        };
        let mut missing = 0;
        for offset in &self.offsets {
            let ray = self.ray(pixel, *offset);
            let mut nearest: Option<(f64, usize, DVec3)> = None;
            if let Some(ray) = &ray {
                for (k, shape) in places[..shown.len()].iter().enumerate() {
                    let Some((t, normal)) = shape.as_ref().and_then(|shape| crossing(ray, shape)) else { continue };
                    if nearest.is_none_or(|(before, of, _)| (t, shown[k]) < (before, shown[of])) {
                        nearest = Some((t, k, normal));
                    }
                }
            }
            match (nearest, &ray) {
                (Some((.., normal)), Some(ray)) if is_inside(ray, normal) && !shows_inside() => {}
                (Some((t, k, normal)), Some(ray)) => {
                    let position = ray.at(t);
                    let hit = Hits { count: 1, position, direction: ray.direction, distance: t, normal, ..hits[k] };
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

    /// The spot in the middle of hits on one shape, of `all` hits.
    fn spot(&self, pixel: [u32; 2], hits: &Hits, all: u32) -> Spot {
        let Hits { id, count, position, direction, distance, normal } = *hits;
        let mean = position / f64::from(count);
        let out = -direction.normalize_or(DVec3::Z);
        let (position, outward) = match self.shapes.shape(id) {
            Shape::Sphere([x, y, z, radius]) => {
                let center = wide([x, y, z]);
                let outward = (mean - center).normalize_or(out);
                (center + f64::from(radius) * outward, outward)
            }
            Shape::Cone(_) => (mean, normal.normalize_or(out)),
        };
        // Seen from inside, the normal points inwards.
        let normal = if outward.dot(out) < -1e-3 { -outward } else { outward };
        let distance = distance / f64::from(count);
        let (width, share) = (self.width(pixel, distance), count as f32 / all as f32);
        Spot { position, normal, out, distance, width, id, share }
    }
}

/// The least cosine of the angle between two normals within a pixel that one ray shows.
const LEAST_ALIKE: f64 = 0.9;

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

/// The distance to the first point of a shape in front of a ray's origin, and the normal of a cone there.
fn crossing(ray: &Ray, shape: &Shape) -> Option<(f64, DVec3)> {
    match shape {
        Shape::Sphere([x, y, z, radius]) => Some((distance(ray, wide([*x, *y, *z]), (*radius).into())?, DVec3::ZERO)),
        Shape::Cone(cone) => {
            let hit = crossings(ray, cone)?.into_iter().find(|crossing| crossing.t > 0.0)?;
            match hit.normal.or_else(|| normal_at_rim(cone, ray.at(hit.t))) {
                Some(normal) => Some((hit.t, normal)),
                None => intersect(ray, cone),
            }
        }
    }
}

/// The width of a rim at which a ray may be taken to meet the side, as a part of the radius.
const RIM: f64 = 1e-3;

/// The normal of the side at a point of an open end, if it is at the rim. A device may find a cone there whose side the ray
/// misses by rounding. What is behind the open end is not what the device has found: another shape often joins the side.
fn normal_at_rim(cone: &ConeInFrame, point: DVec3) -> Option<DVec3> {
    let ([start, end], [first, second]) = (cone.ends(), cone.radii());
    let (span, from_start) = (end - start, point - start);
    let part = from_start.dot(span) / span.length_squared();
    let away = from_start - part * span;
    let radius = first + part * (second - first);
    let slope = radius * (second - first) / span.length_squared();
    (away.length() >= (1.0 - RIM) * radius).then(|| (away - slope * span).normalize_or_zero())
}

/// The distance at which a ray comes nearest to the middle of a shape or to the axis of a cone, and the direction from there.
fn nearest_to(ray: &Ray, shape: &Shape) -> (f64, DVec3) {
    match shape {
        Shape::Sphere([x, y, z, _]) => ((wide([*x, *y, *z]) - ray.origin).dot(ray.direction), DVec3::ZERO),
        Shape::Cone(cone) => {
            let ([start, end], from) = (cone.ends(), ray.origin);
            let span = end - start;
            let (rise, along) = (span.dot(ray.direction), (start - from).dot(ray.direction));
            let across = span.length_squared() - rise * rise;
            let part = ((rise * along - span.dot(start - from)) / across.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            let distance = along + part * rise;
            (distance, (ray.at(distance) - (start + part * span)).normalize_or_zero())
        }
    }
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
