//! The bricks that are traced in each part of a picture, and their order. A brick is a part of a scene in one binding.

use glam::{DVec2, DVec3, Vec3};

use crate::accel::{BrickBounds, Primitive, margin_of};
use crate::camera::film::YAxis;
use crate::camera::{Camera, CameraKind, CameraVectors, View};
use crate::gpu::passes::tiles::{Groups, Tile, WORKGROUP_SIDE, tiles};
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::records::SceneSpace;

/// The bricks of a scene that a view may show.
#[derive(Clone, Debug)]
pub(crate) struct VisibleBricks {
    /// The region in which the scene may be visible.
    scene: VisibleRegion,
    /// The bricks that may be visible, the nearest first.
    bricks: Vec<(usize, VisibleRegion)>,
    /// The brick that is traced where no brick may be visible, or only bricks of cones though there are spheres.
    nearest: usize,
    /// The bricks of cones.
    of_cones: Vec<usize>,
}

impl VisibleBricks {
    pub(crate) fn of(view: &View<'_>, space: &SceneSpace, bricks: &[BrickBounds]) -> Self {
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
        let is_of_cones = |brick: &usize| bricks[*brick].primitive == Primitive::Cone;
        let of_cones = (0..bricks.len()).filter(is_of_cones).collect();
        Self { scene, bricks: order.into_iter().filter_map(region).collect(), nearest, of_cones }
    }

    /// Number of pixels of a tile in which the scene may be visible, in whole workgroups.
    pub(crate) fn pixels_of(&self, tile: Tile) -> u64 {
        self.scene.groups_of(tile).pixels()
    }

    /// The bricks to be traced for a tile or a band, in order, and the workgroups that are dispatched for each. The
    /// first brick is traced wherever the scene may be visible, because its pass writes misses and records rays.
    pub(crate) fn parts_of(&self, tile: Tile) -> Vec<(usize, Groups)> {
        let regions = self.bricks.iter().map(|(brick, region)| (*brick, region.groups_of(tile)));
        let mut parts: Vec<_> = regions.filter(|(_, groups)| groups.count() > 0).collect();
        let scene = self.scene.groups_of(tile);
        match parts.first_mut() {
            Some((brick, groups)) if !self.of_cones.contains(brick) || self.of_cones.contains(&self.nearest) => {
                *groups = scene;
            }
            _ => parts.insert(0, (self.nearest, scene)),
        }
        parts
    }
}

/// The box of a brick, inflated like the box of the scene. No ray hits the brick's spheres outside of
/// it. `None` for a brick without spheres.
pub(crate) fn space_of(scene: &SceneSpace, brick: &BrickBounds) -> Option<SceneSpace> {
    // The scene's box includes its margin, so this margin is slightly larger.
    let margin = 2.0 * margin_of(scene.min, scene.max);
    let (min, max) = ((brick.min - margin).max(scene.min), (brick.max + margin).min(scene.max));
    (!brick.is_empty()).then_some(SceneSpace { min, max, ..*scene })
}

/// Number of pixels of a film that are traced, in whole workgroups, counted once for every brick that is traced there.
pub(crate) fn traced_pixels(scene: &SceneBuffers, view: &View<'_>, tile_size: [u32; 2]) -> u64 {
    let bricks = VisibleBricks::of(view, &scene.space, &scene.brick_bounds());
    let parts = tiles(&view.film, tile_size).flat_map(|tile| bricks.parts_of(tile));
    parts.map(|(_, groups)| groups.pixels()).sum()
}

/// Squared distance from a point to the box of a brick's centres; 0 for a point inside.
fn distance_squared(brick: &BrickBounds, point: Vec3) -> f32 {
    (point - point.max(brick.center_min).min(brick.center_max)).length_squared()
}

