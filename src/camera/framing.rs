//! Places a camera so that it sees a whole box.

use glam::{DVec2, DVec3};

use crate::geometry::basis::OrthonormalBasis;
use crate::geometry::bounds::Bounds;

/// How much of the picture's half width and height the box may fill.
const FILL: f64 = 0.95;

/// The corners of a box relative to its centre, along u, v and w.
fn corners_in_camera(bounds: &Bounds, basis: &OrthonormalBasis) -> [DVec3; 8] {
    let center = bounds.center();
    bounds.corners().map(|corner| {
        let offset = corner - center;
        DVec3::new(offset.dot(basis.u()), offset.dot(basis.v()), offset.dot(basis.w()))
    })
}

/// How far behind the centre of the box an eye must stand to see all eight corners, for a view plane at distance 1
/// whose half width and half height are `tangents`.
pub(super) fn perspective_distance(
    bounds: &Bounds,
    basis: &OrthonormalBasis,
    tangents: DVec2,
) -> f64 {
    let tangents = tangents * FILL;
    corners_in_camera(bounds, basis)
        .iter()
        .map(|corner| corner.z + (corner.x.abs() / tangents.x).max(corner.y.abs() / tangents.y))
        .fold(0.0, f64::max)
}

/// The half extent, of the given aspect ratio, that shows the whole box, and how far behind the centre of the box the
/// view plane must stand so that the box lies in front of it.
pub(super) fn parallel_extent(
    bounds: &Bounds,
    basis: &OrthonormalBasis,
    aspect: f64,
) -> (DVec2, f64) {
    let half = corners_in_camera(bounds, basis)
        .iter()
        .fold(DVec3::ZERO, |half, corner| half.max(corner.abs()));
    let half_height = half.y.max(half.x / aspect) / FILL;
    // Twice the half depth leaves as much room in front of the box as the box is deep.
    (DVec2::new(half_height * aspect, half_height), 2.0 * half.z)
}

/// How far behind the centre of the box an eye must stand so that the bounding sphere of the box lies within a cone of
/// this half angle. If the cone is wider than a half space, this is just outside the bounding sphere.
#[cfg(feature = "scene-file")]
pub(super) fn round_distance(bounds: &Bounds, half_angle: f64) -> f64 {
    let within = (half_angle * FILL).min(std::f64::consts::FRAC_PI_2);
    0.5 * bounds.size().length() / within.sin()
}
