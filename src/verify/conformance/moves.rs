//! The least move of a shape for each answer that a renderer may give.

use glam::DVec3;

/// The least moves of a shape, which is seen from a ray.
pub(super) trait Moves {
    /// The length of which k is a multiple: that of the longest vector from the start of the ray to the centre of a sphere
    /// or an end of a cone, or a radius if that is larger.
    fn size(&self) -> f64;

    /// The largest radius.
    fn radius(&self) -> f64;

    /// The least move for which the shape is hit.
    fn move_to_hit(&self) -> f64;

    /// The least move for which the shape is missed; 0 if the ray misses it anyway.
    fn move_to_miss(&self) -> f64;

    /// The least move for which the first point of the shape on the ray is at distance `t`.
    fn move_to_hit_at(&self, t: f64) -> f64;

    /// The least move for which the shape does not certainly hide a point at distance `t`.
    fn move_to_pass(&self, t: f64) -> f64;

    /// The least move for which the outward normal of the hit is `normal`, which must have unit length.
    fn move_to_normal(&self, direction: DVec3, normal: DVec3) -> f64;

    /// The least distance of the hits of all shapes that are moved by at most `a`, if any is hit.
    fn earliest(&self, a: f64) -> f64;

    /// The largest distance of the hits of all shapes that are moved by at most `a`, if all are hit.
    fn latest(&self, a: f64) -> f64;
}
