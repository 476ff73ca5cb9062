//! Linear colours in f64.

use glam::DVec3;

use crate::geometry::math::wide;
use crate::image::color::{LUMINANCE, LinearRgb};

pub(super) fn rgb(color: LinearRgb) -> DVec3 {
    wide(color.to_array())
}

/// Relative luminance of a linear colour with the Rec. 709 primaries.
pub(super) fn luminance(color: DVec3) -> f64 {
    color.dot(DVec3::from(LUMINANCE))
}
