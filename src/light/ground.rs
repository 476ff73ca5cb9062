//! The ground: a plane below the scene.

use glam::DVec3;

use crate::image::color::LinearRgb;

/// An infinite matt plane. It is visible, and reflects light, only on the side of its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "run-file", derive(serde::Serialize, serde::Deserialize))]
pub struct Ground {
    /// A point of the plane, in world space.
    pub point: DVec3,
    /// The direction that is above the plane; any length except zero.
    pub normal: DVec3,
    /// Colour of the plane, each component at most 1.
    pub color: LinearRgb,
    /// Whether only the shadows on the plane are visible, more opaque where they are darker. Only for the studio
    /// integrator.
    pub is_shadow_catcher: bool,
}
