//! The light of lamps that are infinitely far away, with and without shadows.
//!
//! A lamp has directions that are spread evenly over its disk, or one. A sphere in the way hides those within the cap in
//! which it is seen, a piece of a cone those within its outline, and both partly those at the border, so that a shadow has
//! no steps; a border is as wide as directions are apart, or as a pixel if that is wider. Of what overlaps, the one that
//! hides most of a direction counts.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DVec3, Vec3};

use super::caps::Cap;
#[cfg(feature = "gpu")]
use super::cells::Cells;
use super::levels::{Beam, Places};
use super::lists::{CubeLists, Needed};
use super::pieces::{Axis, Piece};
use super::spots::{Spot, sphere};

/// The number of directions of a lamp with a width.
const DIRECTIONS: usize = 32;

/// The most spheres of a list. For more, those in the way are searched for each point.
const LISTED: usize = 128;

/// The most spheres that are searched for a point. Others do not hide the lamp from it.
const MOST: usize = 512;

/// The part of a lamp's light that is not followed further.
const NEGLIGIBLE: f32 = 0.01;

/// A lamp that is infinitely far away.
#[derive(Debug)]
pub(super) struct Lamp {
    toward: DVec3,
    /// Unit vectors towards the lamp, side by side.
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    /// The angle between neighbouring directions; 0 for a single one.
    apart: f64,
    /// The slope of the cone from a point to the lamp's disk.
    slope: f64,
    /// The share of each direction in the light, where a surface faces the lamp.
    share: f64,
    /// The ids of the spheres in the way from each cube, the nearest first, about.
    lists: CubeLists<u32>,
    /// The number of points for which spheres were left out.
    pub(super) crowded: AtomicUsize,
}

impl Lamp {
    pub(super) fn new(toward: DVec3, angular_radius: f64, places: &Places<'_>) -> Self {
        let count = if angular_radius > 0.0 { DIRECTIONS } else { 1 };
        let (right, up) = toward.any_orthonormal_pair();
        // A Fibonacci lattice on the cap, by equal shares of its area.
        let directions: Vec<Vec3> = (0..count)
            .map(|k| {
                let versine = (k as f64 + 0.5) / count as f64 * 2.0 * (0.5 * angular_radius).sin().powi(2);
                let (sin, cos) = (PI * (3.0 - 5.0_f64.sqrt()) * k as f64).sin_cos();
                let across = (versine * (2.0 - versine)).sqrt();
                (across * (cos * right + sin * up) + (1.0 - versine) * toward).as_vec3()
            })
            .collect();
        let apart = angular_radius * (PI / count as f64).sqrt();
        Self {
            toward,
            x: directions.iter().map(|direction| direction.x).collect(),
            y: directions.iter().map(|direction| direction.y).collect(),
            z: directions.iter().map(|direction| direction.z).collect(),
            apart,
            slope: (angular_radius + 0.5 * apart).tan(),
            // The mean cosine of the angle to the lamp's middle is half of this divisor.
            share: 2.0 / (1.0 + angular_radius.cos()) / count as f64,
            lists: CubeLists::new(places),
            crowded: AtomicUsize::new(0),
        }
    }

    /// The bytes of full lists for cubes that this many pixels show.
    #[cfg(feature = "gpu")]
    pub(super) fn bytes(cells: &Cells, pixels: u64) -> u64 {
        let cubes = cells.cube_counts().into_iter().product::<usize>() as u64;
        4 * (cubes + cubes.min(pixels) * LISTED as u64)
    }

    /// Lists the spheres in the way to the lamp from the cubes of visible points.
    pub(super) fn see(&mut self, places: &Places<'_>, cubes: &Needed) {
        let cells = places.cells;
        let (axis, slope) = (self.toward, self.slope);
        self.lists.complete(cubes, |cube| {
            let beam = Beam { start: cells.middle(cube), axis, radius: 1.74 * cells.side, slope };
            let mut ids = Vec::new();
            places.levels.along(cells, places.balls, &beam, |id| {
                ids.push(id);
                ids.len() < LISTED
            });
            ids
        });
    }

    /// The light at a spot, as a share of what arrives where a surface faces the lamp. Spheres in `places` cast shadows.
    pub(super) fn light(&self, spot: &Spot, places: Option<&Places<'_>>) -> f64 {
        let mut sight = Sight::new(self, spot);
        if let (Some(places), true) = (places, sight.arriving > 0.0) {
            let beam = Beam { start: spot.position, axis: self.toward, radius: spot.width, slope: self.slope };
            let listed = self.lists.of(places.cells.cube_of(spot.position));
            let is_open = listed.iter().all(|id| {
                let (center, radius) = sphere(places.balls, *id);
                !beam.meets(center, radius) || sight.meets(places, *id)
            });
            if is_open && listed.len() == LISTED {
                let mut left = MOST;
                places.levels.along(places.cells, places.balls, &beam, |id| {
                    left -= 1;
                    sight.meets(places, id) && left > 0
                });
                self.crowded.fetch_add(usize::from(left == 0), Ordering::Relaxed);
            }
        }
        f64::from(sight.arriving) * self.share
    }
}

/// The light of a lamp that reaches a spot, sphere by sphere in the way.
struct Sight<'a> {
    lamp: &'a Lamp,
    spot: &'a Spot,
    normal: Vec3,
    /// The cosines of the angles between directions to the lamp and the normal; 0 below the horizon.
    cosines: [f32; DIRECTIONS],
    /// The part of each direction that spheres hide.
    hidden: [f32; DIRECTIONS],
    /// The sum of the cosines of directions, as far as no sphere hides these.
    arriving: f32,
    /// The sum below which the rest is not looked for.
    least: f32,
}

