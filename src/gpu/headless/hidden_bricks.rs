//! Which bricks cannot change a picture, because all of their pixels show something nearer.

use crate::camera::View;
use crate::geometry::bounds::Bounds;
use crate::gpu::passes::tiles::{Groups, WORKGROUP_SIDE};
use crate::gpu::shader::records::{Hit, SceneSpace};
use crate::image::NO_ID;
use crate::parallel::map;

/// The distances of what the pixels of a film show so far.
#[derive(Debug)]
pub(in crate::gpu) struct SeenPixels {
    size: [u32; 2],
    /// Distance from the camera for each pixel, row by row; infinite for a miss.
    distances: Vec<f32>,
}

/// How much farther a box must be than a hit, as a part of its distance: more than the rounding of distances in f32.
const FARTHER: f64 = 1.0 / (1 << 18) as f64;

impl SeenPixels {
    /// The distances of hits that a kernel has written.
    pub(in crate::gpu) fn new(size: [u32; 2], hits: &[Hit]) -> Self {
        let distance = |[t, id, _, distance]: &Hit| match *id {
            NO_ID => f32::INFINITY,
            _ => f32::from_bits(*t) + f32::from_bits(*distance),
        };
        Self { size, distances: hits.iter().map(distance).collect() }
    }

    /// Whether the ray of every pixel of some workgroups misses a box or hits something before it. It is never known for
    /// cameras whose rays start far from the scene, because kernels round them by more than the margin of boxes.
    pub(in crate::gpu) fn hide(&self, view: &View<'_>, space: &SceneSpace, groups: Groups) -> bool {
        if !view.camera.kind().is_linear() {
            return false;
        }
        let [columns, rows] = [0, 1].map(|axis| {
            let (first, count) = (groups.first[axis], groups.size[axis]);
            let side = WORKGROUP_SIDE;
            first * side..((first + count) * side).min(self.size[axis])
        });
        let [min, max] = [space.min, space.max].map(|corner| space.origin + corner.as_dvec3());
        let bounds = Bounds::between(min, max);
        let is_hidden = |column: u32, row: u32| {
            let place = row as usize * self.size[0] as usize + column as usize;
            let ray = view.ray_through_center([column, row]);
            let entry = ray.and_then(|ray| bounds.entry(&ray));
            entry.is_none_or(|entry| f64::from(self.distances[place]) < entry * (1.0 - FARTHER))
        };
        let is_row_hidden =
            |at: usize| columns.clone().all(|column| is_hidden(column, rows.start + at as u32));
        map(rows.len(), is_row_hidden).into_iter().all(|is_hidden| is_hidden)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::camera::film::Film;
    use crate::camera::{FisheyeCamera, OrthographicCamera, Pose};

    /// Pixels of one unit, seen from z = 10, and a box from z = 2 to 3 behind the pixels from 4 to 6 in each direction.
    #[test]
    fn a_box_is_hidden_by_nearer_hits_on_all_of_its_pixels() {
        let film = Film::new(16, 16).unwrap();
        let pose =
            Pose::looking_along([8.0, 8.0, 10.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = OrthographicCamera::new(pose, [8.0, 8.0]).unwrap();
        let view = View::new(&camera, film);
        let space = SceneSpace {
            origin: DVec3::new(4.0, 4.0, 0.0),
            min: Vec3::new(0.0, 0.0, 2.0),
            max: Vec3::new(2.0, 2.0, 3.0),
        };
        let (all, right) = (Groups::of_size([16, 16]), Groups { first: [1, 0], size: [1, 2] });
        let hit = |t: f32| [t.to_bits(), 0, 0, 0.5_f32.to_bits()];
        let mut hits = vec![[0, NO_ID, 0, 0]; 256];
        let hides =
            |hits: &[Hit], groups| SeenPixels::new([16, 16], hits).hide(&view, &space, groups);
        assert!(!hides(&hits, all) && hides(&hits, right));
        for row in 10..12 {
            for column in 4..6 {
                assert!(!hides(&hits, all));
                hits[16 * row + column] = hit(6.4);
            }
        }
        assert!(hides(&hits, all));
        // As far as the box, and behind it.
        for t in [6.5, 7.0] {
            hits[16 * 10 + 4] = hit(t);
            assert!(!hides(&hits, all), "{t}");
        }
        hits[16 * 10 + 4] = hit(6.4);
        let round = FisheyeCamera::new(pose, 3.0, 1.0).unwrap();
        assert!(!SeenPixels::new([16, 16], &hits).hide(&View::new(&round, film), &space, all));
    }
}
