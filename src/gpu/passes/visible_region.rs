//! The part of a picture in which the scene's box may be visible.

use glam::DVec3;

use crate::camera::film::YAxis;
use crate::camera::{CameraKind, CameraVectors, View};
use crate::gpu::passes::tiles::{Groups, Tile, WORKGROUP_SIDE};
use crate::gpu::shader::records::SceneSpace;

/// A rectangle of the film in pixels, which may be empty. No ray of a pixel outside of it hits the scene's box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::gpu) struct VisibleRegion {
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
    pub(in crate::gpu) fn of(&View { camera, film }: &View<'_>, space: &SceneSpace) -> Self {
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
    pub(in crate::gpu) fn of_brick(view: &View<'_>, space: &SceneSpace) -> Option<Self> {
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
        // All corners are on the other side of a plane through the eye, and so is the box.
        let is_outside = corners.iter().all(|(.., depth)| *depth <= 0.0)
            || corners.iter().all(|(x, _, depth)| *x > right * depth)
            || corners.iter().all(|(x, _, depth)| -x > right * depth)
            || corners.iter().all(|(_, y, depth)| *y > up * depth)
            || corners.iter().all(|(_, y, depth)| -y > up * depth);
        (!is_outside).then(|| Self::of(view, space))
    }

    /// The part of the region that lies in another.
    pub(in crate::gpu) fn within(mut self, other: Self) -> Self {
        for axis in 0..2 {
            self.first[axis] = self.first[axis].max(other.first[axis]);
            self.end[axis] = self.end[axis].min(other.end[axis]);
        }
        self
    }

    /// The region extended for rays that may be up to `pixels` pixels away from the centres of their pixels.
    pub(in crate::gpu) fn widened(mut self, pixels: f64) -> Self {
        self.first.iter_mut().for_each(|first| *first -= pixels);
        self.end.iter_mut().for_each(|end| *end += pixels);
        self
    }

    /// The workgroups of a tile that overlap the rectangle. If there are none, both sides of the result are zero.
    pub(in crate::gpu) fn groups_of(&self, tile: Tile) -> Groups {
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
    use crate::camera::{Camera, OrthographicCamera, PinholeCamera, Pose};

    fn space() -> SceneSpace {
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
        let pose =
            Pose::looking_along([10.0, 0.0, 9.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = OrthographicCamera::new(pose, [8.0, 4.0]).unwrap();
        let region = VisibleRegion::of(&View::new(&camera, film), &space());
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
        let pose =
            Pose::looking_along([10.0, 2.0, 9.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = OrthographicCamera::new(pose, [4.0, 4.0]).unwrap();
        let up = VisibleRegion::of(&View::new(&camera, film), &space());
        let down = VisibleRegion::of(&View::new(&camera, film.with_y_axis(YAxis::Down)), &space());
        assert_eq!((up.first[1], up.end[1]), (48.0, 72.0));
        assert_eq!((down.first[1], down.end[1]), (8.0, 32.0));
    }

    #[test]
    fn from_inside_the_box_the_whole_film_is_visible() {
        let film = Film::new(80, 40).unwrap();
        let pose =
            Pose::looking_along([10.0, 0.0, 0.5], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.5, 2.0).unwrap();
        let region = VisibleRegion::of(&View::new(&camera, film), &space());
        assert_eq!(region.groups_of(tile([0, 0], [80, 40])), Groups::of_size([80, 40]));
    }

    /// The rays through all corners of the box lie in the rectangle.
    #[test]
    fn a_ray_at_each_corner_is_in_the_region() {
        let film = Film::new(200, 100).unwrap();
        let pose = Pose::looking_at([15.0, 3.0, 9.0], [9.0, 0.5, 0.0], [0.1, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.9, 2.0).unwrap();
        let region = VisibleRegion::of(&View::new(&camera, film), &space());
        for i in 0..8_u8 {
            let sign = |bit: u8| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let corner = DVec3::new(10.0 + sign(0), sign(1), sign(2));
            let location = camera.location_of(corner).unwrap();
            let ray = camera.ray_in_world(location);
            let along = (corner - ray.origin).dot(ray.direction);
            assert!((ray.at(along) - corner).length() < 1e-9);
            let (x, y) = ((location.x + 1.0) * 100.0, (1.0 - location.y) * 50.0);
            assert!(
                region.first[0] < x
                    && x < region.end[0]
                    && region.first[1] < y
                    && y < region.end[1]
            );
        }
    }
}
