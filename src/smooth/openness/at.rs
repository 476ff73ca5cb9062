//! The openness of a point, in f32, direction by direction side by side. `tests/cpu/smooth.rs` compares it with rays.

use glam::{DVec3, Vec3};

use super::Openness;
use super::far::DIRECTIONS;
use crate::smooth::caps::Cap;
use crate::smooth::cells::{Cells, corners};

/// The part of all directions that belongs to each, divided by that of a half sphere, so that it is the height of a cap.
const PART: f32 = 4.0 / DIRECTIONS as f32;

impl Openness {
    /// The share of ambient light that reaches a point of a surface, whose tables are complete.
    pub(in crate::smooth) fn at(&self, cells: &Cells, position: DVec3, normal: DVec3) -> f32 {
        let (side, n) = (cells.side as f32, normal.as_vec3());
        // The directions above the horizon, with the cosines of their angles to the normal. Others count nothing.
        let (mut above, mut count) = (Above::default(), 0);
        for (k, direction) in self.directions.iter().enumerate() {
            let cosine = n.dot(*direction);
            above.put(count, k, *direction, cosine);
            count += usize::from(cosine > 0.0);
        }
        above.put(count, 0, Vec3::ZERO, 0.0);
        let Above { x: dx, y: dy, z: dz, cosine, number } = above;
        // The part of each direction that near spheres hide: the most that any of them hides.
        let mut hidden = [0.0_f32; MOST_ABOVE];
        let cube = cells.cube_of(position);
        let position_in_cube = (position - cells.middle(cube)).as_vec3();
        let end = self.near_end;
        for [x, y, z, radius] in self.near.of(cube) {
            let v = Vec3::new(*x, *y, *z) - position_in_cube;
            // Most spheres of a list are too far away, or below the horizon.
            let over = n.dot(v) + radius;
            if v.length_squared() >= (radius + end) * (radius + end) || over <= 0.01 * side {
                continue;
            }
            let distance = v.length().max(*radius);
            // It counts less from one side of the cells on, as cells count more, and less where it is below the horizon.
            let near = ((end - (distance - radius)) / side.min(end)).clamp(0.0, 1.0);
            let over = (4.0 * over / side - 0.04).min(1.0);
            // The sphere is seen in a cap of directions, of which this is the height; a cap that is smaller than the part
            // of a direction hides as much of it.
            let sine = radius / distance;
            let height = 1.0 - (1.0 - sine * sine).max(0.0).sqrt();
            let most = near * over * (2.0 * height / PART).min(1.0);
            let a = v * (most / (PART * distance));
            let b = most * ((height.max(0.5 * PART) - 1.0) / PART + 0.5);
            Cap { a, b, most }.hide([&dx, &dy, &dz], &mut hidden);
        }
        let (first, parts) = cells.tetrahedron(position, normal);
        let corners = corners(first, parts).map(|(vertex, weight)| (self.far_of(cells, vertex), weight as f32 / 255.0));
        let (mut open, mut all) = (0.0, 0.0);
        for k in 0..count {
            let far = corners.iter().map(|(shares, weight)| weight * f32::from(shares[number[k]])).sum::<f32>();
            open += cosine[k] * (1.0 - hidden[k]) * far;
            all += cosine[k];
        }
        open / all
    }
}

/// The most directions above any horizon: there are 13 to 19, and one more is tried.
const MOST_ABOVE: usize = 20;

/// Directions, side by side.
#[derive(Default)]
struct Above {
    x: [f32; MOST_ABOVE],
    y: [f32; MOST_ABOVE],
    z: [f32; MOST_ABOVE],
    cosine: [f32; MOST_ABOVE],
    number: [usize; MOST_ABOVE],
}

impl Above {
    fn put(&mut self, at: usize, number: usize, direction: Vec3, cosine: f32) {
        let at = at.min(MOST_ABOVE - 1);
        (self.x[at], self.y[at], self.z[at]) = (direction.x, direction.y, direction.z);
        (self.cosine[at], self.number[at]) = (cosine, number);
    }
}
