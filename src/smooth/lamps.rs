//! The light of lamps that are infinitely far away, with and without shadows.
//!
//! A lamp has directions that are spread evenly over its disk, or one. A sphere in the way hides those within the cap in
//! which it is seen, and partly those at its border, so that a shadow has no steps; a border is as wide as directions are
//! apart, or as a pixel if that is wider. Of overlapping spheres, the one that hides most of a direction counts.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DVec3, Vec3};

use super::caps::Cap;
#[cfg(feature = "gpu")]
use super::cells::Cells;
use super::levels::{Cone, Places};
use super::lists::{CubeLists, Needed};
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
            let cone = Cone { start: cells.middle(cube), axis, radius: 1.74 * cells.side, slope };
            let mut ids = Vec::new();
            places.levels.along(cells, places.spheres, &cone, |id| {
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
            let cone = Cone { start: spot.position, axis: self.toward, radius: spot.width, slope: self.slope };
            let listed = self.lists.of(places.cells.cube_of(spot.position));
            let is_open = listed.iter().all(|id| {
                let (center, radius) = sphere(places.spheres, *id);
                !cone.meets(center, radius) || sight.meets(*id, center, radius)
            });
            if is_open && listed.len() == LISTED {
                let mut left = MOST;
                places.levels.along(places.cells, places.spheres, &cone, |id| {
                    let (center, radius) = sphere(places.spheres, id);
                    left -= 1;
                    sight.meets(id, center, radius) && left > 0
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

    /// Counts a sphere in the way. Returns false if no light is left.
    fn meets(&mut self, id: u32, center: DVec3, radius: f64) -> bool {
        let (v, radius) = ((center - self.spot.position).as_vec3(), radius as f32);
        // Spheres below the horizon hide nothing. The spot's own sphere is one of them.
        if id == self.spot.id || self.normal.dot(v) + radius <= 1e-3 * radius {
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
        let hidden = &mut self.hidden[..x.len()];
        Cap { a, b, most }.hide([x, y, z], hidden);
        self.arriving = self.cosines.iter().zip(hidden).map(|(cosine, hidden)| cosine * (1.0 - *hidden)).sum();
        self.arriving > self.least
    }
}
