//! The order in which bricks are traced.

use glam::{DVec2, Vec3};

use crate::accel::BrickBounds;
use crate::camera::Camera;
use crate::gpu::shader::records::SceneSpace;

/// Squared distance from a point to the box of a brick's centres; 0 for a point inside.
fn distance_squared(brick: &BrickBounds, point: Vec3) -> f32 {
    (point - point.max(brick.center_min).min(brick.center_max)).length_squared()
}

/// The indices of boxes, sorted by their distance from the camera, the nearest first. Hits in near bricks then let rays
/// skip the others. The picture does not depend on the order.
pub(in crate::gpu) fn nearest_first(
    boxes: impl Iterator<Item = BrickBounds>,
    camera: &dyn Camera,
    space: &SceneSpace,
) -> Vec<usize> {
    let eye = (camera.ray_in_world(DVec2::ZERO).origin - space.origin).as_vec3();
    let mut order: Vec<(f32, usize)> =
        boxes.map(|brick| distance_squared(&brick, eye)).zip(0..).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    order.into_iter().map(|(_, brick)| brick).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::camera::{OrthographicCamera, PinholeCamera, Pose};

    #[test]
    fn from_every_side() {
        // Three boxes along x, with a hundred spheres each between 10 i and 10 i + 9.9.
        let boxes = [2.0_f32, 0.0, 1.0].map(|i| {
            let spheres = (0..100).map(|k| [10.0 * i + 0.1 * k as f32, 0.0, 0.0, 1.0]);
            BrickBounds::of_spheres(&spheres.collect::<Vec<_>>())
        });
        let space = SceneSpace {
            origin: DVec3::new(1e6, 0.0, 0.0),
            min: Vec3::splat(-1.0),
            max: Vec3::new(30.9, 1.0, 1.0),
        };
        let order = |eye: [f64; 3]| {
            let eye = [1e6 + eye[0], eye[1], eye[2]];
            let pose = Pose::looking_at(eye, [1e6 + 12.0, 0.0, 0.1], [0.0, 1.0, 0.1]).unwrap();
            let pinhole = PinholeCamera::with_vertical_fov(pose, 0.5, 1.0).unwrap();
            let orthographic = OrthographicCamera::new(pose, [5.0, 5.0]).unwrap();
            let orders: [_; 2] = [&pinhole as &dyn Camera, &orthographic]
                .map(|camera| nearest_first(boxes.into_iter(), camera, &space));
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
}
