//! Strings of spheres that look like sticks.

use glam::DVec3;

/// The number of spheres of a string with this length, such that centres are at most `spacing` radii apart.
pub(super) fn count(length: f64, radius: f64, spacing: f64) -> f64 {
    (length / (spacing * radius)).ceil().max(1.0)
}

/// Spheres in the middles of `count` equal parts of a line. Thus two strings that meet have equal distances there.
pub(super) fn between(
    from: DVec3,
    to: DVec3,
    radius: f64,
    count: usize,
) -> impl Iterator<Item = [f64; 4]> {
    (0..count).map(move |index| {
        let center = from.lerp(to, (index as f64 + 0.5) / count as f64);
        [center.x, center.y, center.z, radius]
    })
}
