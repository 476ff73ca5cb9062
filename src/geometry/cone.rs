//! Cones and cylinders.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::geometry::math::wide;

/// The part of a cone between two discs around its axis, in a frame with f32 numbers. A cylinder has two equal radii.
///
/// Each end is closed by its disc, or open, so that the inside is seen. The names are those of Embree and of ANARI's
/// `cone` and `cylinder`. Twin: `Shape` in `shaders/scene/cone.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ConeInFrame {
    /// The middle of the first disc.
    pub start: [f32; 3],
    /// The radius of the first disc, with a minus sign if that end is open.
    pub first_radius: f32,
    /// The middle of the second disc.
    pub end: [f32; 3],
    /// The radius of the second disc, with a minus sign if that end is open.
    pub second_radius: f32,
}

impl ConeInFrame {
    /// The middles of the discs.
    pub(crate) fn ends(&self) -> [DVec3; 2] {
        [wide(self.start), wide(self.end)]
    }

    /// The radii of the discs.
    pub(crate) fn radii(&self) -> [f64; 2] {
        [self.first_radius, self.second_radius].map(|radius| radius.abs().into())
    }

    /// The direction of the axis.
    pub(crate) fn axis(&self) -> DVec3 {
        let [start, end] = self.ends();
        (end - start).normalize_or_zero()
    }

    /// The largest n·p of all its points p. The axis is that of [`Self::axis`].
    pub(crate) fn support(&self, axis: DVec3, n: DVec3) -> f64 {
        let ([start, end], [first, second]) = (self.ends(), self.radii());
        let across = (n - n.dot(axis) * axis).length();
        (n.dot(start) + across * first).max(n.dot(end) + across * second)
    }

    /// The corners of its bounding box.
    pub(crate) fn corners(&self) -> [DVec3; 2] {
        let ([start, end], [first, second], axis) = (self.ends(), self.radii(), self.axis());
        // How far discs reach along x, y and z, as a part of their radius.
        let across = DVec3::new(axis.y.hypot(axis.z), axis.x.hypot(axis.z), axis.x.hypot(axis.y));
        let (first, second) = (first * across, second * across);
        [(start - first).min(end - second), (start + first).max(end + second)]
    }

    /// A ball around it: centre and radius.
    pub(crate) fn ball(&self) -> [f32; 4] {
        let ([start, end], [first, second]) = (self.ends(), self.radii());
        let center = 0.5 * (start + end);
        let [x, y, z] = center.as_vec3().to_array();
        let rounding = center.abs().max_element() * f64::from(f32::EPSILON);
        let radius = (0.5 * (end - start).length()).hypot(first.max(second));
        [x, y, z, (radius * (1.0 + 1e-6) + rounding) as f32]
    }

    /// True for each end, the first and the second, that is closed.
    pub(crate) fn are_closed(&self) -> [bool; 2] {
        [self.first_radius, self.second_radius].map(f32::is_sign_positive)
    }
}
