//! Which bricks are traced in which part of a picture.

use crate::accel::{BrickBounds, margin_of};
use crate::camera::View;
use crate::gpu::passes::order::nearest_first;
use crate::gpu::passes::tiles::{Groups, Tile, tiles};
use crate::gpu::passes::visible_region::VisibleRegion;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::records::SceneSpace;

/// The bricks of a scene that a view may show.
#[derive(Clone, Debug)]
pub(in crate::gpu) struct VisibleBricks {
    /// Where the scene may be visible.
    scene: VisibleRegion,
    /// The bricks that may be visible, the nearest first.
    bricks: Vec<(usize, VisibleRegion)>,
    /// The brick that is traced where there are no others.
    nearest: usize,
}

impl VisibleBricks {
    pub(in crate::gpu) fn of(view: &View<'_>, space: &SceneSpace, bricks: &[BrickBounds]) -> Self {
        let scene = VisibleRegion::of(view, space);
        let order = nearest_first(bricks.iter().copied(), view.camera, space);
        let nearest = order.first().copied().unwrap_or(0);
        let region = |brick: usize| {
            if bricks.len() == 1 {
                return Some((brick, scene));
            }
            let region = VisibleRegion::of_brick(view, &space_of(space, &bricks[brick])?)?;
            Some((brick, region.within(scene)))
        };
        Self { scene, bricks: order.into_iter().filter_map(region).collect(), nearest }
    }

    /// The bricks to be traced for a tile or a band, in order, and the workgroups that are dispatched for each. The
    /// first is traced wherever the scene may be visible, because its pass writes misses and records rays.
    pub(in crate::gpu) fn parts_of(&self, tile: Tile) -> Vec<(usize, Groups)> {
        let regions = self.bricks.iter().map(|(brick, region)| (*brick, region.groups_of(tile)));
        let mut parts: Vec<_> = regions.filter(|(_, groups)| groups.count() > 0).collect();
        let scene = self.scene.groups_of(tile);
        match parts.first_mut() {
            Some((_, groups)) => *groups = scene,
            None => parts.push((self.nearest, scene)),
        }
        parts
    }
}

/// The box of a brick, inflated like that of the scene, outside of which no ray hits its spheres; `None` for a brick
/// without spheres.
pub(in crate::gpu) fn space_of(scene: &SceneSpace, brick: &BrickBounds) -> Option<SceneSpace> {
    // The scene's box includes its margin, so this margin is slightly larger.
    let margin = 2.0 * margin_of(scene.min, scene.max);
    let (min, max) = ((brick.min - margin).max(scene.min), (brick.max + margin).min(scene.max));
    (!brick.is_empty()).then_some(SceneSpace { min, max, ..*scene })
}

/// Number of pixels of a film that are traced, in whole workgroups, counted once for every brick that is traced there.
pub(in crate::gpu) fn traced_pixels(
    scene: &SceneBuffers,
    view: &View<'_>,
    tile_size: [u32; 2],
) -> u64 {
    let bricks = VisibleBricks::of(view, &scene.space, &scene.brick_bounds());
    let parts = tiles(&view.film, tile_size).flat_map(|tile| bricks.parts_of(tile));
    parts.map(|(_, groups)| groups.pixels()).sum()
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::camera::film::Film;
    use crate::camera::{
        Camera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera,
    };

    /// Eight bricks in a row along x, with spheres from 10 i + 1 to 10 i + 9.
    fn bricks() -> Vec<BrickBounds> {
        let brick = |i: u8| {
            let x = 10.0 * f32::from(i);
            BrickBounds::of_spheres(&[[x + 2.0, 2.0, 2.0, 1.0], [x + 8.0, 8.0, 8.0, 1.0]])
        };
        (0..8).map(brick).collect()
    }

    fn space() -> SceneSpace {
        let margin = Vec3::splat(0.001);
        let (min, max) = (Vec3::ONE - margin, Vec3::new(79.0, 9.0, 9.0) + margin);
        SceneSpace { origin: DVec3::new(5.0, 0.0, 0.0), min, max }
    }

    fn visible(camera: &dyn Camera, film: Film) -> Vec<(usize, Groups)> {
        let view = View::new(camera, film);
        let tile = Tile { origin: [0, 0], size: [film.width(), film.height()], in_target: [0, 0] };
        VisibleBricks::of(&view, &space(), &bricks()).parts_of(tile)
    }

    fn numbers(parts: &[(usize, Groups)]) -> Vec<usize> {
        parts.iter().map(|(brick, _)| *brick).collect()
    }

    /// A pixel is as wide as a unit of length, so that each brick fills columns of 8 pixels.
    #[test]
    fn each_brick_has_its_columns_and_the_first_has_all() {
        let film = Film::new(80, 16).unwrap();
        let pose =
            Pose::looking_along([45.0, 5.0, 30.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = OrthographicCamera::new(pose, [40.0, 8.0]).unwrap();
        let parts = visible(&camera, film);
        assert_eq!(parts.len(), 8);
        assert_eq!(parts[0].1, Groups { first: [0, 0], size: [10, 2] });
        for (brick, groups) in &parts[1..] {
            let (first, end) = (10 * brick + 1, 10 * brick + 9);
            let columns = first.saturating_sub(3) / 8..(end + 3).div_ceil(8).min(10);
            assert_eq!(groups.first[0] as usize, columns.start, "{brick}");
            assert_eq!(groups.size, [columns.len() as u32, 2], "{brick}");
        }
    }

    #[test]
    fn bricks_behind_or_beside_the_picture_are_left_out() {
        let film = Film::new(64, 64).unwrap();
        let from = |x: f64, toward: f64| {
            let pose =
                Pose::looking_along([x, 5.0, 5.0], [toward, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
            PinholeCamera::with_vertical_fov(pose, 0.6, 1.0).unwrap()
        };
        // The eye is between two bricks, of which one is on its plane.
        assert_eq!(numbers(&visible(&from(45.0, 1.0), film)), [4, 5, 6, 7]);
        assert_eq!(numbers(&visible(&from(45.0, -1.0), film)), [3, 2, 1, 0]);
        // Nothing is seen, so one brick writes the misses, if there are any.
        let nothing = visible(&from(95.0, 1.0), film);
        assert_eq!((nothing.len(), nothing[0].0), (1, 7));
        let aside =
            Pose::looking_along([30.0, 5.0, 30.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let narrow = PinholeCamera::with_vertical_fov(aside, 0.05, 1.0).unwrap();
        assert_eq!(numbers(&visible(&narrow, film)), [2]);
    }

    #[test]
    fn cameras_that_bend_lines_or_have_a_lens_see_all() {
        let film = Film::new(64, 32).unwrap();
        let pose = Pose::looking_along([45.0, 5.0, 5.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
        let pinhole = PinholeCamera::with_vertical_fov(pose, 0.6, 2.0).unwrap();
        let lens = ThinLensCamera::new(pinhole, 0.1, 12.0).unwrap();
        for camera in [&PanoramaCamera::new(pose) as &dyn Camera, &lens] {
            let parts = visible(camera, film);
            assert_eq!(parts.len(), 8);
            assert!(parts.iter().all(|(_, groups)| *groups == Groups::of_size([64, 32])));
        }
    }
}
