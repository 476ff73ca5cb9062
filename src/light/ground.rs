//! A plane below everything.

use glam::DVec3;

use crate::image::color::LinearRgb;

/// An infinite plane, matt, seen and felt from above only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// A point of it, in the world.
    pub point: DVec3,
    /// Which way is above it; of any length.
    pub normal: DVec3,
    /// Its colour, each component at most 1.
    pub color: LinearRgb,
    /// Whether only shadows on it are seen: the darker, the more opaque. In a studio only.
    pub is_shadow_catcher: bool,
}