/// The indices of boxes, sorted by their distance from the camera, the nearest first, those of spheres before those of
/// cones. Hits in near bricks then let rays
/// skip the others. The picture does not depend on the order.
pub(crate) fn nearest_first(
    boxes: impl Iterator<Item = BrickBounds>,
    camera: &dyn Camera,
    space: &SceneSpace,
) -> Vec<usize> {
    let eye = (camera.ray_in_world(DVec2::ZERO).origin - space.origin).as_vec3();
    let is_later = |brick: &BrickBounds| brick.primitive == Primitive::Cone;
    let mut order: Vec<(bool, f32, usize)> =
        boxes.zip(0..).map(|(brick, at)| (is_later(&brick), distance_squared(&brick, eye), at)).collect();
    order.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    order.into_iter().map(|(.., brick)| brick).collect()
}

/// A rectangle of the film in pixels, which may be empty. No ray of a pixel outside of it hits the scene's box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VisibleRegion {
    first: [f64; 2],
    /// End of the rectangle, exclusive.
    end: [f64; 2],
}

/// Margin of the rectangle on each side in pixels. Rounding in a kernel never moves a ray so far.
const PIXELS_AROUND: f64 = 2.0;

impl VisibleRegion {
    /// The rectangle around the projections of the box's eight corners, or the whole film if a corner is not in front
    /// of the camera.
    ///
    /// If the camera projects straight lines to straight lines and has no lens, the picture of the box lies within the
    /// rectangle of its corners. For other cameras the region is the whole film.
    pub(crate) fn of(&View { camera, film }: &View<'_>, space: &SceneSpace) -> Self {
        let size = [f64::from(film.width()), f64::from(film.height())];
        let all = Self { first: [0.0; 2], end: size };
        if !camera.kind().is_linear() || camera.has_lens() {
            return all;
        }
        let whole = [film.whole().width(), film.whole().height()].map(f64::from);
        let origin = film.origin().map(f64::from);
        let mut region = Self { first: size, end: [0.0; 2] };
        for corner in space.corners() {
            let Some(location) = camera.location_of(space.origin + corner) else {
                return all;
            };
            let down = match film.y_axis() {
                YAxis::Up => -location.y,
                YAxis::Down => location.y,
            };
            for (axis, along) in [location.x, down].into_iter().enumerate() {
                let pixel = (along + 1.0) / 2.0 * whole[axis] - origin[axis];
                region.first[axis] = region.first[axis].min(pixel - PIXELS_AROUND);
                region.end[axis] = region.end[axis].max(pixel + PIXELS_AROUND);
            }
        }
        region
    }

    /// The rectangle of [`VisibleRegion::of`], or `None` if the box is behind the camera or beside the film, so that
    /// only rays beyond the film might hit it.
    pub(crate) fn of_brick(view: &View<'_>, space: &SceneSpace) -> Option<Self> {
        let camera = view.camera;
        if camera.kind() != CameraKind::Pinhole || camera.has_lens() {
            return Some(Self::of(view, space));
        }
        let CameraVectors { origin, right, up, forward, .. } = camera.vectors();
        let volume = right.cross(up).dot(forward);
        // A point is `x right + y up + depth forward` from the eye, and at (x, y) / depth on the film.
        let corners = space.corners().map(|corner| {
            let toward = space.origin + corner - origin;
            let part = |a: DVec3, b: DVec3| toward.dot(a.cross(b)) / volume;
            (part(up, forward), part(forward, right), part(right, up))
        });
        let edge = |pixels: u32| 1.0 + 2.0 * PIXELS_AROUND / f64::from(pixels);
        let film = view.film.whole();
        let (right, up) = (edge(film.width()), edge(film.height()));
        // All corners, and so the box, are beyond a plane through the eye.
        let is_outside = corners.iter().all(|(.., depth)| *depth <= 0.0)
            || corners.iter().all(|(x, _, depth)| *x > right * depth)
            || corners.iter().all(|(x, _, depth)| -x > right * depth)
            || corners.iter().all(|(_, y, depth)| *y > up * depth)
            || corners.iter().all(|(_, y, depth)| -y > up * depth);
        (!is_outside).then(|| Self::of(view, space))
    }