impl<'a> Sight<'a> {
    fn new(lamp: &'a Lamp, spot: &'a Spot) -> Self {
        let n = spot.normal.as_vec3();
        let mut cosines = [0.0; DIRECTIONS];
        for (k, cosine) in cosines[..lamp.x.len()].iter_mut().enumerate() {
            *cosine = (n.x * lamp.x[k] + n.y * lamp.y[k] + n.z * lamp.z[k]).max(0.0);
        }
        let arriving = cosines.iter().sum();
        let least = NEGLIGIBLE * lamp.x.len() as f32;
        Self { lamp, spot, normal: n, cosines, hidden: [0.0; DIRECTIONS], arriving, least }
    }

    /// Counts a sphere or a piece of a cone in the way. Returns false if no light is left.
    fn meets(&mut self, places: &Places<'_>, ball: u32) -> bool {
        match places.piece(ball) {
            Some((piece, cone)) => {
                // A cone hides nothing from itself, because it is convex.
                let id = places.shapes.spheres.len() as u32 + piece.cone;
                id == self.spot.id || self.meets_piece(piece, &Axis::of(cone))
            }
            None => ball == self.spot.id || self.meets_sphere(sphere(places.balls, ball)),
        }
    }

    /// Updates the sum of arriving light. Returns false if none is left.
    fn is_left(&mut self) -> bool {
        let hidden = &self.hidden[..self.lamp.x.len()];
        self.arriving = self.cosines.iter().zip(hidden).map(|(cosine, hidden)| cosine * (1.0 - *hidden)).sum();
        self.arriving > self.least
    }

    /// Counts a piece of a cone: in each direction, by its distance from where the line to the lamp comes nearest to the
    /// axis, and at an end of the cone by the distance from its disc as it is seen. Where a piece is cut off another, it is
    /// round, so that no seam is seen.
    fn meets_piece(&mut self, piece: Piece, axis: &Axis) -> bool {
        let [from, to] = [piece.from, piece.to].map(f64::from);
        let start = (axis.at(from) - self.spot.position).as_vec3();
        let span = ((to - from) * axis.span).as_vec3();
        let radii = [from, to].map(|part| axis.radius(part) as f32);
        if self.normal.dot(start) + radii[0] <= 0.0 && self.normal.dot(start + span) + radii[1] <= 0.0 {
            return true;
        }
        let (square, length) = (span.length_squared(), span.length());
        let is_cut = [piece.from > 0.0, piece.to < 1.0];
        for k in 0..self.lamp.x.len() {
            let direction = Vec3::new(self.lamp.x[k], self.lamp.y[k], self.lamp.z[k]);
            let (rise, along) = (direction.dot(span), direction.dot(start));
            // The points of the axis and of the line that are nearest to each other.
            let across = (square - rise * rise).max(1e-6 * square);
            let free = (rise * along - span.dot(start)) / across;
            let part = free.clamp(0.0, 1.0);
            let distance = along + part * rise;
            if distance <= 0.0 {
                continue;
            }
            let beside = start + part * span - distance * direction;
            let radius = radii[0] + part * (radii[1] - radii[0]);
            let border = (self.lamp.apart as f32 * distance).max(self.spot.width as f32);
            // What is thinner than its border hides as much of it.
            let wide = radius.max(0.5 * border);
            let most = radius / wide;
            let cosine = rise / length;
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let end = usize::from(free > 0.5);
            let is_end = !(0.0..=1.0).contains(&free) && !is_cut[end] && sine > 1e-3;
            let beyond = if is_end { beside.dot(span - rise * direction).abs() / (length * sine) } else { 0.0 };
            let aside = (beside.length_squared() - beyond * beyond).max(0.0).sqrt();
            let mut hides = 0.5 + (wide - aside) / border;
            if is_end {
                // The disc is seen as an ellipse.
                let disc = (wide * wide - aside * aside).max(0.0).sqrt() * cosine.abs();
                hides = hides.min(0.5 + (disc - beyond) / border);
            }
            let hides = most * hides.clamp(0.0, 1.0);
            self.hidden[k] = self.hidden[k].max(hides);
        }
        self.is_left()
    }

    /// Counts a sphere in the way. Returns false if no light is left.
    fn meets_sphere(&mut self, (center, radius): (DVec3, f64)) -> bool {
        let (v, radius) = ((center - self.spot.position).as_vec3(), radius as f32);
        // Spheres below the horizon hide nothing.
        if self.normal.dot(v) + radius <= 1e-3 * radius {
            return true;
        }
        let distance = v.length().max(radius);
        let border = (self.lamp.apart as f32).max(self.spot.width as f32 / distance);
        // A cap that is smaller than its border hides as much of it.
        let sine = radius / distance;
        let wide = sine.max(0.5 * border).min(1.0);
        let most = (sine / wide) * (sine / wide);
        let slope = most / (wide * border);
        let a = v * (slope / distance);
        let b = 0.5 * most - slope * (1.0 - wide * wide).sqrt();
        let Lamp { x, y, z, .. } = self.lamp;
        Cap { a, b, most }.hide([x, y, z], &mut self.hidden[..x.len()]);
        self.is_left()
    }
}