    /// The intersection of two regions.
    pub(crate) fn within(mut self, other: Self) -> Self {
        for axis in 0..2 {
            self.first[axis] = self.first[axis].max(other.first[axis]);
            self.end[axis] = self.end[axis].min(other.end[axis]);
        }
        self
    }

    /// The region extended for rays that may be up to `pixels` pixels away from the centres of their pixels.
    pub(crate) fn widened(mut self, pixels: f64) -> Self {
        self.first.iter_mut().for_each(|first| *first -= pixels);
        self.end.iter_mut().for_each(|end| *end += pixels);
        self
    }

    /// The workgroups of a tile that overlap the rectangle. If there are none, both sides of the result are zero.
    pub(crate) fn groups_of(&self, tile: Tile) -> Groups {
        let side = f64::from(WORKGROUP_SIDE);
        let mut groups = Groups::of_size(tile.size);
        for axis in 0..2 {
            let count = f64::from(groups.size[axis]);
            let origin = f64::from(tile.origin[axis]);
            // Both values are clamped to the range of workgroups, so the casts below are exact.
            let first = ((self.first[axis] - origin) / side).floor().clamp(0.0, count);
            let end = ((self.end[axis] - origin) / side).ceil().clamp(0.0, count);
            groups.first[axis] = first as u32;
            groups.size[axis] = (end - first).max(0.0) as u32;
        }
        if groups.count() == 0 {
            groups.size = [0, 0];
        }
        groups
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::camera::film::Film;
    use crate::camera::{Camera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera};

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
        let pose = Pose::looking_along([45.0, 5.0, 30.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
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
            let pose = Pose::looking_along([x, 5.0, 5.0], [toward, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
            PinholeCamera::with_vertical_fov(pose, 0.6, 1.0).unwrap()
        };
        // The eye is between two bricks, of which one is on its plane.
        assert_eq!(numbers(&visible(&from(45.0, 1.0), film)), [4, 5, 6, 7]);
        assert_eq!(numbers(&visible(&from(45.0, -1.0), film)), [3, 2, 1, 0]);
        // Nothing is seen, so one brick writes the misses, if there are any.
        let nothing = visible(&from(95.0, 1.0), film);
        assert_eq!((nothing.len(), nothing[0].0), (1, 7));
        let aside = Pose::looking_along([30.0, 5.0, 30.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
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

    #[test]
    fn from_every_side() {
        // Three boxes along x, with a hundred spheres each between 10 i and 10 i + 9.9.
        let boxes = [2.0_f32, 0.0, 1.0].map(|i| {
            let spheres = (0..100).map(|k| [10.0 * i + 0.1 * k as f32, 0.0, 0.0, 1.0]);
            BrickBounds::of_spheres(&spheres.collect::<Vec<_>>())
        });
        let space =
            SceneSpace { origin: DVec3::new(1e6, 0.0, 0.0), min: Vec3::splat(-1.0), max: Vec3::new(30.9, 1.0, 1.0) };
        let order = |eye: [f64; 3]| {
            let eye = [1e6 + eye[0], eye[1], eye[2]];
            let pose = Pose::looking_at(eye, [1e6 + 12.0, 0.0, 0.1], [0.0, 1.0, 0.1]).unwrap();
            let pinhole = PinholeCamera::with_vertical_fov(pose, 0.5, 1.0).unwrap();
            let orthographic = OrthographicCamera::new(pose, [5.0, 5.0]).unwrap();
            let orders: [_; 2] =
                [&pinhole as &dyn Camera, &orthographic].map(|camera| nearest_first(boxes.into_iter(), camera, &space));
            assert_eq!(orders[0], orders[1]);
            orders[0].clone()
        };
        assert_eq!(order([-50.0, 1.0, 0.0]), [1, 2, 0]);
        assert_eq!(order([50.0, 1.0, 0.0]), [0, 2, 1]);
        // The eye is in the middle box, and the last box is the nearer of the other two.
        assert_eq!(order([19.0, 0.0, 0.0]), [2, 0, 1]);
    }

    /// The empty brick, which a scene without spheres has, and a brick with one sphere.
    #[test]
    fn an_empty_brick_is_the_last() {
        let boxes = [BrickBounds::EMPTY, BrickBounds::of_spheres(&[[1.0; 4]])];
        let pose = Pose::looking_along([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.5, 1.0).unwrap();
        let space = SceneSpace { origin: DVec3::ZERO, min: Vec3::ZERO, max: Vec3::ONE };
        assert_eq!(nearest_first(boxes.into_iter(), &camera, &space), [1, 0]);
    }

    fn cube() -> SceneSpace {
        let origin = DVec3::new(10.0, 0.0, 0.0);
        SceneSpace { origin, min: Vec3::splat(-1.0), max: Vec3::splat(1.0) }
    }

    fn tile(origin: [u32; 2], size: [u32; 2]) -> Tile {
        Tile { origin, size, in_target: [0, 0] }
    }

    /// At ten pixels per unit of length, the box is 20 pixels wide, in the middle of a film of 160 by 80.
    #[test]
    fn a_box_in_the_middle() {
        let film = Film::new(160, 80).unwrap();
        let pose = Pose::looking_along([10.0, 0.0, 9.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = OrthographicCamera::new(pose, [8.0, 4.0]).unwrap();
        let region = VisibleRegion::of(&View::new(&camera, film), &cube());
        assert_eq!(region, VisibleRegion { first: [68.0, 28.0], end: [92.0, 52.0] });
        let all = region.groups_of(tile([0, 0], [160, 80]));
        assert_eq!(all, Groups { first: [8, 3], size: [4, 4] });
        let lower = region.groups_of(tile([0, 48], [160, 32]));
        assert_eq!(lower, Groups { first: [8, 0], size: [4, 1] });
        assert_eq!(region.groups_of(tile([0, 56], [160, 24])).count(), 0);
        assert_eq!(region.groups_of(tile([96, 0], [64, 80])).count(), 0);
    }

    #[test]
    fn y_down_is_the_other_way_round() {
        let film = Film::new(80, 80).unwrap();
        let pose = Pose::looking_along([10.0, 2.0, 9.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = OrthographicCamera::new(pose, [4.0, 4.0]).unwrap();
        let up = VisibleRegion::of(&View::new(&camera, film), &cube());
        let down = VisibleRegion::of(&View::new(&camera, film.with_y_axis(YAxis::Down)), &cube());
        assert_eq!((up.first[1], up.end[1]), (48.0, 72.0));
        assert_eq!((down.first[1], down.end[1]), (8.0, 32.0));
    }

    #[test]
    fn from_inside_the_box_the_whole_film_is_visible() {
        let film = Film::new(80, 40).unwrap();
        let pose = Pose::looking_along([10.0, 0.0, 0.5], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.5, 2.0).unwrap();
        let region = VisibleRegion::of(&View::new(&camera, film), &cube());
        assert_eq!(region.groups_of(tile([0, 0], [80, 40])), Groups::of_size([80, 40]));
    }

    /// The rays through all corners of the box lie in the rectangle.
    #[test]
    fn a_ray_at_each_corner_is_in_the_region() {
        let film = Film::new(200, 100).unwrap();
        let pose = Pose::looking_at([15.0, 3.0, 9.0], [9.0, 0.5, 0.0], [0.1, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.9, 2.0).unwrap();
        let region = VisibleRegion::of(&View::new(&camera, film), &cube());
        for i in 0..8_u8 {
            let sign = |bit: u8| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let corner = DVec3::new(10.0 + sign(0), sign(1), sign(2));
            let location = camera.location_of(corner).unwrap();
            let ray = camera.ray_in_world(location);
            let along = (corner - ray.origin).dot(ray.direction);
            assert!((ray.at(along) - corner).length() < 1e-9);
            let (x, y) = ((location.x + 1.0) * 100.0, (1.0 - location.y) * 50.0);
            assert!(region.first[0] < x && x < region.end[0] && region.first[1] < y && y < region.end[1]);
        }
    }
}
